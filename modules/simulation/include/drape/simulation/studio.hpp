// Photos under lamps: what light does to paint, and nothing else in the picture.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/ray_caster.hpp"
#include "drape/simulation/virtual_camera.hpp"

namespace drape::simulation {

/// A square that shines towards the middle of the object.
struct StudioLamp {
  Eigen::Vector3d center;
  double side = 0;        // in the mesh's unit
  Eigen::Vector3f power;  // irradiance of a surface at the object's middle that faces the lamp, linear
};

struct Studio {
  std::vector<StudioLamp> lamps;
  Eigen::Vector3f around = Eigen::Vector3f::Zero();        // radiance times pi of the room beyond
  Eigen::Vector3f floor_albedo = Eigen::Vector3f::Zero();  // linear; of a floor at the object's lowest point
  float exposure = 1;
  double noise_percent = 0.5;  // standard deviation of the sensor's noise at full brightness, of full scale
  std::uint64_t seed = 0;
};

/// A key lamp (more or less soft, high or low, on any side), a weak one for the shadows, a dim room and a
/// grey floor, all lightly tinted.
[[nodiscard]] Studio random_studio(const TriangleMesh& mesh, std::uint64_t seed);

struct StudioPhoto {
  Image8 image;    // RGB; black beyond the object
  Image8 paint;    // RGB: the object's paint without light, black beyond
  Image8 stencil;  // stencil::object where the pixel's centre sees the object
  Camera camera;
};

/// Ray-cast in doubles: soft shadows of the lamps as they are, one bounce of their light between surfaces and
/// from the floor, the room's light where nothing hides it, noise, and a film's S-shaped tone curve before
/// sRGB's. `caster` holds subject.mesh. 2 x 2 samples a pixel;
/// the same bytes for any number of threads.
[[nodiscard]] StudioPhoto take_studio_photo(const Subject& subject, const RayCaster& caster,
                                            const Camera& camera, const Studio& studio);

}  // namespace drape::simulation
