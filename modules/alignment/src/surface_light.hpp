// Light on a surface, as a photo's brightness tells it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "outline_drawing.hpp"
#include "surface_view.hpp"

namespace drape::alignment {

inline constexpr int light_terms = 16;  // real spherical harmonics to the third order, not normalised
using LightTerms = Eigen::Matrix<double, light_terms, 1>;

/// Of a unit normal.
[[nodiscard]] LightTerms light_harmonics(const Eigen::Vector3d& normal);

/// Change of dot(light_harmonics(normal), coefficients) with the normal.
[[nodiscard]] Eigen::Vector3d light_gradient(const Eigen::Vector3d& normal, const LightTerms& coefficients);

/// How well light explains the inside. The brightness of a pixel is taken for the scan's own (or one) times a
/// function of the normal: spherical harmonics to the third order (Basri and Jacobs 2003: with nine of them
/// nearly all that a matt body shows under any distant light), fitted robustly. Residuals of neighbours share
/// their error; `independent` says how many there are of which each has an error of its own.
struct ShadingFit {
  double sigma = 0;  // of what light does not explain, by its median; brightness is 0..1
  double rms = 0;    // the same, by squares of up to three sigma: half of it may be wrong unseen by a median
  double explained = 0;    // of the variance inside, 0..1
  double independent = 0;  // samples
  double pixels = 0;       // seen and counted
};

/// The light that explains a photo's brightness best, by least squares reweighted with Geman and McClure's
/// (1987) function of three deviations.
class SurfaceLight {
 public:
  /// `brightness` (0..1), row by row as the view, counts where `counts` is not 0 and the surface is seen.
  /// `width` of the view in pixels.
  SurfaceLight(const std::vector<SurfacePixel>& view, int width, const std::vector<float>& brightness,
               const std::vector<std::uint8_t>& counts);

  [[nodiscard]] bool sees_enough() const;
  [[nodiscard]] ShadingFit fit() const;
  [[nodiscard]] const LightTerms& coefficients() const { return coefficients_; }
  /// The normal equations that gave the coefficients.
  [[nodiscard]] const Eigen::Matrix<double, light_terms, light_terms>& matrix() const { return matrix_; }

  /// What counts and is seen, one after the other.
  [[nodiscard]] const std::vector<std::size_t>& pixels() const { return pixels_; }
  [[nodiscard]] const LightTerms& look(std::size_t i) const { return looks_[i]; }  // harmonics x scan's own
  [[nodiscard]] double residual(std::size_t i) const { return residuals_[i]; }
  [[nodiscard]] double weight(std::size_t i) const { return weights_[i]; }

 private:
  void solve(const std::vector<float>& brightness);
  void find_area(int width);

  std::vector<std::size_t> pixels_;
  std::vector<LightTerms> looks_;
  std::vector<double> residuals_;
  std::vector<double> weights_;
  LightTerms coefficients_ = LightTerms::Zero();
  Eigen::Matrix<double, light_terms, light_terms> matrix_;
  double sigma_ = 0;
  double area_ = 1;  // of what shares its error, in pixels
  double spread_ = 0;
};

/// What each of `pixels` shows changes with the pose's parameters (columns): as the surface moves under it,
/// by the slope of the picture over `step_px` to each side, and as the surface turns in the light. An edge
/// pulls no further than the step.
[[nodiscard]] Eigen::MatrixXd brightness_changes(const std::vector<SurfacePixel>& view, const Window& window,
                                                 const OutlinePose& pose,
                                                 const std::vector<std::size_t>& pixels,
                                                 const LightTerms& coefficients, int step_px);

}  // namespace drape::alignment
