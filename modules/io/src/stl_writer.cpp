// Binary STL (3D Systems, "StereoLithography Interface Specification").
#include <array>
#include <bit>
#include <limits>
#include <string>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"

namespace drape::io {

void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("{}: cannot be written: {}", file.string(), problem);
  if (mesh.faces.size() > std::numeric_limits<std::uint32_t>::max())
    throw input_error("{}: more faces than an STL can hold", file.string());
  std::string bytes = "drape";
  bytes.resize(80, ' ');
  bytes.reserve(84 + 50 * mesh.faces.size());
  const auto put = [&](auto value) {
    const auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    bytes.append(raw.data(), raw.size());
  };
  put(static_cast<std::uint32_t>(mesh.faces.size()));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d normal = scaled_face_normal(mesh, f).stableNormalized();
    for (const double x : normal) put(static_cast<float>(x));
    for (const std::uint32_t v : mesh.faces[f])
      for (const double x : mesh.vertices[v]) put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  write_file(file, bytes);
}

}  // namespace drape::io
