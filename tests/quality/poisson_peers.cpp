#include "poisson_peers.hpp"

#include <fmt/core.h>
#include <fmt/os.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>

#include "drape/io/mesh_files.hpp"
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

void write_ply(const std::filesystem::path& file, const PointCloud& cloud) {
  auto out = fmt::output_file(file.string());
  out.print("ply\nformat ascii 1.0\nelement vertex {}\n", cloud.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) out.print("property float {}\n", name);
  out.print("end_header\n");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    const Eigen::Vector3f& n = cloud.normals[i];
    out.print("{:.8g} {:.8g} {:.8g} {:.5f} {:.5f} {:.5f}\n", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
}

// Every parameter must be there, and no other.
void write_meshlab_script(const std::filesystem::path& file, int depth) {
  auto out = fmt::output_file(file.string());
  out.print(
      "<!DOCTYPE FilterScript>\n<FilterScript>\n"
      "<filter name=\"Surface Reconstruction: Screened Poisson\">\n"
      "<Param type=\"RichBool\" value=\"false\" name=\"visibleLayer\"/>\n"
      "<Param type=\"RichInt\" value=\"{}\" name=\"depth\"/>\n"
      "<Param type=\"RichInt\" value=\"5\" name=\"fullDepth\"/>\n"
      "<Param type=\"RichInt\" value=\"0\" name=\"cgDepth\"/>\n"
      "<Param type=\"RichFloat\" value=\"1.1\" name=\"scale\"/>\n"
      "<Param type=\"RichFloat\" value=\"1.5\" name=\"samplesPerNode\"/>\n"
      "<Param type=\"RichFloat\" value=\"4\" name=\"pointWeight\"/>\n"
      "<Param type=\"RichInt\" value=\"8\" name=\"iters\"/>\n"
      "<Param type=\"RichBool\" value=\"false\" name=\"confidence\"/>\n"
      "<Param type=\"RichBool\" value=\"false\" name=\"preClean\"/>\n"
      "</filter>\n</FilterScript>\n",
      depth);
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

std::optional<PeerMesh> meshlab_poisson_mesh(const PointCloud& cloud, int depth) {
  const ScratchFolder folder;
  write_ply(folder / "cloud.ply", cloud);
  write_meshlab_script(folder / "poisson.mlx", depth);
  const double start = children_cpu_seconds();
  const std::string command = fmt::format("xvfb-run -a meshlabserver -i '{}' -o '{}' -s '{}' > '{}' 2>&1",
                                          (folder / "cloud.ply").string(), (folder / "mesh.ply").string(),
                                          (folder / "poisson.mlx").string(), (folder / "log").string());
  // It may fail and exit with 0: what counts is what it wrote.
  if (std::system(command.c_str()) != 0 || !std::filesystem::exists(folder / "mesh.ply")) return std::nullopt;
  PeerMesh peer{io::read_mesh(folder / "mesh.ply"), children_cpu_seconds() - start};
  if (peer.mesh.empty()) return std::nullopt;
  return peer;
}

}  // namespace drape::test
