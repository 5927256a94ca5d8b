// Pixels in memory. No codec and no filter lives here: io/ reads and writes, OpenCV computes.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drape {

/// Rows from the top, channels interleaved. Pixel (x, y) covers [x, x+1) x [y, y+1); its centre is at +0.5.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, int channels, T fill = T{})
      : width_(width),
        height_(height),
        channels_(channels),
        data_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                  static_cast<std::size_t>(channels),
              fill) {
    assert(width >= 0 && height >= 0 && channels > 0);
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] bool empty() const { return data_.empty(); }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  [[nodiscard]] T& at(int x, int y, int channel = 0) { return data_[index(x, y, channel)]; }
  [[nodiscard]] const T& at(int x, int y, int channel = 0) const { return data_[index(x, y, channel)]; }

  /// width * channels values of row y.
  [[nodiscard]] std::span<T> row(int y) { return {data_.data() + index(0, y, 0), row_size()}; }
  [[nodiscard]] std::span<const T> row(int y) const { return {data_.data() + index(0, y, 0), row_size()}; }
  [[nodiscard]] std::vector<T>& data() { return data_; }
  [[nodiscard]] const std::vector<T>& data() const { return data_; }

  bool operator==(const Image&) const = default;

 private:
  [[nodiscard]] std::size_t row_size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
  }
  [[nodiscard]] std::size_t index(int x, int y, int channel) const {
    assert(contains(x, y) && channel >= 0 && channel < channels_);
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels_) +
           static_cast<std::size_t>(channel);
  }

  int width_ = 0;
  int height_ = 0;
  int channels_ = 1;
  std::vector<T> data_;
};

using Image8 = Image<std::uint8_t>;  // 1 grey, 3 RGB or 4 RGBA (straight alpha); sRGB-encoded
using ImageF = Image<float>;

/// A stencil is an Image8 with one channel that says of each pixel whether it shows the object.
namespace stencil {
inline constexpr std::uint8_t background = 0;
inline constexpr std::uint8_t unknown = 128;
inline constexpr std::uint8_t object = 255;
}  // namespace stencil

}  // namespace drape
