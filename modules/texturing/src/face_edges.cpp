#include "face_edges.hpp"

#include <algorithm>
#include <array>

namespace drape::texturing {

std::vector<FaceEdge> face_edges(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> sides;  // low, high, face
  sides.reserve(3 * mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[f][k];
      const std::uint32_t b = mesh.faces[f][(k + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), f});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<FaceEdge> edges;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const auto& [low, high, face] = sides[i];
    const auto& [next_low, next_high, next_face] = sides[i + 1];
    if (low == next_low && high == next_high && face != next_face)
      edges.push_back({face, next_face, low, high});
  }
  return edges;
}

}  // namespace drape::texturing
