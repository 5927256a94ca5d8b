#include "least_crossing_patch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include "face_crossing.hpp"

namespace drape::meshing {
namespace {

using Box = Eigen::AlignedBox3d;

Box box_of(const TriangleMesh& mesh, const Face& f) {
  Box box;
  for (const std::uint32_t v : f) box.extend(mesh.vertices[v]);
  return box;
}

struct Cost {
  std::size_t crossings = 0;
  double area = 0;

  [[nodiscard]] Cost operator+(const Cost& other) const {
    return {crossings + other.crossings, area + other.area};
  }
  [[nodiscard]] bool operator<(const Cost& other) const {
    return crossings != other.crossings ? crossings < other.crossings : area < other.area;
  }
};
constexpr Cost impossible{std::numeric_limits<std::size_t>::max() / 4, 0};

class Around {
 public:
  Around(const TriangleMesh& mesh, const std::vector<Face>& faces) : mesh_(mesh) {
    for (const Face& f : faces) faces_.emplace_back(f, box_of(mesh, f));
  }

  [[nodiscard]] std::size_t crossings(const Face& f) const {
    const Box box = box_of(mesh_, f);
    return static_cast<std::size_t>(std::count_if(faces_.begin(), faces_.end(), [&](const auto& other) {
      return box.intersects(other.second) && faces_cross(mesh_, f, other.first);
    }));
  }
  [[nodiscard]] Cost cost(const Face& f) const {
    const Eigen::Vector3d& a = mesh_.vertices[f[0]];
    const double area = (mesh_.vertices[f[1]] - a).cross(mesh_.vertices[f[2]] - a).norm() / 2;
    // One without area closes nothing: it must not be had for free.
    return {crossings(f) + (area > 0 ? 0 : 1), area};
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<std::pair<Face, Box>> faces_;
};

// Pairs of places in the loop (lesser, greater) that are edges of faces already.
Chords chords_among(const std::vector<Face>& faces, const std::vector<std::uint32_t>& loop) {
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t i = 0; i < loop.size(); ++i) place.emplace(loop[i], i);
  Chords chords;
  for (const Face& f : faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = place.find(f[k]);
      const auto b = place.find(f[(k + 1) % 3]);
      if (a != place.end() && b != place.end()) chords.insert(std::minmax(a->second, b->second));
    }
  return chords;
}

std::size_t crossings_within(const TriangleMesh& mesh, const std::vector<Face>& faces) {
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) crossings += faces_cross(mesh, faces[i], faces[k]) ? 1 : 0;
  return crossings;
}

LeastCrossingPatch in_places(const TriangleMesh& mesh, const std::vector<std::uint32_t>& loop,
                             std::vector<Face> places, const Around& around) {
  std::vector<Face> faces = places;
  for (Face& f : faces)
    for (std::uint32_t& v : f) v = loop[v];
  LeastCrossingPatch result{{{}, std::move(places)}, crossings_within(mesh, faces)};
  for (const Face& f : faces) result.crossings += around.crossings(f);
  return result;
}

}  // namespace

std::optional<LeastCrossingPatch> least_crossing_patch(const TriangleMesh& mesh,
                                                       const std::vector<std::uint32_t>& loop,
                                                       const std::vector<Face>& faces_around) {
  if (loop.size() < 3 || loop.size() > most_edges_for_least_crossings) return std::nullopt;
  const auto size = static_cast<std::uint32_t>(loop.size());
  const Chords taken = chords_among(faces_around, loop);
  const Around around(mesh, faces_around);
  // Of the polygon from corner i to corner k and back: its least cost, and the tip of the triangle on (i, k).
  std::vector<Cost> least(std::size_t{size} * size);
  std::vector<std::uint32_t> tips(least.size(), 0);
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return std::size_t{i} * size + k; };
  for (std::uint32_t width = 2; width < size; ++width)
    for (std::uint32_t i = 0; i + width < size; ++i) {
      const std::uint32_t k = i + width;
      Cost& best = least[at(i, k)];
      best = impossible;
      if (width + 1 < size && taken.count({i, k}) != 0) continue;
      for (std::uint32_t tip = i + 1; tip < k; ++tip) {
        const Cost sides = least[at(i, tip)] + least[at(tip, k)];
        if (!(sides < best)) continue;
        const Cost cost = sides + around.cost({loop[i], loop[tip], loop[k]});
        if (!(cost < best)) continue;
        best = cost;
        tips[at(i, k)] = tip;
      }
    }
  if (!(least[at(0, size - 1)] < impossible)) return std::nullopt;
  std::vector<Face> faces;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> left{{0, size - 1}};
  while (!left.empty()) {
    const auto [i, k] = left.back();
    left.pop_back();
    if (k - i < 2) continue;
    const std::uint32_t tip = tips[at(i, k)];
    faces.push_back({i, tip, k});
    left.emplace_back(i, tip);
    left.emplace_back(tip, k);
  }
  return in_places(mesh, loop, std::move(faces), around);
}

}  // namespace drape::meshing
