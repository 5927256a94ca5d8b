#include "edge_splits.hpp"

#include <array>
#include <optional>
#include <unordered_map>

#include "linear_light.hpp"

namespace drape::texturing {
namespace {

using VertexOfEdge = std::unordered_map<std::uint64_t, std::uint32_t>;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b);
}

template <class T>
void interpolate(std::vector<T>& values, const EdgeSplit& s) {
  if (values.empty()) return;
  const T low = values[s.low];
  const T high = values[s.high];
  values.push_back(low + (high - low) * static_cast<float>(s.share));
}

void add_vertex(TriangleMesh& mesh, const EdgeSplit& s) {
  const Eigen::Vector3d low = mesh.vertices[s.low];
  const Eigen::Vector3d high = mesh.vertices[s.high];
  mesh.vertices.emplace_back(low + s.share * (high - low));
  interpolate(mesh.intensities, s);
  interpolate(mesh.confidences, s);
  if (!mesh.normals.empty()) {
    interpolate(mesh.normals, s);
    mesh.normals.back() = mesh.normals.back().stableNormalized();
  }
  if (!mesh.colors.empty()) {
    const Eigen::Vector3f a = linear_from_stored(mesh.colors[s.low]);
    const Eigen::Vector3f b = linear_from_stored(mesh.colors[s.high]);
    mesh.colors.push_back(stored_from_linear(a + static_cast<float>(s.share) * (b - a)));
  }
}

// The faces that tile one face whose edges k (corner k to k + 1) are cut at middle[k], where there is one.
std::vector<Face> tiles(const TriangleMesh& mesh, const Face& f,
                        const std::array<std::optional<std::uint32_t>, 3>& middle) {
  const auto cuts = static_cast<int>(middle[0].has_value()) + middle[1].has_value() + middle[2].has_value();
  if (cuts == 0) return {f};
  if (cuts == 3)
    return {{f[0], *middle[0], *middle[2]},
            {*middle[0], f[1], *middle[1]},
            {*middle[2], *middle[1], f[2]},
            {*middle[0], *middle[1], *middle[2]}};
  // Turned so that edge 0 is cut and, of two cuts, edge 2 is not.
  std::size_t turn = 0;
  while (!(middle[turn] && !middle[(turn + 2) % 3])) ++turn;
  const std::uint32_t a = f[turn];
  const std::uint32_t b = f[(turn + 1) % 3];
  const std::uint32_t c = f[(turn + 2) % 3];
  const std::uint32_t m = *middle[turn];
  if (cuts == 1) return {{a, m, c}, {m, b, c}};
  const std::uint32_t n = *middle[(turn + 1) % 3];
  // The quadrilateral a m n c along its shorter diagonal.
  const double to_n = (mesh.vertices[a] - mesh.vertices[n]).squaredNorm();
  const double to_m = (mesh.vertices[c] - mesh.vertices[m]).squaredNorm();
  if (to_n < to_m) return {{m, b, n}, {a, m, n}, {a, n, c}};
  return {{m, b, n}, {a, m, c}, {m, n, c}};
}

}  // namespace

SplitMesh split_edges(const TriangleMesh& mesh, std::span<const EdgeSplit> splits) {
  SplitMesh out{mesh, {}};
  out.mesh.faces.clear();
  out.mesh.filled.clear();
  VertexOfEdge middle_of;
  for (const EdgeSplit& s : splits) {
    const auto next = static_cast<std::uint32_t>(out.mesh.vertices.size());
    if (middle_of.emplace(edge_key(s.low, s.high), next).second) add_vertex(out.mesh, s);
  }
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Face& f = mesh.faces[i];
    std::array<std::optional<std::uint32_t>, 3> middle;
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto at = middle_of.find(edge_key(f[k], f[(k + 1) % 3])); at != middle_of.end())
        middle[k] = at->second;
    for (const Face& tile : tiles(out.mesh, f, middle)) {
      out.mesh.faces.push_back(tile);
      out.parents.push_back(static_cast<std::uint32_t>(i));
      if (!mesh.filled.empty()) out.mesh.filled.push_back(mesh.filled[i]);
    }
  }
  return out;
}

}  // namespace drape::texturing
