#include "patch_mending.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "drape/meshing/mesh_quality.hpp"
#include "least_crossing_patch.hpp"

namespace drape::meshing {
namespace {

using Loop = std::vector<std::uint32_t>;

// The vertices of some faces and no others.
class Numbering {
 public:
  explicit Numbering(const TriangleMesh& mesh) : outer_mesh_(mesh) {}

  Face inner(Face f) {
    for (std::uint32_t& v : f) {
      const auto [entry, is_new] = inner_.emplace(v, static_cast<std::uint32_t>(outer_.size()));
      if (is_new) {
        outer_.push_back(v);
        vertices_.push_back(outer_mesh_.vertices[v]);
      }
      v = entry->second;
    }
    return f;
  }
  [[nodiscard]] Face outer(Face f) const {
    for (std::uint32_t& v : f) v = outer_[v];
    return f;
  }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }

 private:
  const TriangleMesh& outer_mesh_;
  std::unordered_map<std::uint32_t, std::uint32_t> inner_;
  std::vector<std::uint32_t> outer_;
  std::vector<Eigen::Vector3d> vertices_;
};

// A patch's faces behind those round it.
struct Place {
  TriangleMesh mesh;
  std::size_t around = 0;  // faces that are not the patch's

  [[nodiscard]] std::size_t patch_size() const { return mesh.faces.size() - around; }
  [[nodiscard]] const Face& patch_face(std::size_t i) const { return mesh.faces[around + i]; }
};

std::vector<FacePair> crossings_of(const Place& place) {
  std::vector<std::uint8_t> tested(place.mesh.faces.size(), 0);
  std::fill(tested.begin() + static_cast<std::ptrdiff_t>(place.around), tested.end(), 1);
  return self_intersecting_pairs(place.mesh, tested);
}

// Of the patch's faces: those of the pairs, and `rings` of others round them.
std::vector<std::uint8_t> marked_faces(const Place& place, const std::vector<FacePair>& pairs, int rings) {
  std::vector<std::uint8_t> marked(place.patch_size(), 0);
  for (const auto& [a, b] : pairs)
    for (const std::uint32_t f : {a, b})
      if (f >= place.around) marked[f - place.around] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> touched(place.mesh.vertices.size(), 0);
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (marked[i] != 0)
        for (const std::uint32_t v : place.patch_face(i)) touched[v] = 1;
    for (std::size_t i = 0; i < marked.size(); ++i)
      for (const std::uint32_t v : place.patch_face(i)) marked[i] |= touched[v];
  }
  return marked;
}

// The patch's faces by the edges that they lie on the left of.
class EdgeFaces {
 public:
  explicit EdgeFaces(const Place& place) {
    for (std::size_t i = 0; i < place.patch_size(); ++i) {
      const Face& f = place.patch_face(i);
      for (std::size_t k = 0; k < 3; ++k) faces_[{f[k], f[(k + 1) % 3]}] = i;
    }
  }
  // The face beyond the k-th edge of this one; none at the patch's border.
  [[nodiscard]] std::optional<std::size_t> beyond(const Face& f, std::size_t k) const {
    const auto found = faces_.find({f[(k + 1) % 3], f[k]});
    return found == faces_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> faces_;
};

// Pieces of faces that hang together by edges and are all marked or all not.
struct Piece {
  std::vector<std::size_t> faces;
  bool marked = false;
  bool at_border = false;  // one of its edges is the patch's border
};

std::vector<Piece> pieces_of(const Place& place, const EdgeFaces& edges,
                             const std::vector<std::uint8_t>& marked) {
  std::vector<Piece> pieces;
  std::vector<std::uint8_t> reached(marked.size(), 0);
  for (std::size_t seed = 0; seed < marked.size(); ++seed) {
    if (reached[seed] != 0) continue;
    reached[seed] = 1;
    Piece piece{{seed}, marked[seed] != 0, false};
    for (std::size_t i = 0; i < piece.faces.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto next = edges.beyond(place.patch_face(piece.faces[i]), k);
        piece.at_border |= !next;
        if (!next || reached[*next] != 0 || marked[*next] != marked[seed]) continue;
        reached[*next] = 1;
        piece.faces.push_back(*next);
      }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

// The marked pieces, each with what it encloses: they are discs then.
std::vector<Piece> regions_of(const Place& place, std::vector<std::uint8_t> marked) {
  const EdgeFaces edges(place);
  for (const Piece& piece : pieces_of(place, edges, marked))
    if (!piece.marked && !piece.at_border)
      for (const std::size_t f : piece.faces) marked[f] = 1;
  std::vector<Piece> regions = pieces_of(place, edges, marked);
  regions.erase(std::remove_if(regions.begin(), regions.end(), [](const Piece& p) { return !p.marked; }),
                regions.end());
  return regions;
}

// The borders of a region, the region on their left, each vertex once: where two touch they are parted.
std::vector<Loop> borders_of(const Place& place, const Piece& region) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const std::size_t i : region.faces) {
    const Face& f = place.patch_face(i);
    for (std::size_t k = 0; k < 3; ++k) edges[{f[k], f[(k + 1) % 3]}] = 1;
  }
  std::multimap<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, one] : edges)
    if (edges.count({edge.second, edge.first}) == 0) next.emplace(edge.first, edge.second);
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop walk{next.begin()->first};
    for (auto step = next.begin(); step != next.end(); step = next.find(walk.back())) {
      const std::uint32_t to = step->second;
      next.erase(step);
      const auto before = std::find(walk.begin(), walk.end(), to);
      if (before == walk.end()) {
        walk.push_back(to);
        continue;
      }
      loops.emplace_back(before, walk.end());
      walk.erase(before + 1, walk.end());
    }
  }
  return loops;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, const Face& f) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : f) box.extend(mesh.vertices[v]);
  return box;
}

// Triangulates a region anew, beside the faces that are not `gone`; nothing where a border is too long for
// that. No triangle between a region's vertices leaves their box.
std::optional<MendedPatch> triangulated_anew(const Place& place, const Piece& region,
                                             std::vector<std::uint8_t> gone) {
  Eigen::AlignedBox3d box;
  for (const std::size_t i : region.faces) {
    gone[i] = 1;
    box.extend(box_of(place.mesh, place.patch_face(i)));
  }
  std::vector<Face> beside;
  for (std::size_t i = 0; i < place.mesh.faces.size(); ++i) {
    const bool is_gone = i >= place.around && i - place.around < gone.size() && gone[i - place.around] != 0;
    if (!is_gone && box.intersects(box_of(place.mesh, place.mesh.faces[i])))
      beside.push_back(place.mesh.faces[i]);
  }
  MendedPatch anew;
  for (const Loop& loop : borders_of(place, region)) {
    const auto found = least_crossing_patch(place.mesh, loop, beside);
    if (!found) return std::nullopt;
    anew.crossings += found->crossings;
    for (const Face& f : found->patch.faces) {
      anew.faces.push_back({loop[f[0]], loop[f[1]], loop[f[2]]});
      beside.push_back(anew.faces.back());
    }
  }
  return anew;
}

std::size_t crossings_of(const Place& place, const Piece& region, const std::vector<FacePair>& pairs) {
  std::vector<std::uint8_t> inside(place.mesh.faces.size(), 0);
  for (const std::size_t i : region.faces) inside[place.around + i] = 1;
  return static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const FacePair& pair) {
    return inside[pair.first] != 0 || inside[pair.second] != 0;
  }));
}

// Regions round the crossings are exchanged for what crosses less; false where none can be.
bool mend(Place& place, const std::vector<FacePair>& pairs, int rings) {
  std::vector<Face>& faces = place.mesh.faces;
  std::vector<std::uint8_t> gone(place.patch_size(), 0);
  bool any = false;
  for (const Piece& region : regions_of(place, marked_faces(place, pairs, rings))) {
    const std::optional<MendedPatch> anew = triangulated_anew(place, region, gone);
    if (!anew || anew->crossings >= crossings_of(place, region, pairs)) continue;
    any = true;
    for (const std::size_t i : region.faces) gone[i] = 1;
    faces.insert(faces.end(), anew->faces.begin(), anew->faces.end());
  }
  std::vector<Face> kept(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(place.around));
  for (std::size_t i = 0; i < place.patch_size(); ++i)
    if (i >= gone.size() || gone[i] == 0) kept.push_back(place.patch_face(i));
  faces = std::move(kept);
  return any;
}

}  // namespace

MendedPatch mended_patch(const TriangleMesh& mesh, const std::vector<Face>& patch,
                         const std::vector<Face>& around) {
  constexpr int most_rings = 3;
  // A patch that more of the surface goes through is wrong as a whole.
  constexpr std::size_t most_pairs = 500;
  Numbering numbers(mesh);
  Place place;
  for (const Face& f : around) place.mesh.faces.push_back(numbers.inner(f));
  place.around = around.size();
  for (const Face& f : patch) place.mesh.faces.push_back(numbers.inner(f));
  place.mesh.vertices = numbers.vertices();
  std::vector<FacePair> pairs = crossings_of(place);
  for (int rings = 0; rings <= most_rings; ++rings)
    for (bool better = true; better && !pairs.empty() && pairs.size() <= most_pairs;) {
      const Place before = place;
      better = mend(place, pairs, rings);
      std::vector<FacePair> left = crossings_of(place);
      // Two regions that crossed each other may both count what they are rid of.
      if (left.size() >= pairs.size()) {
        place = before;
        break;
      }
      pairs = std::move(left);
    }
  MendedPatch mended{{}, pairs.size()};
  for (std::size_t i = 0; i < place.patch_size(); ++i)
    mended.faces.push_back(numbers.outer(place.patch_face(i)));
  return mended;
}

}  // namespace drape::meshing
