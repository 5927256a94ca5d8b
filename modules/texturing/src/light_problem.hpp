// Least absolute differences between what lights predict and what photos show: the solver behind light_fit.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "light_fit.hpp"

namespace drape::texturing {

inline constexpr int most_lamps = 2;

/// How far the log of each channel can be trusted, 0..1, of two log colours: dark ones are noise.
[[nodiscard]] Eigen::Array3d certainty(const Eigen::Vector3f& a, const Eigen::Vector3f& b);

/// One light's strengths, of no colour. Colour is the photos' affair: their gains.
struct LightShape {
  Eigen::VectorXd values;                 // transfer_size + lamps
  std::vector<std::vector<float>> lamps;  // per lamp and sample: what arrives
  std::vector<Lamp> places;               // colours unset

  using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, transfer_size + most_lamps, 1>;
  [[nodiscard]] Row row(const LightSample& sample, std::size_t index) const;
};
/// The lights that photos may share, and what each photo makes of them.
struct Lights {
  std::vector<LightShape> shapes;
  std::vector<int> shape_of;          // per photo
  std::vector<Eigen::Array3d> gains;  // per photo: log of exposure and tint
};

/// Even light of brightness 1: one for all photos, or one each.
[[nodiscard]] Lights even_lights(int photos, bool shared);

/// The evidence that some lights are fitted to, the others being as they are.
struct LightProblem {
  const LightEvidence& evidence;
  std::vector<std::uint32_t> pairs;   // which
  std::vector<std::uint32_t> shared;  // which
  std::vector<int> free;              // shapes
};
[[nodiscard]] LightProblem problem_of_all(const LightEvidence& evidence, const Lights& lights);
/// About `most` pairs and as many shared points, of the photos under one light.
[[nodiscard]] LightProblem problem_of_one(const LightEvidence& evidence, const Lights& lights, int shape,
                                          std::size_t most);

/// Levenberg (1944) steps on the reweighted problem; lamps and bounces give no negative light. Moves `lights`
/// and returns their cost.
double refine(const LightProblem& problem, Lights& lights, int iterations);

/// The log shading of a photo at a sample; every number has a finite one.
[[nodiscard]] Eigen::Array3d log_shading(const Lights& lights, const LightEvidence& evidence,
                                         std::uint32_t sample, int photo);

}  // namespace drape::texturing
