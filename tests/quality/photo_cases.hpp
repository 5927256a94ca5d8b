// Photos with known cameras, real and simulated, and what is told of them: boxes, clicks.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "drape/base/random.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

struct PhotoCase {
  std::string name;
  TriangleMesh mesh;
  Image8 rgb;
  Camera truth;
  Image8 silhouette;           // of the mesh at the true camera, whatever may hide it
  bool turns_about_z = false;  // a body of rotation: its turn cannot be told
};

/// The photos of DRAPE_TEST_DATA's photos/lmo; their true cameras are coarse.
[[nodiscard]] std::vector<PhotoCase> lmo_cases();

/// Every second photo of photos/dino, of a hull that is carved from the others: black surroundings, a clamp.
[[nodiscard]] std::vector<PhotoCase> dino_cases();

enum class Scene {
  clutter,  // on a table among other things
  studio    // before plain grey, on a plinth that the mesh does not have
};
/// Simulated photos of 480 x 360 pixels: object number `index` of a fixed turn, any side, 25 to 50 degrees of
/// view, 35 to 75 % of the picture's height, off the middle.
/// Taking a photo costs some seconds: those in the folder `cache` are read, others are put there. Empty:
/// none.
[[nodiscard]] PhotoCase simulated_case(int index, Scene scene, const std::filesystem::path& cache = {});

/// A mesh, and a photo in which it is not to be seen, with a loose box round something else in it.
struct AbsentCase {
  std::string name;
  TriangleMesh mesh;
  Image8 rgb;
  std::array<double, 4> box{};
};
/// At most `pairs`: simulated, LM-O and other meshes, with simulated and real photos of other things.
[[nodiscard]] std::vector<AbsentCase> absent_cases(int pairs, const std::filesystem::path& cache = {});

/// Box of the object in the picture: x, y, width, height.
[[nodiscard]] std::array<double, 4> object_box(const Image8& silhouette);
/// It with 3 to 35 % of its size more on each side.
[[nodiscard]] std::array<double, 4> loose_box(const Image8& silhouette, Rng& rng);
/// Any of the object's pixels.
[[nodiscard]] std::array<double, 2> click_inside(const Image8& silhouette, Rng& rng);

/// How wrong a camera is for a case.
struct PoseError {
  double rotation_deg = 0;  // about the ray to the object
  double size_percent = 0;  // median shift of the vertices in the picture, of the object's size there;
                            // 0 for a body of rotation
};
[[nodiscard]] PoseError pose_error(const PhotoCase& photo, const Camera& found);

}  // namespace drape
