// The faces round each vertex.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

class VertexFaces {
 public:
  explicit VertexFaces(const TriangleMesh& mesh)
      : first_(mesh.vertices.size() + 1, 0), faces_(3 * mesh.faces.size()) {
    for (const Face& f : mesh.faces)
      for (const std::uint32_t v : f) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
      for (const std::uint32_t v : mesh.faces[i]) faces_[next[v]++] = i;
  }

  /// In increasing order.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return {faces_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> faces_;
};

}  // namespace drape::meshing
