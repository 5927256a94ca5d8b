#include "marching_cubes.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <bit>

#include "cube_cases.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"

namespace drape::meshing {
namespace {

constexpr int side = VoxelLattice::block;
constexpr std::size_t blocks_per_chunk = 256;

// A block's values with the first ones of its upper neighbours, and what they say as bits: bit x of a row.
class CubeCorners {
 public:
  CubeCorners(const FusionBlocks& blocks, const FusedField& field, std::size_t block)
      : neighbors_(blocks.upper_neighbors(block)) {
    for (int z = 0; z <= side; ++z)
      for (int y = 0; y <= side; ++y) {
        const std::size_t neighbor = static_cast<std::size_t>((y == side ? 2 : 0) | (z == side ? 4 : 0));
        std::int16_t* const row = &values_[place(0, y, z)];
        copy_row(field, neighbors_[neighbor], y % side, z % side, side, row);
        copy_row(field, neighbors_[neighbor | 1], y % side, z % side, 1, row + side);
        std::uint16_t inside = 0;
        std::uint16_t known = 0;
        std::uint16_t seen = 0;
        for (int x = 0; x <= side; ++x) {
          inside = static_cast<std::uint16_t>(inside | (row[x] < 0 ? 1 << x : 0));
          known = static_cast<std::uint16_t>(known | (row[x] != FusedField::unknown ? 1 << x : 0));
          seen =
              static_cast<std::uint16_t>(seen | (row[x] >= 0 && !FusedField::is_guess(row[x]) ? 1 << x : 0));
        }
        outside_seen_[row_of(y, z)] = seen;
        inside_[row_of(y, z)] = inside;
        known_[row_of(y, z)] = known;
      }
  }

  [[nodiscard]] std::int16_t value(int x, int y, int z) const { return values_[place(x, y, z)]; }
  [[nodiscard]] std::uint32_t neighbor(int k) const { return neighbors_[static_cast<std::size_t>(k)]; }

  [[nodiscard]] CutEdges cut_edges() const {
    CutEdges edges;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y) {
        const auto add = [&](std::size_t axis, std::uint32_t differ, std::uint32_t both_known) {
          edges.cut[axis][static_cast<std::size_t>(z)] |= std::uint64_t{differ & both_known & 0xff}
                                                          << (8 * y);
        };
        const std::uint32_t inside = inside_[row_of(y, z)];
        const std::uint32_t known = known_[row_of(y, z)];
        add(0, inside ^ (inside >> 1), known & (known >> 1));
        add(1, inside ^ inside_[row_of(y + 1, z)], known & known_[row_of(y + 1, z)]);
        add(2, inside ^ inside_[row_of(y, z + 1)], known & known_[row_of(y, z + 1)]);
      }
    edges.number();
    return edges;
  }

  /// Calls visit(x, y, z, the cube's inside corners) for each cube with surface.
  template <class Visit>
  void for_each_cube(Visit visit) const {
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y) {
        std::array<std::uint32_t, 4> rows{};
        std::uint32_t known = 0xffff;
        std::uint32_t any = 0;
        std::uint32_t seen = 0;
        for (int k = 0; k < 4; ++k) {
          const std::size_t row = row_of(y + (k & 1), z + (k >> 1));
          rows[static_cast<std::size_t>(k)] = inside_[row];
          known &= known_[row];
          seen |= outside_seen_[row];
          any |= inside_[row];
        }
        std::uint32_t cubes = known & (known >> 1) & (any | (any >> 1)) & (seen | (seen >> 1)) & 0xff;
        for (; cubes != 0; cubes &= cubes - 1) {
          const int x = std::countr_zero(cubes);
          int inside = 0;
          for (int k = 0; k < 4; ++k)
            inside |= static_cast<int>((rows[static_cast<std::size_t>(k)] >> x) & 3) << (2 * k);
          visit(x, y, z, inside);
        }
      }
  }

 private:
  static std::size_t row_of(int y, int z) { return static_cast<std::size_t>(z * (side + 1) + y); }
  static std::size_t place(int x, int y, int z) {
    return row_of(y, z) * (side + 1) + static_cast<std::size_t>(x);
  }
  static void copy_row(const FusedField& field, std::uint32_t block, int y, int z, int count,
                       std::int16_t* to) {
    if (block == FusionBlocks::none)
      std::fill_n(to, count, FusedField::unknown);
    else
      std::copy_n(&field.of_block(block)[static_cast<std::size_t>((z * side + y) * side)], count, to);
  }

  std::array<std::uint32_t, 8> neighbors_;
  std::array<std::int16_t, (side + 1) * (side + 1) * (side + 1)> values_{};
  std::array<std::uint16_t, (side + 1) * (side + 1)> inside_{};
  std::array<std::uint16_t, (side + 1) * (side + 1)> known_{};
  std::array<std::uint16_t, (side + 1) * (side + 1)> outside_seen_{};
};

void place_vertices(const CubeCorners& corners, const CutEdges& edges, Eigen::Vector3f* vertex) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int z = 0; z < side; ++z)
      for (std::uint64_t cut = edges.cut[axis][static_cast<std::size_t>(z)]; cut != 0; cut &= cut - 1) {
        const int place = std::countr_zero(cut);
        const int x = place % side;
        const int y = place / side;
        const auto from = static_cast<float>(corners.value(x, y, z));
        const auto to = static_cast<float>(corners.value(x + (axis == 0), y + (axis == 1), z + (axis == 2)));
        Eigen::Vector3f at = Eigen::Vector3i(x, y, z).cast<float>();
        // Away from the ends, where the triangles of several edges would shrink to nothing.
        at[static_cast<Eigen::Index>(axis)] += std::clamp(from / (from - to), 0.02F, 0.98F);
        *vertex++ = at;
      }
}

// Freed blocks of some megabytes stay with the process otherwise, and this is where memory peaks.
void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

template <class Attribute>
void append(std::vector<Attribute>& to, std::vector<Attribute>& from) {
  to.insert(to.end(), from.begin(), from.end());
  from = {};
}

}  // namespace

void CutEdges::number() {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t z = 0; z < side; ++z) {
      before[axis][z] = count;
      count = static_cast<std::uint16_t>(count + std::popcount(cut[axis][z]));
    }
}

std::uint32_t CutEdges::rank(std::size_t axis, int x, int y, int z) const {
  const std::uint64_t ahead = (std::uint64_t{1} << (8 * y + x)) - 1;
  return before[axis][static_cast<std::size_t>(z)] +
         static_cast<std::uint32_t>(std::popcount(cut[axis][static_cast<std::size_t>(z)] & ahead));
}

void MarchingCubes::number(const FusedField& field, std::size_t end) {
  const std::size_t known = edges_.size();
  edges_.resize(end - first_block_);
  face_counts_.resize(edges_.size(), 0);
  parallel_for(edges_.size() - known, blocks_per_chunk, [&](std::size_t begin, std::size_t chunk_end) {
    for (std::size_t k = known + begin; k < known + chunk_end; ++k) {
      const CubeCorners corners(blocks_, field, first_block_ + k);
      edges_[k] = corners.cut_edges();
      corners.for_each_cube([&](int, int, int, int inside) {
        face_counts_[k] +=
            static_cast<std::uint32_t>(cube_cases()[static_cast<std::size_t>(inside)].triangles);
      });
    }
  });
  std::uint64_t vertices = first_vertex_.back();
  for (std::size_t k = known; k < edges_.size(); ++k) {
    first_vertex_.push_back(static_cast<std::uint32_t>(vertices += edges_[k].count));
    faces_ += face_counts_[k];
  }
  if (vertices > 0xffffffffU || faces_ > 0xffffffffU)
    throw input_error(
        "the mesh would have more than {} faces, more than can be numbered: make the voxels larger",
        0xffffffffU);
}

SurfacePart MarchingCubes::part(const FusedField& field, std::size_t end) {
  const std::size_t count = end - first_block_;
  SurfacePart part;
  part.first_block = first_block_;
  part.first_vertex.assign(first_vertex_.begin(),
                           first_vertex_.begin() + static_cast<std::ptrdiff_t>(count) + 1);
  std::vector<std::size_t> first_face(count + 1, 0);
  for (std::size_t k = 0; k < count; ++k) first_face[k + 1] = first_face[k] + face_counts_[k];
  part.places.resize(part.first_vertex.back() - part.first_vertex.front());
  part.faces.resize(first_face.back());
  parallel_for(count, blocks_per_chunk, [&](std::size_t begin, std::size_t chunk_end) {
    for (std::size_t k = begin; k < chunk_end; ++k) {
      if (edges_[k].count == 0 && face_counts_[k] == 0) continue;
      const CubeCorners corners(blocks_, field, first_block_ + k);
      place_vertices(corners, edges_[k], part.places.data() + first_vertex_[k] - first_vertex_[0]);
      Face* face = part.faces.data() + first_face[k];
      corners.for_each_cube([&](int x, int y, int z, int inside) {
        const CubeCase& cube = cube_cases()[static_cast<std::size_t>(inside)];
        for (int t = 0; t < cube.triangles; ++t, ++face)
          for (std::size_t c = 0; c < 3; ++c) {
            const int edge = cube.edges[static_cast<std::size_t>(t)][c];
            const int corner = edge_corner(edge);
            const int ex = x + (corner & 1);
            const int ey = y + ((corner >> 1) & 1);
            const int ez = z + (corner >> 2);
            const std::size_t owner =
                corners.neighbor((ex / side) | (ey / side) << 1 | (ez / side) << 2) - first_block_;
            (*face)[c] = first_vertex_[owner] + edges_[owner].rank(static_cast<std::size_t>(edge / 4),
                                                                   ex % side, ey % side, ez % side);
          }
      });
    }
  });
  const auto gone = static_cast<std::ptrdiff_t>(count);
  edges_.erase(edges_.begin(), edges_.begin() + gone);
  face_counts_.erase(face_counts_.begin(), face_counts_.begin() + gone);
  first_vertex_.erase(first_vertex_.begin(), first_vertex_.begin() + gone);
  first_block_ = end;
  return part;
}

TriangleMesh joined(std::vector<SurfacePart> parts, const FusionBlocks& blocks) {
  TriangleMesh mesh;
  std::size_t faces = 0;
  for (const SurfacePart& part : parts) faces += part.faces.size();
  const std::size_t vertices = parts.empty() ? 0 : parts.back().first_vertex.back();
  mesh.vertices.resize(vertices);
  mesh.faces.reserve(faces);
  const auto expect = [&](auto& attribute, const auto& first) {
    attribute.reserve(first.empty() ? 0 : vertices);
  };
  if (!parts.empty()) {
    expect(mesh.colors, parts.front().colors);
    expect(mesh.intensities, parts.front().intensities);
    expect(mesh.confidences, parts.front().confidences);
  }
  constexpr std::size_t faces_between_returns = 4'000'000;
  std::size_t next_return = 0;
  for (SurfacePart& part : parts) {
    if (mesh.faces.size() >= next_return) {
      return_freed_memory();
      next_return = mesh.faces.size() + faces_between_returns;
    }
    parallel_for(part.first_vertex.size() - 1, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Eigen::Vector3d corner = blocks.corner(part.first_block + k).cast<double>();
        for (std::uint32_t v = part.first_vertex[k]; v < part.first_vertex[k + 1]; ++v)
          mesh.vertices[v] =
              blocks.lattice.position(corner + part.places[v - part.first_vertex.front()].cast<double>());
      }
    });
    append(mesh.faces, part.faces);
    append(mesh.colors, part.colors);
    append(mesh.intensities, part.intensities);
    append(mesh.confidences, part.confidences);
    part = {};
  }
  return mesh;
}

}  // namespace drape::meshing
