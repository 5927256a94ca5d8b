// Simulated objects of a known paint, and photos of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/simulation/objects.hpp"

namespace drape::lab {

inline constexpr int width = 960;  // of the photos, in pixels
inline constexpr int height = 720;

struct Object {
  std::string name;
  simulation::ObjectSpec spec;
  TriangleMesh mesh;
  RayCaster caster;
};

struct Photo {
  Image8 rgb;
  Image8 stencil;
  Camera camera;
};

/// What a camera sees of an object: linear light, the mean of 3 x 3 rays a pixel, without noise.
struct Scene {
  Camera camera;
  Image<float> light;     // three channels, of the object alone
  Image<float> coverage;  // share of the rays that hit it
  Image8 stencil;
};

/// Linear light of an sRGB value, both 0..1.
[[nodiscard]] float linear(float stored);

/// Linear light 0..1 as an sRGB byte.
[[nodiscard]] std::uint8_t byte(float light);

/// The paint itself, without light.
[[nodiscard]] Scene seen_by(const Object& object, const Camera& camera);

/// The photo as it would be if its outline's pixels held nothing but the object: what a model is to show
/// there.
[[nodiscard]] Scene without_background(Scene scene);

/// `background` in linear light; `noise` as a share of full scale in linear light.
[[nodiscard]] Photo photographed(const Scene& scene, const Eigen::Vector3f& background, double exposure,
                                 std::uint64_t seed, double noise = 0.005);

/// Other seeds look from other sides.
[[nodiscard]] double turn_deg(std::uint64_t seed);
[[nodiscard]] Camera camera_at(const Object& object, double azimuth_deg, double elevation_deg);

struct CameraError {
  double turn_deg = 0.4;     // about any axis
  double focal_percent = 1;  // standard deviation
};

/// As an aligner leaves it: turned about the object's middle, and nearer or farther with another focal
/// length.
[[nodiscard]] Camera slightly_off(const Object& object, const Camera& camera, const CameraError& error,
                                  std::uint64_t seed);

}  // namespace drape::lab
