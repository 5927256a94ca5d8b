// Indexed triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drape {

using Face = std::array<std::uint32_t, 3>;

/// Counter-clockwise faces seen from outside. Attributes are either empty or as long as what they describe.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Face> faces;

  std::vector<Eigen::Vector3f> normals;  // per vertex, unit length
  std::vector<Eigen::Vector3f> colors;   // per vertex, as stored (sRGB-encoded), 0..1
  std::vector<float> intensities;        // per vertex, 0..1
  std::vector<float> confidences;        // per vertex, 0..1
  std::vector<std::uint8_t> filled;      // per face: 1 where hole filling made it

  [[nodiscard]] bool empty() const { return faces.empty(); }
};

/// Cross product of two edges: its length is twice the area; zero for a degenerate face.
[[nodiscard]] Eigen::Vector3d scaled_face_normal(const TriangleMesh& mesh, std::size_t face);

/// Area-weighted mean of the adjacent faces' normals, unit length; zero where a vertex has no face with area.
[[nodiscard]] std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

[[nodiscard]] double surface_area(const TriangleMesh& mesh);

/// Signed volume by the divergence theorem; meaningful for a closed mesh. Positive for outward faces.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// Median length over all faces' edges; 0 for a mesh without faces. It stands for the point spacing of a mesh
/// that no scan came with.
[[nodiscard]] double median_edge_length(const TriangleMesh& mesh);

/// The mesh without vertices that no face uses, order kept.
[[nodiscard]] TriangleMesh without_unused_vertices(const TriangleMesh& mesh);

/// The mesh with the faces for which keep[face] is not 0, and without vertices that no longer have one.
[[nodiscard]] TriangleMesh with_faces(const TriangleMesh& mesh, const std::vector<std::uint8_t>& keep);

/// Empty if the mesh keeps its promises; else what is wrong: an index out of range, a coordinate that is not
/// finite, an attribute of another length.
[[nodiscard]] std::string problem_of(const TriangleMesh& mesh);

}  // namespace drape
