#include "marching_cubes.hpp"

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

// Which of a block's own edges (from a voxel towards +x, +y or +z) the surface cuts: bit x of byte y of word
// z, for each axis. The cut edges are numbered in that order.
struct CutEdges {
  std::array<std::array<std::uint64_t, side>, 3> cut{};
  std::array<std::array<std::uint16_t, side>, 3> before{};  // cut edges ahead of each word
  std::uint16_t count = 0;

  void number() {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t z = 0; z < side; ++z) {
        before[axis][z] = count;
        count = static_cast<std::uint16_t>(count + std::popcount(cut[axis][z]));
      }
  }
  [[nodiscard]] std::uint32_t rank(std::size_t axis, int x, int y, int z) const {
    const std::uint64_t ahead = (std::uint64_t{1} << (8 * y + x)) - 1;
    return before[axis][static_cast<std::size_t>(z)] +
           static_cast<std::uint32_t>(std::popcount(cut[axis][static_cast<std::size_t>(z)] & ahead));
  }
};

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

// How many vertices and faces the blocks before each block have.
struct Numbering {
  std::vector<CutEdges> edges;
  std::vector<std::uint32_t> first_vertex;
  std::vector<std::uint32_t> first_face;
};

Numbering number_all(const FusionBlocks& blocks, const FusedField& field) {
  Numbering numbers;
  numbers.edges.resize(blocks.size());
  numbers.first_vertex.assign(blocks.size() + 1, 0);
  numbers.first_face.assign(blocks.size() + 1, 0);
  parallel_for(blocks.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const CubeCorners corners(blocks, field, b);
      numbers.edges[b] = corners.cut_edges();
      numbers.first_vertex[b + 1] = numbers.edges[b].count;
      corners.for_each_cube([&](int, int, int, int inside) {
        numbers.first_face[b + 1] +=
            static_cast<std::uint32_t>(cube_cases()[static_cast<std::size_t>(inside)].triangles);
      });
    }
  });
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    numbers.first_vertex[b + 1] = static_cast<std::uint32_t>(vertices += numbers.first_vertex[b + 1]);
    numbers.first_face[b + 1] = static_cast<std::uint32_t>(faces += numbers.first_face[b + 1]);
  }
  if (vertices > 0xffffffffU || faces > 0xffffffffU)
    throw input_error("the mesh would have {} faces, more than can be numbered: make the voxels larger",
                      faces);
  return numbers;
}

void place_vertices(const FusionBlocks& blocks, const CubeCorners& corners, std::size_t block,
                    const CutEdges& edges, Eigen::Vector3d* vertex) {
  const Eigen::Vector3d corner = blocks.corner(block).cast<double>();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int z = 0; z < side; ++z)
      for (std::uint64_t cut = edges.cut[axis][static_cast<std::size_t>(z)]; cut != 0; cut &= cut - 1) {
        const int place = std::countr_zero(cut);
        const int x = place % side;
        const int y = place / side;
        const double from = corners.value(x, y, z);
        const double to = corners.value(x + (axis == 0), y + (axis == 1), z + (axis == 2));
        Eigen::Vector3d at(x, y, z);
        // Away from the ends, where the triangles of several edges would shrink to nothing.
        at[static_cast<Eigen::Index>(axis)] += std::clamp(from / (from - to), 0.02, 0.98);
        *vertex++ = blocks.lattice.position(corner + at);
      }
}

void place_faces(const CubeCorners& corners, const Numbering& numbers, Face* face) {
  corners.for_each_cube([&](int x, int y, int z, int inside) {
    const CubeCase& cube = cube_cases()[static_cast<std::size_t>(inside)];
    for (int t = 0; t < cube.triangles; ++t, ++face)
      for (std::size_t k = 0; k < 3; ++k) {
        const int edge = cube.edges[static_cast<std::size_t>(t)][k];
        const int corner = edge_corner(edge);
        const int ex = x + (corner & 1);
        const int ey = y + ((corner >> 1) & 1);
        const int ez = z + (corner >> 2);
        const std::uint32_t owner = corners.neighbor((ex / side) | (ey / side) << 1 | (ez / side) << 2);
        (*face)[k] =
            numbers.first_vertex[owner] +
            numbers.edges[owner].rank(static_cast<std::size_t>(edge / 4), ex % side, ey % side, ez % side);
      }
  });
}

}  // namespace

FieldSurface field_surface(const FusionBlocks& blocks, const FusedField& field) {
  Numbering numbers = number_all(blocks, field);
  FieldSurface surface;
  surface.mesh.vertices.resize(numbers.first_vertex.back());
  surface.mesh.faces.resize(numbers.first_face.back());
  parallel_for(blocks.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const CubeCorners corners(blocks, field, b);
      place_vertices(blocks, corners, b, numbers.edges[b],
                     surface.mesh.vertices.data() + numbers.first_vertex[b]);
      place_faces(corners, numbers, surface.mesh.faces.data() + numbers.first_face[b]);
    }
  });
  surface.first_vertex = std::move(numbers.first_vertex);
  return surface;
}

}  // namespace drape::meshing
