#include "pcl_poisson_peer.hpp"

#include <fmt/core.h>
#include <fmt/os.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>

#include "support.hpp"

namespace drape::test {
namespace {

double children_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void write_pcd(const std::filesystem::path& file, const PointCloud& cloud) {
  auto out = fmt::output_file(file.string());
  out.print(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z curvature\nSIZE 4 4 4 4 4 4 4\n"
      "TYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\n"
      "DATA ascii\n",
      cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    const Eigen::Vector3f& n = cloud.normals[i];
    out.print("{:.8g} {:.8g} {:.8g} {:.5f} {:.5f} {:.5f} 0\n", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
}

TriangleMesh read_vtk(const std::filesystem::path& file) {
  std::ifstream in(file);
  TriangleMesh mesh;
  std::size_t count = 0;
  for (std::string word; in >> word;) {
    if (word == "POINTS") {
      in >> count >> word;
      mesh.vertices.resize(count);
      for (Eigen::Vector3d& p : mesh.vertices) in >> p.x() >> p.y() >> p.z();
    } else if (word == "POLYGONS") {
      in >> count >> word;
      for (std::size_t i = 0; i < count; ++i) {
        Face f{};
        in >> word >> f[0] >> f[1] >> f[2];
        mesh.faces.push_back(f);
      }
    }
  }
  return mesh;
}

}  // namespace

std::optional<PeerMesh> pcl_poisson_mesh(const PointCloud& cloud, int depth) {
  const ScratchFolder folder;
  write_pcd(folder / "cloud.pcd", cloud);
  const double start = children_cpu_seconds();
  const std::string command = fmt::format("pcl_poisson_reconstruction '{}' '{}' -depth {} > '{}' 2>&1",
                                          (folder / "cloud.pcd").string(), (folder / "mesh.vtk").string(),
                                          depth, (folder / "log").string());
  if (std::system(command.c_str()) != 0) return std::nullopt;
  PeerMesh peer{read_vtk(folder / "mesh.vtk"), children_cpu_seconds() - start};
  if (peer.mesh.empty()) return std::nullopt;
  return peer;
}

}  // namespace drape::test
