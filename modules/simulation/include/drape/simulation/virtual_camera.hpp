// A virtual camera: photos of an object on a table, with everything about them known.
#pragma once

#include <cstdint>
#include <functional>

#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/simulation/objects.hpp"

namespace drape::simulation {

/// What is photographed. z is up.
struct Subject {
  TriangleMesh mesh;
  /// Paint at a surface point, sRGB-encoded, 0..1. Without it the mesh's vertex colours are taken, or grey.
  std::function<Eigen::Vector3f(const Eigen::Vector3d&)> color;
  /// Unit outward normal at a surface point, for shading. Without it the mesh's vertex normals are taken.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> normal;
  double gloss = 0;  // reflectance of the highlights, 0..1
};
[[nodiscard]] Subject make_subject(const ObjectSpec& spec);

enum class Table { wood, cloth };

struct PhotoStyle {
  Table table = Table::wood;
  bool clutter = true;       // other things behind the object, patterns on table and wall; else plain grey
  double noise_percent = 1;  // standard deviation of the sensor's noise at full brightness, of full scale;
                             // proportional to the root of the brightness
  std::uint64_t seed = 0;
};

struct SimulatedPhoto {
  Image8 image;    // RGB
  Image8 stencil;  // stencil::object where the ray through the pixel's centre meets the subject first
  Camera camera;
};

/// A camera that turns round the z axis and looks at the middle of the mesh's bounding box, from so far that
/// the bounding sphere would fill `fill_percent` of the image's shorter side. Azimuth 0 is on the +x side, 90
/// on the +y side. `off_center` moves the object in the picture, in shares of the image's width and height.
[[nodiscard]] Camera camera_round(const TriangleMesh& mesh, int width, int height, double fov_deg,
                                  double azimuth_deg, double elevation_deg, double roll_deg = 0,
                                  double fill_percent = 90,
                                  const Eigen::Vector2d& off_center = Eigen::Vector2d::Zero());

/// Ray-cast in doubles, on its own code and not on OpenGL, so that it checks the renderer that photos are
/// matched with. 3 x 3 samples a pixel; sun with a soft shadow, sky and light from the table by directions
/// that are not blocked; slight vignetting. The table is at the mesh's lowest point; wall and clutter stand
/// beyond the mesh as this camera sees it, never in front of it. Neither threads nor their number matter to
/// the result.
[[nodiscard]] SimulatedPhoto take_photo(const Subject& subject, const Camera& camera, const PhotoStyle& style,
                                        const Progress& progress = {});

}  // namespace drape::simulation
