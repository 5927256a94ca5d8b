// The triangles of marching cubes, case by case.
#pragma once

#include <array>
#include <cstdint>

namespace drape::meshing {

/// Corner c of a cube lies at x = bit 0, y = bit 1, z = bit 2 of c. Edge e runs along axis e / 4 from the
/// corner `edge_corner(e)`.
[[nodiscard]] constexpr int edge_corner(int edge) {
  const int axis = edge / 4;
  const int low = edge % 4 & 1;    // in the next axis
  const int high = edge % 4 >> 1;  // in the one after that
  return (low << ((axis + 1) % 3)) | (high << ((axis + 2) % 3));
}

struct CubeCase {
  static constexpr int most_triangles = 5;
  int triangles = 0;
  std::array<std::array<std::uint8_t, 3>, most_triangles> edges{};  // counter-clockwise seen from outside
};

/// For each set of corners that are inside (bit c for corner c): the surface between them and the others
/// (Lorensen and Cline 1987). On a face with two inside corners on a diagonal they are parted, in both cubes
/// that share it, so that neighbouring cubes always fit; no triangle has a side across a cube's face that is
/// not on the surface of both.
[[nodiscard]] const std::array<CubeCase, 256>& cube_cases();

}  // namespace drape::meshing
