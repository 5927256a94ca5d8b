#include <cmath>
#include <limits>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/io/mesh_files.hpp"
#include "mesh_formats.hpp"
#include "ply_vertices.hpp"

namespace drape::io {
namespace {

std::vector<PlyWanted> mesh_columns() {
  std::vector<PlyWanted> wanted = vertex_columns();
  wanted.push_back({"face", "vertex_indices", "vertex"});
  wanted.push_back({"face", "vertex_index", "vertex"});
  wanted.push_back({"face", "filled"});
  wanted.push_back({"tristrips", "vertex_indices", "vertex", -1});
  wanted.push_back({"tristrips", "vertex_index", "vertex", -1});
  return wanted;
}

/// A face may not use a vertex that is not finite.
void check_corner(const PlyFile& ply, const PlyTable& table, std::size_t row, const TriangleMesh& mesh,
                  std::uint32_t v) {
  if (!mesh.vertices[v].allFinite())
    throw ply.row_error(
        table, row,
        fmt::format("the face uses vertex {}, which has a coordinate that is not a finite number", v));
}

std::size_t append_triangle(std::vector<Face>& faces, const std::vector<std::uint32_t>& corners) {
  faces.push_back({corners[0], corners[1], corners[2]});
  return 1;
}

void add_faces(const PlyFile& ply, TriangleMesh& mesh) {
  const PlyTable* table = ply.table("face");
  const PlyColumn* corners =
      table == nullptr ? nullptr : table->column_of({"vertex_indices", "vertex_index"});
  if (corners == nullptr) return;
  if (!corners->property.list) throw input_error("{}: the corners of the faces are no list", ply.file);
  const PlyColumn* filled = table->column("filled");
  if (filled != nullptr && filled->property.list) filled = nullptr;
  const bool exact = has_mark(ply.header);
  std::size_t skipped = 0;
  std::vector<std::uint32_t> polygon;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    polygon.clear();
    for (const double value : corners->row(row)) {
      polygon.push_back(static_cast<std::uint32_t>(value));
      check_corner(ply, *table, row, mesh, polygon.back());
    }
    const std::size_t added =
        exact && polygon.size() == 3 ? append_triangle(mesh.faces, polygon) : append_fan(mesh.faces, polygon);
    if (added == 0) ++skipped;
    if (filled != nullptr) mesh.filled.insert(mesh.filled.end(), added, filled->values[row] != 0 ? 1 : 0);
  }
  if (skipped > 0)
    log::info("{}: {} faces with fewer than three different corners are left out", ply.file, skipped);
}

/// Strips of triangles: each vertex makes one with the two before it, every second one turned; a negative
/// value ends a strip.
void add_strips(const PlyFile& ply, TriangleMesh& mesh) {
  const PlyTable* table = ply.table("tristrips");
  const PlyColumn* strips = table == nullptr ? nullptr : table->column_of({"vertex_indices", "vertex_index"});
  if (strips == nullptr || !strips->property.list) return;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const std::span<const double> strip = strips->row(row);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] < 0) {
        begin = i + 1;
        continue;
      }
      const auto c = static_cast<std::uint32_t>(strip[i]);
      check_corner(ply, *table, row, mesh, c);
      if (i < begin + 2) continue;
      auto a = static_cast<std::uint32_t>(strip[i - 2]);
      auto b = static_cast<std::uint32_t>(strip[i - 1]);
      if ((i - begin) % 2 == 1) std::swap(a, b);
      if (a != b && b != c && c != a) mesh.faces.push_back({a, b, c});
    }
  }
  if (!mesh.filled.empty()) mesh.filled.resize(mesh.faces.size(), 0);
}

}  // namespace

TriangleMesh read_ply_mesh(const std::string& file, std::string_view bytes) {
  const PlyFile ply = parse_ply(file, bytes, mesh_columns());
  PointCloud cloud = vertices_of(ply);
  if (cloud.size() > std::numeric_limits<std::uint32_t>::max())
    throw input_error("{}: has more than 2^32 - 1 vertices", file);
  TriangleMesh mesh;
  mesh.vertices = std::move(cloud.positions);
  mesh.normals = std::move(cloud.normals);
  mesh.colors = std::move(cloud.colors);
  mesh.intensities = std::move(cloud.intensities);
  mesh.confidences = std::move(cloud.confidences);
  add_faces(ply, mesh);
  add_strips(ply, mesh);
  return mesh;
}

void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh) {
  if (mesh.vertices.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw io_error("{}: more vertices than a PLY with 32-bit indices can hold", file.string());
  PlyBuilder ply;
  put_mark(ply, "mesh");
  const VertexWriter vertices(mesh);
  vertices.declare(ply);
  ply.element("face", mesh.faces.size());
  ply.list_property(PlyType::uint8, PlyType::int32, "vertex_indices");
  if (!mesh.filled.empty()) ply.property(PlyType::uint8, "filled");
  ply.end_header(vertices.bytes() + 14 * mesh.faces.size());
  vertices.put_rows(ply);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    ply.put_byte(3);
    for (const std::uint32_t v : mesh.faces[i]) ply.put_int(static_cast<std::int32_t>(v));
    if (!mesh.filled.empty()) ply.put_byte(mesh.filled[i]);
  }
  write_file(file, ply.bytes());
}

}  // namespace drape::io
