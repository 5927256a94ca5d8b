#include "outline_mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "drape/base/disjoint_sets.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::alignment {
namespace {

struct PlaceHash {
  std::size_t operator()(const std::array<double, 3>& x) const {
    std::uint64_t h = 0;
    for (const double v : x) h = (h ^ std::bit_cast<std::uint64_t>(v + 0.0)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

// Number of the first vertex at the same place, for each.
std::vector<std::uint32_t> first_at_place(const std::vector<Eigen::Vector3d>& vertices) {
  std::unordered_map<std::array<double, 3>, std::uint32_t, PlaceHash> seen;
  seen.reserve(vertices.size());
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v)
    first[v] = seen.try_emplace({vertices[v].x(), vertices[v].y(), vertices[v].z()}, v).first->second;
  return first;
}

struct HalfEdge {
  std::uint32_t greater;
  std::uint32_t face;
  bool rising;  // the face runs from the lesser to the greater vertex
};

// Half-edges in buckets by their lesser vertex: linear time, where sorting all of them would take longer than
// the search itself.
void add_edges(OutlineMesh& mesh) {
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 1, 0);
  const auto each_half_edge = [&](auto visit) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = mesh.faces[f][static_cast<std::size_t>(i)];
        const std::uint32_t b = mesh.faces[f][static_cast<std::size_t>((i + 1) % 3)];
        visit(std::min(a, b), HalfEdge{std::max(a, b), f, a < b});
      }
  };
  each_half_edge([&](std::uint32_t lesser, const HalfEdge&) { ++begin[lesser + 1]; });
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<HalfEdge> halves(3 * mesh.faces.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  each_half_edge([&](std::uint32_t lesser, const HalfEdge& half) { halves[next[lesser]++] = half; });

  mesh.edges.reserve(halves.size() / 2 + 16);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto first = halves.begin() + begin[v];
    const auto last = halves.begin() + begin[v + 1];
    std::sort(first, last, [](const HalfEdge& a, const HalfEdge& b) {
      return a.greater != b.greater ? a.greater < b.greater : a.face < b.face;
    });
    for (auto i = first; i != last;) {
      auto end = i;
      while (end != last && end->greater == i->greater) ++end;
      const bool pair = end - i == 2;
      for (auto half = i; half != end; half = pair ? end : half + 1) {
        OutlineEdge edge{half->rising ? v : half->greater, half->rising ? half->greater : v, half->face};
        edge.border = end - i == 1;
        if (pair) {
          edge.other = (half + 1)->face;
          edge.turned = half->rising == (half + 1)->rising;
        }
        mesh.edges.push_back(edge);
      }
      mesh.open |= end - i == 1;
      i = end;
    }
  }
}

// Borders that meet in a vertex get one cap.
void add_caps(OutlineMesh& mesh) {
  if (!mesh.open) return;
  DisjointSets borders(mesh.vertices.size());
  for (const OutlineEdge& edge : mesh.edges)
    if (edge.border) borders.join(edge.from, edge.to);
  std::unordered_map<std::uint32_t, std::uint32_t> numbers;  // of the borders, by their first vertices
  std::vector<double> lengths;
  for (const OutlineEdge& edge : mesh.edges) {
    if (!edge.border) continue;
    const auto number = static_cast<std::uint32_t>(lengths.size());
    const auto [border, is_new] = numbers.try_emplace(borders.find(edge.from), number);
    if (is_new) {
      lengths.push_back(0);
      mesh.border_middles.emplace_back(Eigen::Vector3d::Zero());
    }
    const Eigen::Vector3d& a = mesh.vertices[edge.from];
    const Eigen::Vector3d& b = mesh.vertices[edge.to];
    const double length = (b - a).norm();
    lengths[border->second] += length;
    mesh.border_middles[border->second] += length / 2 * (a + b);
    mesh.caps.push_back(
        {edge.to, edge.from, static_cast<std::uint32_t>(mesh.vertices.size()) + border->second});
  }
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] > 0) mesh.border_middles[i] /= lengths[i];
}

}  // namespace

UnitSphere unit_sphere(const TriangleMesh& mesh) {
  UnitSphere sphere;
  sphere.center = bounding_box(mesh.vertices).center();
  double squared = 0;
  for (const Eigen::Vector3d& x : mesh.vertices)
    squared = std::max(squared, (x - sphere.center).squaredNorm());
  sphere.radius = std::sqrt(squared);
  if (!(sphere.radius > 0)) throw input_error("the mesh cannot be aligned: all of it is one point");
  return sphere;
}

OutlineMesh outline_mesh(const TriangleMesh& mesh, const UnitSphere& sphere) {
  OutlineMesh result;
  result.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& x : mesh.vertices)
    result.vertices.push_back((x - sphere.center) / sphere.radius);
  const std::vector<std::uint32_t> first = first_at_place(mesh.vertices);
  result.faces.reserve(mesh.faces.size());
  for (const Face& f : mesh.faces) {
    const Face joined{first[f[0]], first[f[1]], first[f[2]]};
    if (joined[0] != joined[1] && joined[1] != joined[2] && joined[2] != joined[0])
      result.faces.push_back(joined);
  }
  add_edges(result);
  add_caps(result);
  result.closed = std::all_of(result.edges.begin(), result.edges.end(), [](const OutlineEdge& edge) {
    return edge.other != OutlineEdge::no_face && !edge.turned;
  });
  return result;
}

}  // namespace drape::alignment
