// A sheet of square cells, two faces each.
#pragma once

#include <cstdint>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

/// (columns + 1) x (rows + 1) vertices, at place(x, y), row by row; of each cell first the face at its upper
/// left corner.
template <class Place>
TriangleMesh lattice_sheet(int columns, int rows, const Place& place) {
  TriangleMesh sheet;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) sheet.vertices.push_back(place(x, y));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (columns + 1) + x);
      const auto c = static_cast<std::uint32_t>(static_cast<int>(a) + columns + 1);
      sheet.faces.push_back({a, a + 1, c});
      sheet.faces.push_back({a + 1, c + 1, c});
    }
  return sheet;
}

}  // namespace drape::test
