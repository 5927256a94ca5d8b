// Corrections of the photos' colours that vary slowly over the surface and make them agree.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "blend_weights.hpp"
#include "photo_colors.hpp"
#include "photo_sight.hpp"

namespace drape::texturing {

/// One for a photo at a vertex: added to log light.
struct ViewGain {
  int view;
  Eigen::Vector3f gain;
};
using VertexGains = std::vector<ViewGain>;

/// For every vertex and each view that paints there. Least squares of what two photos still differ by where
/// both paint, and of what a photo's correction changes along an edge (Lempitsky and Ivanov, CVPR 2007,
/// section 4; Waechter, Moehrle, Goesele, ECCV 2014, section 4.2: here in log light, where exposure is an
/// offset). `exposures` are where the corrections start from.
[[nodiscard]] std::vector<VertexGains> levelling_gains(const PaintedFaces& surface,
                                                       std::span<const int> chosen,
                                                       std::span<const VertexBlend> blends,
                                                       std::span<const PhotoSight> sights,
                                                       std::span<const PhotoColors> colors,
                                                       std::span<const Eigen::Vector3f> exposures);

/// The views that paint at each vertex, all gains zero: without levelling.
[[nodiscard]] std::vector<VertexGains> no_gains(const PaintedFaces& surface, std::span<const int> chosen,
                                                std::span<const VertexBlend> blends);

}  // namespace drape::texturing
