#include "hole_region.hpp"

#include <algorithm>
#include <unordered_map>

namespace drape::meshing {
namespace {

bool has(const Face& f, std::uint32_t v) {
  return f[0] == v || f[1] == v || f[2] == v;
}

bool share_spoke(const Face& f, const Face& g, std::uint32_t hub) {
  return std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return v != hub && has(g, v); });
}

// The one face on edge (a, b), if there is exactly one.
std::optional<std::uint32_t> only_face_on(const TriangleMesh& mesh, const VertexFaces& around,
                                          std::uint32_t a, std::uint32_t b) {
  std::optional<std::uint32_t> found;
  for (const std::uint32_t face : around.of(a)) {
    if (!has(mesh.faces[face], b)) continue;
    if (found) return std::nullopt;
    found = face;
  }
  return found;
}

// The faces round `hub` that hang together with `seeds` there.
void add_fans(const TriangleMesh& mesh, const VertexFaces& around, std::uint32_t hub,
              std::vector<std::uint32_t> seeds, std::vector<std::uint32_t>& faces) {
  const auto round_hub = around.of(hub);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (const std::uint32_t face : round_hub)
      if (std::find(seeds.begin(), seeds.end(), face) == seeds.end() &&
          share_spoke(mesh.faces[seeds[i]], mesh.faces[face], hub))
        seeds.push_back(face);
  faces.insert(faces.end(), seeds.begin(), seeds.end());
}

void sort_unique(std::vector<std::uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// The faces round the other vertices of `faces`, but for those that touch the loop: what touches it and is
// not among `faces` hangs on it by a point only.
std::vector<std::uint32_t> with_next_ring(const TriangleMesh& mesh, const VertexFaces& around,
                                          const std::vector<std::uint32_t>& faces,
                                          const std::unordered_map<std::uint32_t, std::uint32_t>& on_loop) {
  std::vector<std::uint32_t> ring = faces;
  for (const std::uint32_t face : faces)
    for (const std::uint32_t v : mesh.faces[face]) {
      if (on_loop.count(v) != 0) continue;
      for (const std::uint32_t next : around.of(v)) {
        const Face& f = mesh.faces[next];
        if (std::none_of(f.begin(), f.end(), [&](std::uint32_t w) { return on_loop.count(w) != 0; }))
          ring.push_back(next);
      }
    }
  sort_unique(ring);
  return ring;
}

}  // namespace

std::optional<HoleRegion> hole_region(const TriangleMesh& mesh, const VertexFaces& around,
                                      const std::vector<std::uint32_t>& loop) {
  std::vector<std::uint32_t> owners;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto face = only_face_on(mesh, around, loop[i], loop[(i + 1) % loop.size()]);
    if (!face) return std::nullopt;
    owners.push_back(*face);
  }
  std::vector<std::uint32_t> faces;
  for (std::size_t i = 0; i < loop.size(); ++i)
    add_fans(mesh, around, loop[i], {owners[(i + loop.size() - 1) % loop.size()], owners[i]}, faces);
  sort_unique(faces);

  HoleRegion region;
  region.loop = loop.size();
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (const std::uint32_t v : loop) {
    place.emplace(v, static_cast<std::uint32_t>(region.points.size()));
    region.points.push_back(mesh.vertices[v]);
  }
  for (const std::uint32_t face : with_next_ring(mesh, around, faces, place)) {
    Face local{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.faces[face][k];
      const auto [entry, is_new] = place.emplace(v, static_cast<std::uint32_t>(region.points.size()));
      if (is_new) region.points.push_back(mesh.vertices[v]);
      local[k] = entry->second;
    }
    region.faces.push_back(local);
  }
  return region;
}

}  // namespace drape::meshing
