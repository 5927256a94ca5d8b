// The surface of a fused field in triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"
#include "fused_field.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

/// The part of a surface that consecutive blocks make. Vertices are numbered through all parts, in the order
/// of the blocks.
struct SurfacePart {
  std::size_t first_block = 0;
  std::vector<std::uint32_t> first_vertex;  // the k-th block's are first_vertex[k] .. first_vertex[k + 1] - 1
  std::vector<Eigen::Vector3f> places;      // of the part's vertices, in voxels from their block's corner
  std::vector<Face> faces;
  std::vector<Eigen::Vector3f> colors;  // per vertex, as in TriangleMesh
  std::vector<float> intensities;
  std::vector<float> confidences;
};

/// Which of a block's own edges (from a voxel towards +x, +y or +z) the surface cuts: bit x of byte y of word
/// z, for each axis. The cut edges are numbered in that order.
struct CutEdges {
  static constexpr int side = VoxelLattice::block;
  std::array<std::array<std::uint64_t, side>, 3> cut{};
  std::array<std::array<std::uint16_t, side>, 3> before{};  // cut edges ahead of each word
  std::uint16_t count = 0;

  void number();
  [[nodiscard]] std::uint32_t rank(std::size_t axis, int x, int y, int z) const;
};

/// Marching cubes (Lorensen and Cline 1987) over the cubes of which all eight corners are known, and one
/// in front of the surface by more than a guess. Every edge has at most two faces, and they agree on the
/// outside, which is where the field is positive. A vertex is shared by all cubes round its edge, and at
/// least 2 % of the edge from its ends. Some may have no face. The blocks are gone through in their order,
/// and only those that the next ones touch need be there at a time.
class MarchingCubes {
 public:
  explicit MarchingCubes(const FusionBlocks& blocks) : blocks_(blocks) {}

  /// Numbers the vertices of the blocks up to `end`. The field must hold those that are not numbered yet and
  /// their upper neighbours. Error{input} where there are more than 2^32.
  void number(const FusedField& field, std::size_t end);
  /// The part of the next blocks up to `end`. They and their upper neighbours must be numbered and in the
  /// field. After this only later blocks can be asked for.
  [[nodiscard]] SurfacePart part(const FusedField& field, std::size_t end);

 private:
  const FusionBlocks& blocks_;
  std::size_t first_block_ = 0;  // of those that are numbered, and not yet part
  std::vector<CutEdges> edges_;
  std::vector<std::uint32_t> first_vertex_ = {0};
  std::vector<std::uint32_t> face_counts_;
  std::uint64_t faces_ = 0;
};

/// The parts as one mesh, in the order of their vertices. Each part is freed as soon as it is copied.
[[nodiscard]] TriangleMesh joined(std::vector<SurfacePart> parts, const FusionBlocks& blocks);

}  // namespace drape::meshing
