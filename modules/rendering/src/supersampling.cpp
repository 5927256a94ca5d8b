#include "supersampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drape/base/parallel.hpp"

namespace drape::rendering {
namespace {

constexpr int linear_steps = 1 << 14;  // fine enough that every 8-bit code survives decoding and encoding

double decode(double encoded) {  // IEC 61966-2-1
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encode(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

struct Tables {
  std::array<float, 256> decoded{};
  std::array<std::uint8_t, linear_steps + 1> encoded{};
  Tables() {
    for (std::size_t i = 0; i < decoded.size(); ++i)
      decoded[i] = static_cast<float>(decode(static_cast<double>(i) / 255));
    for (std::size_t i = 0; i < encoded.size(); ++i)
      encoded[i] =
          static_cast<std::uint8_t>(std::lround(255 * encode(static_cast<double>(i) / linear_steps)));
  }
};

}  // namespace

void average_samples(std::span<const std::uint32_t> rgba, int samples, Image8& picture, int x, int y,
                     int width, int height) {
  static const Tables tables;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(rgba.data());
  const std::size_t stride = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(samples);
  const float share = 1.0F / static_cast<float>(samples * samples);
  parallel_for(static_cast<std::size_t>(height), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      std::uint8_t* out = &picture.at(x, y + static_cast<int>(row));
      for (int column = 0; column < width; ++column)
        for (int channel = 0; channel < 3; ++channel) {
          float sum = 0;
          for (int j = 0; j < samples; ++j) {
            const std::uint8_t* in =
                bytes + (row * static_cast<std::size_t>(samples) + static_cast<std::size_t>(j)) * stride +
                4 * static_cast<std::size_t>(column * samples) + channel;
            for (int i = 0; i < samples; ++i) sum += tables.decoded[in[4 * i]];
          }
          *out++ = tables.encoded[static_cast<std::size_t>(std::lround(sum * share * linear_steps))];
        }
    }
  });
}

}  // namespace drape::rendering
