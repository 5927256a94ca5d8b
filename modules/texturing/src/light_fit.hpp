// The light of each photo, from what it does to the colours of a surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "drape/base/progress.hpp"
#include "light_transfer.hpp"

namespace drape::texturing {

/// What one photo shows of one surface point.
struct LightSample {
  int photo;
  SurfacePlace place;
  Transfer transfer;
  Eigen::Vector3f log_color;  // log of linear light
};
/// Two samples of one photo, near each other on the surface or of like colour.
struct LightPair {
  std::uint32_t a;
  std::uint32_t b;
};
/// A sample's surface point in another photo.
struct SharedPoint {
  std::uint32_t sample;
  int photo;
  Eigen::Vector3f log_color;
};
struct LightEvidence {
  int photos = 0;
  std::vector<LightSample> samples;
  std::vector<LightPair> pairs;
  std::vector<SharedPoint> shared;
};

/// Light from a disc far away.
struct Lamp {
  Eigen::Vector3d towards;  // unit length
  double radius_rad;
  Eigen::Array3d color;  // irradiance over pi of a surface that faces it
};
struct PhotoLight {
  Eigen::Matrix<double, transfer_size, 3> around;  // of the transfers; columns: red, green, blue
  std::vector<Lamp> lamps;
  Eigen::Array3d darkest = Eigen::Array3d::Zero();  // no shading is taken for less

  /// `lamp_light[l]`: how much of lamp l's light arrives, its cosine included.
  [[nodiscard]] Eigen::Array3d shading(const Transfer& transfer, std::span<const float> lamp_light) const;
};

/// Of the typical shading: below, photos hold more noise than paint.
inline constexpr double least_shading = 0.15;
/// Makes the first transfer of an open surface 1.
inline constexpr double harmonic_scale = 3.544908;

/// How much of a lamp's light arrives at every sample, cosine included.
using LampLight = std::function<std::vector<float>(const Eigen::Vector3d& towards, double radius_rad)>;

/// Lights such that what is left of the colours, the albedo, is the same in all photos and differs between
/// neighbours in few places only: least absolute differences, by iteratively reweighted least squares over
/// all photos at once (sparse reflectance gradients: Gehler et al., "Recovering intrinsic images with a
/// global sparsity prior on reflectance", 2011; light by spherical harmonics as Barron and Malik, "Shape,
/// illumination, and reflectance from shading", 2015). On top of the harmonics, which cast soft shadows only,
/// come up to two lamps where they explain the photos better. One light for all photos, unless one for each
/// makes their albedos much more alike. Each photo has an exposure and a tint of its own; within a photo, all
/// light has one colour: dark channels would not hold more. `lit_samples[d]`: as LightTransfer has it, for
/// the samples' places. The lights' common brightness and tint, which photos do not tell, are such that the
/// mean log shading is 0.
[[nodiscard]] std::vector<PhotoLight> fitted_lights(const LightEvidence& evidence,
                                                    const std::vector<std::vector<std::uint8_t>>& lit_samples,
                                                    const LampLight& lamp_light, const Progress& progress);

/// Per photo and lamp of it, how much light arrives at every sample.
using Arrivals = std::vector<std::vector<std::vector<float>>>;
[[nodiscard]] Arrivals arrivals_of(const std::vector<PhotoLight>& lights, const LampLight& lamp_light);

/// What a photo's light makes of the paint at a sample, also of another photo's.
[[nodiscard]] Eigen::Array3d shading_at(const LightSample& sample, std::size_t index, const PhotoLight& light,
                                        const std::vector<std::vector<float>>& arrivals);

/// Median over shared points and channels of how far the logs of two photos' albedos are apart: `before`
/// with each photo's light taken for even (its exposure matched), `after` with the lights given.
struct AlbedoSpread {
  double before = 0;
  double after = 0;
};
[[nodiscard]] AlbedoSpread albedo_spread(const LightEvidence& evidence, const std::vector<PhotoLight>& lights,
                                         const Arrivals& arrivals);

}  // namespace drape::texturing
