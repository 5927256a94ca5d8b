// Screened Poisson reconstruction by pcl-tools, run as a program of its own.
#pragma once

#include <optional>

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

struct PeerMesh {
  TriangleMesh mesh;
  double cpu_seconds = 0;
};

/// What pcl_poisson_reconstruction makes of a cloud with normals; nothing where it is not installed or wrote
/// no mesh.
[[nodiscard]] std::optional<PeerMesh> pcl_poisson_mesh(const PointCloud& cloud, int depth);

/// The same by MeshLab (`meshlabserver` under `xvfb-run`; Debian packages meshlab and xvfb), whose filter is
/// the screened Poisson reconstruction of Kazhdan and Hoppe 2013, with its parameters' defaults.
[[nodiscard]] std::optional<PeerMesh> meshlab_poisson_mesh(const PointCloud& cloud, int depth);

}  // namespace drape::test
