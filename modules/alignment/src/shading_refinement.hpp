// The photo's inside beside a rough outline: light on the surface, creases and edges that hide one another.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "noisy_outline.hpp"
#include "photo_plane.hpp"
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

/// How well light explains the inside. The brightness of a pixel is taken for the scan's own (or one) times a
/// function of the normal: spherical harmonics to the third order (Basri and Jacobs 2003: with nine of them
/// nearly all that a matt body shows under any distant light), fitted robustly. Residuals of neighbours share
/// their error; `independent` says how many there are of which each has an error of its own.
struct ShadingFit {
  double sigma = 0;        // of what light does not explain; brightness is 0..1
  double explained = 0;    // of the variance inside, 0..1
  double independent = 0;  // samples
  double pixels = 0;       // seen and counted

  /// Of the residuals, up to a constant of the photo.
  [[nodiscard]] double log_likelihood() const;
};

/// Moves with a pose: the equations of Gauss and Newton for brightness, the light eliminated, so that
/// creases, hidden edges and shading all pull. Derivatives are differences of
/// two views, each a step away that moves the body's rim by `step_px` in the window.
class PhotoShading {
 public:
  PhotoShading(const LitMesh& mesh, const InsideOfPhoto& photo) : mesh_(mesh), photo_(photo) {}

  /// In the coordinates of `directions` (columns); nothing where too little is seen.
  struct Equations {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd vector;
    ShadingFit fit;
  };
  [[nodiscard]] std::optional<Equations> equations(const OutlinePose& pose, const LensPrior& lens,
                                                   const Eigen::MatrixXd& directions, double step_px);
  [[nodiscard]] std::optional<ShadingFit> fit(const OutlinePose& pose);

 private:
  struct Light;
  [[nodiscard]] bool fit_light(const OutlinePose& pose, Light& light);

  const LitMesh& mesh_;
  const InsideOfPhoto& photo_;
  SurfaceDrawing drawing_;
};

/// The pose that outline and inside agree on, each weighted by its noise. Its agreement and chi squared are
/// the outline's; its information is both's.
struct ShadedPose {
  RefinedPose refined;
  ShadingFit before;
  ShadingFit after;
};
[[nodiscard]] std::optional<ShadedPose> pose_by_shading(NoisyOutline& outline, const LitMesh& mesh,
                                                        const std::vector<InsideOfPhoto>& coarse_to_fine,
                                                        const RefinedPose& start);

}  // namespace drape::alignment
