// What `drape info` says of a mesh.
#pragma once

#include <filesystem>
#include <optional>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::app {

/// The mesh in a file; nothing if it is a scan: a file of another kind, or a PLY without faces. Error{input}
/// if it looks like a mesh and cannot be read.
[[nodiscard]] std::optional<TriangleMesh> mesh_in(const std::filesystem::path& file);

/// One line a figure, to standard output.
void print_mesh_info(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace drape::app
