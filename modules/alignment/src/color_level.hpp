// A photo's colours at one resolution.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bit_raster.hpp"
#include "drape/geometry/image.hpp"
#include "outline_drawing.hpp"
#include "photo_plane.hpp"

namespace drape::alignment {

using LabColor = std::array<float, 3>;

/// A box of photo pixels.
struct PhotoBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
};

struct ColorLevel {
  /// Histograms have 16 steps each of L, a and b.
  static constexpr int bin_count = 4096;
  static constexpr std::uint16_t no_bin = 0xffff;
  static constexpr std::uint8_t no_label = 0xff;

  Window window;
  BitImage known;                // inside the photo
  Image<std::uint16_t> bins;     // of the histogram; no_bin outside the photo
  Image8 label_at;               // each pixel's cluster of colours, or no_label
  std::vector<BitImage> labels;  // the pixels of each cluster
  /// Lab differences across 2 pixels, squared and summed: the step along a direction (x, y) is the root of
  /// xx x^2 + 2 xy x y + yy y^2.
  struct Step {
    float xx = 0, xy = 0, yy = 0;
  };
  Image<Step> steps;
  bool smooth = true;  // neighbouring bins are alike
};

/// The photo's part in `box` (which is clipped to the photo), `scale` window pixels a photo pixel, and its
/// CIE Lab colours (D65; L 0..100), 3 channels. Of a lens that is known the window is in ideal pixels.
struct LabWindow {
  Window window;
  ImageF lab;
  BitImage known;
};
[[nodiscard]] LabWindow lab_window(const Image8& rgb, const PhotoPlane& plane, const PhotoBox& box,
                                   double scale);

/// At most `most` cluster centres of the window's colours: k-means, seeded by k-means++ (Arthur and
/// Vassilvitskii 2007), on some thousand pixels. Fewer where there are fewer colours; one at least.
[[nodiscard]] std::vector<LabColor> color_clusters(const LabWindow& window, int most);

[[nodiscard]] ColorLevel color_level(const LabWindow& window, const std::vector<LabColor>& clusters);

/// The same of a photo's segments: each is one colour, and the steps are where they meet. `segments` holds
/// labels from 0, in the photo's pixels; those that only small ones have share the last cluster.
[[nodiscard]] ColorLevel segment_level(const Image<std::int32_t>& segments, const PhotoPlane& plane,
                                       const PhotoBox& box, double scale);

}  // namespace drape::alignment
