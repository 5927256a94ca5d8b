// Stencils of one bit a pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

/// Rows of 64-bit words; bit i of word j of a row is the pixel x = 64 j + i. Bits beyond the width are 0.
class BitImage {
 public:
  BitImage() = default;
  BitImage(int width, int height)
      : width_(width),
        height_(height),
        words_((width + 63) / 64),
        bits_(static_cast<std::size_t>(words_) * static_cast<std::size_t>(height), 0) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
    return (row(y)[static_cast<std::size_t>(x >> 6)] >> (x & 63)) & 1U;
  }
  void set(int x, int y) { row(y)[static_cast<std::size_t>(x >> 6)] |= std::uint64_t{1} << (x & 63); }
  void clear() { bits_.assign(bits_.size(), 0); }

  [[nodiscard]] std::span<std::uint64_t> row(int y) {
    return {bits_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(words_),
            static_cast<std::size_t>(words_)};
  }
  [[nodiscard]] std::span<const std::uint64_t> row(int y) const {
    return {bits_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(words_),
            static_cast<std::size_t>(words_)};
  }
  [[nodiscard]] std::span<const std::uint64_t> words() const { return bits_; }
  [[nodiscard]] std::span<std::uint64_t> words() { return bits_; }
  /// The bits of the last word of a row that are pixels.
  [[nodiscard]] std::uint64_t last_word_mask() const {
    return (width_ & 63) == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (width_ & 63)) - 1;
  }

 private:
  int width_ = 0;
  int height_ = 0;
  int words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Sets the pixels whose centres (x + 0.5, y + 0.5) lie in a face. Half-open spans, each edge evaluated from
/// its upper vertex: of two faces that share an edge every centre on it belongs to one, none to neither.
void draw_faces(std::span<const Eigen::Vector2d> places, std::span<const Face> faces, BitImage& image);

/// Fills between edges by how often they wind about a pixel's centre: the same pixels as draw_faces() draws
/// of faces from their shared sides alone, of which a smooth body has few on its outline and none elsewhere.
/// Each edge is evaluated as there. Buffers are kept from one picture to the next.
class WindingFill {
 public:
  void begin(int width, int height);
  /// Adds `winding` to all pixels on the right of the edge where it runs down, and takes it from them where
  /// it runs up.
  void add_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int winding);
  /// Sets the pixels that are wound about more than not at all.
  void fill(BitImage& image);

 private:
  struct Crossing {
    std::int32_t row = 0;
    std::int32_t column = 0;  // of the first pixel on its right
    std::int32_t winding = 0;
  };

  int width_ = 0;
  int height_ = 0;
  std::vector<Crossing> crossings_, sorted_;
  std::vector<std::uint32_t> row_begin_;
};

/// What `mesh` does not cover and the image's border cannot reach, by steps to the four neighbours.
[[nodiscard]] BitImage enclosed_gaps(const BitImage& mesh);

}  // namespace drape::alignment
