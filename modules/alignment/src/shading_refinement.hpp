// The photo's inside beside a rough outline: light on the surface, creases and edges that hide one another.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "noisy_outline.hpp"
#include "photo_plane.hpp"
#include "surface_light.hpp"
#include "surface_view.hpp"

namespace drape::alignment {

/// The photo's brightness where the stencil is sure to show the object, in a level's window.
struct InsideOfPhoto {
  Window window;
  std::vector<float> brightness;     // 0..1
  std::vector<std::uint8_t> inside;  // 1: counts
};

/// Means over the window's pixels. What lies within `margin_px` (window pixels) of the stencil's outline is
/// left out.
[[nodiscard]] InsideOfPhoto inside_of_photo(const Image8& rgb, const PhotoPlane& plane,
                                            const StencilLevel& level, double margin_px);

/// Moves with a pose: the equations of Gauss and Newton for brightness, the light eliminated, so that
/// creases, hidden edges and shading all pull.
class PhotoShading {
 public:
  PhotoShading(const LitMesh& mesh, const InsideOfPhoto& photo) : mesh_(mesh), photo_(photo) {}

  /// In the coordinates of `directions` (columns); nothing where too little is seen.
  struct Equations {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd vector;
  };
  [[nodiscard]] std::optional<Equations> equations(const OutlinePose& pose, const Eigen::MatrixXd& directions,
                                                   int step_px);
  [[nodiscard]] std::optional<ShadingFit> fit(const OutlinePose& pose);

 private:
  [[nodiscard]] SurfaceLight light_at(const OutlinePose& pose);

  const LitMesh& mesh_;
  const InsideOfPhoto& photo_;
  SurfaceDrawing drawing_;
};

/// The pose that outline and inside agree on, each weighted by its noise. Its agreement and chi squared are
/// the outline's; its information is both's.
struct ShadedPose {
  RefinedPose refined;
  double chi_squared_before = 0;  // of the outline at the start
  ShadingFit before;
  ShadingFit after;
};
[[nodiscard]] std::optional<ShadedPose> pose_by_shading(NoisyOutline& outline, const LitMesh& mesh,
                                                        const std::vector<InsideOfPhoto>& coarse_to_fine,
                                                        const RefinedPose& start);

}  // namespace drape::alignment
