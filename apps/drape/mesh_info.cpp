// What `drape info` says of a mesh.
#include "mesh_info.hpp"

#include <fmt/core.h>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/meshing/mesh_quality.hpp"

namespace drape::app {
namespace {

void row(const char* name, const std::string& value) {
  fmt::print("  {:<24} {}\n", name, value);
}

// "1 edge with more than two faces, ..." or that there is nothing to say.
std::string flaws(const meshing::MeshQuality& quality) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "no: " : ", ", count, what);
  };
  add(quality.non_manifold_edges, "edges with more than two faces");
  add(quality.non_manifold_vertices, "vertices where fans of faces touch");
  add(quality.inconsistent_edges, "edges between faces of opposite orientation");
  return text.empty() ? "yes" : text;
}

std::string attributes(const TriangleMesh& mesh) {
  std::string text;
  const auto add = [&](bool there, const char* what) {
    if (there) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  add(!mesh.normals.empty(), "normals");
  add(!mesh.colors.empty(), "colours");
  add(!mesh.intensities.empty(), "intensity");
  add(!mesh.confidences.empty(), "confidence");
  add(!mesh.filled.empty(), "filled");
  return text.empty() ? "none" : text;
}

}  // namespace

std::optional<TriangleMesh> mesh_in(const std::filesystem::path& file) {
  const std::string kind = extension(file);
  if (kind != "obj" && kind != "stl" && kind != "off" && kind != "ply") return std::nullopt;
  try {
    return io::read_mesh(file);
  } catch (const Error&) {
    if (kind != "ply") throw;
    return std::nullopt;  // read as a scan, a broken file is named as well
  }
}

void print_mesh_info(const std::filesystem::path& file, const TriangleMesh& mesh) {
  const meshing::MeshQuality quality = meshing::mesh_quality(mesh);
  const Eigen::Vector3d size = bounding_box(mesh.vertices).sizes();
  fmt::print("{}: mesh, lengths in the file's unit\n", file.string());
  row("vertices", fmt::format("{}", quality.vertices));
  row("faces", fmt::format("{}", quality.faces));
  row("attributes", attributes(mesh));
  row("size", fmt::format("{:.6g} x {:.6g} x {:.6g}", size.x(), size.y(), size.z()));
  row("spacing (median edge)", fmt::format("{:.4g}", quality.median_edge));
  row("area", fmt::format("{:.6g}", quality.area));
  row("components", fmt::format("{}", quality.components));
  std::string loops = fmt::format("{}", quality.boundary_loops);
  if (quality.borders != quality.boundary_loops)
    loops += fmt::format(", some of which touch: they form {} borders", quality.borders);
  row("boundary loops", loops);
  row("boundary edges", fmt::format("{}", quality.boundary_edges));
  row("manifold", flaws(quality));
  row("genus", quality.genus ? fmt::format("{}", *quality.genus) : "not defined: not manifold");
  row("volume", quality.volume ? fmt::format("{:.6g}{}", *quality.volume,
                                             *quality.volume < 0 ? " (faces look inwards)" : "")
                               : "not defined: not closed");
  row("faces without area", fmt::format("{}", quality.degenerate_faces));
  row("self-intersections", fmt::format("{} pairs of faces", quality.self_intersections));
}

}  // namespace drape::app
