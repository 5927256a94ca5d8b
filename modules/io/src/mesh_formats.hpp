// The mesh formats: one file and one reader each, listed in the table of mesh_files.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::io {

/// The mesh in the bytes of a file; `file` is named in errors. A vertex that is not finite may be there if no
/// face uses it: read_mesh leaves it out.
using MeshReader = TriangleMesh (*)(const std::string& file, std::string_view bytes);

[[nodiscard]] TriangleMesh read_ply_mesh(const std::string& file, std::string_view bytes);
[[nodiscard]] TriangleMesh read_obj_mesh(const std::string& file, std::string_view bytes);
[[nodiscard]] TriangleMesh read_stl_mesh(const std::string& file, std::string_view bytes);
[[nodiscard]] TriangleMesh read_off_mesh(const std::string& file, std::string_view bytes);

/// By content where it can be told, else by extension.
[[nodiscard]] TriangleMesh parse_mesh(const std::string& file, std::string_view bytes);

/// What the content tells.
[[nodiscard]] bool looks_like_binary_stl(std::string_view bytes);
[[nodiscard]] bool looks_like_off(std::string_view bytes);

/// Appends the fan of a polygon with three or more corners, all of them valid vertices. Triangles that name a
/// vertex twice have no area and are left out. Returns how many were added.
std::size_t append_fan(std::vector<Face>& faces, std::span<const std::uint32_t> corners);

}  // namespace drape::io
