// What a pixel is compared by when pixels are clustered.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lab_image.hpp"

namespace drape::segmentation {

/// Colour and position: L, a, b, x, y.
inline constexpr int color_position_count = 5;

/// The factor that brings a pixel position to Lab units: at weight 1 the longer side counts as much as black
/// against white.
[[nodiscard]] double position_scale(const ImageF& lab, double position_weight);

/// Superpixels with the mean features of their pixels: what clustering with a cost beyond linear works on.
struct Patches {
  Labels labels;              // 0 .. n-1 per pixel
  Eigen::MatrixXd mean;       // n x color_position_count
  Eigen::VectorXd pixels;     // n
  double scatter_within = 0;  // squared distances of the pixels to their patches' means, summed
};

/// About `count` patches.
[[nodiscard]] Patches patches_of(const ImageF& lab, double position_weight, int count);

/// Per pixel the cluster of its patch.
[[nodiscard]] Labels spread(const std::vector<int>& cluster_of_patch, const Labels& patches);

}  // namespace drape::segmentation
