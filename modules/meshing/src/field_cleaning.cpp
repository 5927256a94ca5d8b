#include "field_cleaning.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "drape/base/random.hpp"

namespace drape::meshing {
namespace {

// A face at a vertex, with its next two corners.
struct Wedge {
  std::uint32_t vertex, from, to, face;
};

// The wedges at vertices whose faces make no closed fan: there the steps from one outer vertex to the next do
// not add up to nothing.
std::vector<Wedge> border_wedges(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> around(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      around[f[k]] += item_seed(0, f[(k + 2) % 3]) - item_seed(0, f[(k + 1) % 3]);
  std::vector<Wedge> wedges;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    const Face& f = mesh.faces[i];
    for (std::size_t k = 0; k < 3; ++k)
      if (around[f[k]] != 0) wedges.push_back({f[k], f[(k + 1) % 3], f[(k + 2) % 3], i});
  }
  std::sort(wedges.begin(), wedges.end(), [](const Wedge& a, const Wedge& b) {
    return std::array{a.vertex, a.face} < std::array{b.vertex, b.face};
  });
  return wedges;
}

// The faces of all but the longest of the fans at one vertex. A fan begins with a wedge that follows no
// other.
void add_lesser_fans(std::span<const Wedge> wedges, std::vector<std::uint32_t>& faces) {
  const auto next = [&](const Wedge& wedge) {
    return std::find_if(wedges.begin(), wedges.end(), [&](const Wedge& w) { return w.from == wedge.to; });
  };
  std::vector<std::vector<std::uint32_t>> fans;
  for (const Wedge& first : wedges) {
    if (std::any_of(wedges.begin(), wedges.end(), [&](const Wedge& w) { return w.to == first.from; }))
      continue;
    fans.push_back({first.face});
    for (auto w = next(first); w != wedges.end(); w = next(*w)) fans.back().push_back(w->face);
  }
  if (fans.size() < 2) return;
  const auto longest = std::max_element(fans.begin(), fans.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (auto fan = fans.begin(); fan != fans.end(); ++fan)
    if (fan != longest) faces.insert(faces.end(), fan->begin(), fan->end());
}

// The faces at one vertex, if two of them look away from each other.
void add_folded_fan(const TriangleMesh& mesh, std::span<const Wedge> wedges,
                    std::vector<std::uint32_t>& faces) {
  constexpr double least_cosine = -0.5;
  for (const Wedge& a : wedges)
    for (const Wedge& b : wedges) {
      if (b.face >= a.face) break;
      const Eigen::Vector3d na = scaled_face_normal(mesh, a.face);
      const Eigen::Vector3d nb = scaled_face_normal(mesh, b.face);
      if (na.dot(nb) >= least_cosine * na.norm() * nb.norm()) continue;
      for (const Wedge& w : wedges) faces.push_back(w.face);
      return;
    }
}

void drop_faces(TriangleMesh& mesh, const std::vector<std::uint32_t>& dropped) {
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  for (const std::uint32_t face : dropped) keep[face] = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) mesh.faces[kept++] = mesh.faces[i];
  mesh.faces.resize(kept);
}

// Drops the faces that `add` names of those at each vertex of the border. Returns at how many it named some.
template <class Add>
std::size_t drop_at_border(TriangleMesh& mesh, Add add) {
  const std::vector<Wedge> wedges = border_wedges(mesh);
  std::vector<std::uint32_t> dropped;
  std::size_t vertices = 0;
  for (auto begin = wedges.begin(); begin != wedges.end();) {
    const auto end =
        std::find_if(begin, wedges.end(), [&](const Wedge& w) { return w.vertex != begin->vertex; });
    const std::size_t before = dropped.size();
    add(std::span<const Wedge>(begin, end), dropped);
    vertices += dropped.size() > before ? 1 : 0;
    begin = end;
  }
  if (vertices > 0) drop_faces(mesh, dropped);
  return vertices;
}

}  // namespace

Cleaned without_touching_border_fans(TriangleMesh mesh) {
  Cleaned cleaned{std::move(mesh), 0};
  while (const std::size_t vertices = drop_at_border(cleaned.mesh, add_lesser_fans))
    cleaned.removed += vertices;
  return cleaned;
}

Cleaned without_folded_border(TriangleMesh mesh) {
  Cleaned cleaned{std::move(mesh), 0};
  cleaned.removed = drop_at_border(cleaned.mesh, [&](auto wedges, std::vector<std::uint32_t>& faces) {
    add_folded_fan(cleaned.mesh, wedges, faces);
  });
  return cleaned;
}

Cleaned without_small_pieces(TriangleMesh mesh, double percent) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Face& f : mesh.faces)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = root(f[0]);
      const std::uint32_t b = root(f[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::uint32_t> sizes(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces) ++sizes[root(f[0])];
  const double least = percent / 100 * static_cast<double>(mesh.faces.size());
  const std::uint32_t largest = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
  Cleaned cleaned;
  const auto goes = [&](std::uint32_t size) { return size != largest && static_cast<double>(size) < least; };
  for (const std::uint32_t size : sizes) cleaned.removed += size > 0 && goes(size) ? 1 : 0;
  mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(),
                                  [&](const Face& f) { return goes(sizes[root(f[0])]); }),
                   mesh.faces.end());
  cleaned.mesh = std::move(mesh);
  return cleaned;
}

}  // namespace drape::meshing
