// The objects that alignment is measured on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"
#include "drape/simulation/objects.hpp"

namespace drape::lab {

struct Model {
  std::string name;
  TriangleMesh object;                  // what stands before the camera
  TriangleMesh scanned;                 // what the aligner is given: the same, or with less of it
  simulation::ObjectSymmetry symmetry;  // of simulated objects
  bool thin_or_holed = false;           // for which less overlap is asked
  [[nodiscard]] bool painted() const { return !object.colors.empty(); }
};

/// "teapot", "statue", "head", "machine_part", "aircraft", "vase" (a body of rotation) and "chair"
/// (mirror-symmetric) are simulated; "teapot.obj", "cessna.obj", "rocker-arm.obj", "fandisk.obj" and
/// "Laurana50k.ply" are files of DRAPE_TEST_DATA's meshes/. Of the last the scan has holes, and its back is
/// cut open.
[[nodiscard]] const std::vector<std::string>& model_names();

/// Nothing, and a line printed, for a file that is not there. Error{config} for a name that is not listed.
[[nodiscard]] std::optional<Model> load_model(const std::string& name);

/// The names asked for, or all; those that can be loaded.
[[nodiscard]] std::vector<Model> load_models(const std::vector<std::string>& names);

/// Without the faces within `count` discs of `radius` (share of the mesh's own), and without the middle of
/// what faces away from `front`: an open back with its rim.
[[nodiscard]] TriangleMesh with_holes(const TriangleMesh& mesh, int count, double radius,
                                      const Eigen::Vector3d& front, std::uint64_t seed);

/// Centre and radius of a sphere about the mesh's bounding box.
struct Ball {
  Eigen::Vector3d center;
  double radius;
};
[[nodiscard]] Ball ball_about(const TriangleMesh& mesh);

}  // namespace drape::lab
