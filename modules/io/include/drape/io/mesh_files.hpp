// Triangle mesh files.
#pragma once

#include <filesystem>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::io {

/// PLY, OBJ, STL (ASCII and binary) or OFF, by content where it can be told, else by extension, in the file's
/// own units. Polygons are split into fans; STL's repeated corners are welded. Colours, normals, intensity,
/// confidence and `filled` are kept where the file has them (normals of an OBJ where each vertex has just
/// one). Triangle strips of a PLY are taken apart. Faces with fewer than three different corners are left
/// out, and so are vertices that are not finite if no face uses them. Error{input} with file and line or
/// byte: missing or empty file, no faces, counts that the bytes do not hold (known before anything is
/// allocated for them), a corner out of range or not finite, a truncated file, data that go on after the last
/// declared row.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& file);

/// Binary little-endian PLY with doubles and every attribute that the mesh has. Reads back to the same bits.
void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh);

/// Binary STL: float32 corners and face normals, nothing else. Error{io}; Error{input} for a mesh that breaks
/// its promises.
void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace drape::io
