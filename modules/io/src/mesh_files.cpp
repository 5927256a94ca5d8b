#include "drape/io/mesh_files.hpp"

#include <algorithm>
#include <array>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "mesh_formats.hpp"

namespace drape::io {
namespace {

bool no_signature(std::string_view) {
  return false;
}
bool looks_like_ply(std::string_view bytes) {
  return bytes.size() > 3 && bytes.starts_with("ply") &&
         (bytes[3] == '\n' || bytes[3] == '\r' || bytes[3] == ' ');
}

struct MeshFormat {
  std::string_view extension;
  bool (*recognises)(std::string_view bytes);
  MeshReader read;
};

// Content counts before the extension: the first that recognises the bytes, else the one of the extension.
constexpr std::array<MeshFormat, 4> formats{{
    {"ply", looks_like_ply, read_ply_mesh},
    {"off", looks_like_off, read_off_mesh},
    {"stl", looks_like_binary_stl, read_stl_mesh},
    {"obj", no_signature, read_obj_mesh},
}};

const MeshFormat& format_of(const std::filesystem::path& file, std::string_view bytes) {
  for (const MeshFormat& format : formats)
    if (format.recognises(bytes)) return format;
  const std::string ending = extension(file);
  std::string known;
  for (const MeshFormat& format : formats) {
    if (format.extension == ending) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  throw input_error("{}: is no mesh format that can be read ({})", file.string(), known);
}

/// Vertices that are not finite: no face uses one, so they go, and the others move up.
TriangleMesh without_bad_vertices(const std::string& file, TriangleMesh mesh) {
  const auto bad = static_cast<std::size_t>(std::count_if(
      mesh.vertices.begin(), mesh.vertices.end(), [](const Eigen::Vector3d& v) { return !v.allFinite(); }));
  if (bad == 0) return mesh;
  log::warn("{}: {} vertices that are not finite are left out; no face uses them", file, bad);
  return without_unused_vertices(mesh);
}

}  // namespace

std::size_t append_fan(std::vector<Face>& faces, std::span<const std::uint32_t> corners) {
  const std::size_t before = faces.size();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Face face{corners[0], corners[i - 1], corners[i]};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) faces.push_back(face);
  }
  return faces.size() - before;
}

TriangleMesh parse_mesh(const std::string& file, std::string_view bytes) {
  return format_of(file, bytes).read(file, bytes);
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  if (bytes.empty()) throw input_error("{}: is empty", file.string());
  TriangleMesh mesh = parse_mesh(file.string(), bytes);
  if (mesh.faces.empty())
    throw input_error("{}: has no faces: it is a point cloud or an empty mesh", file.string());
  return without_bad_vertices(file.string(), std::move(mesh));
}

}  // namespace drape::io
