#include "vertex_fans.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>

#include "vertex_faces.hpp"

namespace drape::meshing {
namespace {

// Groups the faces round `v` by the edges they share there: per face, the place of its fan's first face.
// `fans` and `spokes` are buffers of the caller's.
std::size_t find_fans(const TriangleMesh& mesh, std::span<const std::uint32_t> faces, std::uint32_t v,
                      std::vector<std::uint32_t>& fans, std::vector<std::array<std::uint32_t, 2>>& spokes) {
  const auto count = static_cast<std::uint32_t>(faces.size());
  fans.resize(count);
  std::iota(fans.begin(), fans.end(), 0U);
  spokes.clear();
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t w : mesh.faces[faces[i]])
      if (w != v) spokes.push_back({w, i});
  std::sort(spokes.begin(), spokes.end());
  const auto root = [&](std::uint32_t i) {
    while (fans[i] != i) i = fans[i] = fans[fans[i]];
    return i;
  };
  std::size_t number = count;
  for (std::size_t i = 1; i < spokes.size(); ++i) {
    if (spokes[i][0] != spokes[i - 1][0]) continue;
    const std::uint32_t a = root(spokes[i][1]);
    const std::uint32_t b = root(spokes[i - 1][1]);
    if (a == b) continue;
    fans[std::max(a, b)] = std::min(a, b);
    --number;
  }
  for (std::uint32_t i = 0; i < count; ++i) fans[i] = root(i);
  return number;
}

// Calls visit(v, faces, fans) for each vertex with more than one fan.
template <class Visit>
void for_each_touching_vertex(const TriangleMesh& mesh, Visit visit) {
  const VertexFaces around(mesh);
  std::vector<std::uint32_t> fans;
  std::vector<std::array<std::uint32_t, 2>> spokes;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (find_fans(mesh, around.of(v), v, fans, spokes) > 1) visit(v, around.of(v), fans);
}

template <class Attribute>
void append_copy(std::vector<Attribute>& values, std::uint32_t index) {
  if (!values.empty()) values.push_back(Attribute(values[index]));
}

std::uint32_t append_vertex_copy(TriangleMesh& mesh, std::uint32_t v) {
  append_copy(mesh.vertices, v);
  append_copy(mesh.normals, v);
  append_copy(mesh.colors, v);
  append_copy(mesh.intensities, v);
  append_copy(mesh.confidences, v);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

}  // namespace

std::size_t non_manifold_vertex_count(const TriangleMesh& mesh) {
  std::size_t count = 0;
  for_each_touching_vertex(mesh, [&](auto, auto, const auto&) { ++count; });
  return count;
}

Cleaned without_touching_fans(const TriangleMesh& mesh) {
  Cleaned cleaned{mesh, 0};
  while (true) {
    std::vector<std::uint8_t> keep(cleaned.mesh.faces.size(), 1);
    std::size_t touching = 0;
    for_each_touching_vertex(cleaned.mesh, [&](std::uint32_t, std::span<const std::uint32_t> faces,
                                               const std::vector<std::uint32_t>& fans) {
      ++touching;
      std::vector<std::uint32_t> sizes(fans.size(), 0);
      for (const std::uint32_t fan : fans) ++sizes[fan];
      const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
      for (std::size_t i = 0; i < fans.size(); ++i)
        if (fans[i] != static_cast<std::uint32_t>(largest)) keep[faces[i]] = 0;
    });
    if (touching == 0) return cleaned;
    cleaned = {with_faces(cleaned.mesh, keep), cleaned.removed + touching};
  }
}

Cleaned with_parted_fans(const TriangleMesh& mesh) {
  Cleaned cleaned{mesh, 0};
  for_each_touching_vertex(mesh, [&](std::uint32_t v, std::span<const std::uint32_t> faces,
                                     const std::vector<std::uint32_t>& fans) {
    ++cleaned.removed;
    std::vector<std::uint32_t> own(fans.size(), v);
    for (std::size_t i = 0; i < fans.size(); ++i) {
      if (fans[i] == 0) continue;  // the first fan keeps the vertex
      if (fans[i] == i) own[i] = append_vertex_copy(cleaned.mesh, v);
      for (std::uint32_t& w : cleaned.mesh.faces[faces[i]])
        if (w == v) w = own[fans[i]];
    }
  });
  return cleaned;
}

}  // namespace drape::meshing
