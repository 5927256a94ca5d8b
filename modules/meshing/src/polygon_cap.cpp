// Patches that need no library, for the holes for which CGAL finds none; and the check of every patch.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "hole_patch.hpp"

namespace drape::meshing {
namespace {

std::pair<std::uint32_t, std::uint32_t> chord(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The corners that are not clipped yet.
class Ring {
 public:
  explicit Ring(std::size_t size) : next_(size), previous_(size), left_(size) {
    for (std::uint32_t i = 0; i < size; ++i) {
      next_[i] = static_cast<std::uint32_t>((i + 1) % size);
      previous_[next_[i]] = i;
    }
  }
  [[nodiscard]] std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  [[nodiscard]] std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }
  [[nodiscard]] std::size_t left() const { return left_; }
  void clip(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    --left_;
  }

 private:
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  std::size_t left_;
};

// The inner angle at an ear; infinite where the corner is none: reflex, or with another corner inside.
double ear_angle(const std::vector<Eigen::Vector2d>& flat, const Ring& ring, std::uint32_t tip) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const std::uint32_t a = ring.previous(tip);
  const std::uint32_t b = ring.next(tip);
  const Eigen::Vector2d to_a = flat[a] - flat[tip];
  const Eigen::Vector2d to_b = flat[b] - flat[tip];
  if (cross(to_b, to_a) <= 0) return none;
  for (std::uint32_t i = ring.next(b); i != a; i = ring.next(i)) {
    const bool inside = cross(flat[tip] - flat[a], flat[i] - flat[a]) >= 0 &&
                        cross(flat[b] - flat[tip], flat[i] - flat[tip]) >= 0 &&
                        cross(flat[a] - flat[b], flat[i] - flat[b]) >= 0;
    if (inside) return none;
  }
  return std::atan2(cross(to_b, to_a), to_a.dot(to_b));
}

}  // namespace

std::vector<Eigen::Vector2d> flattened(const std::vector<Eigen::Vector3d>& loop) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i)
    normal += (loop[i] - loop[0]).cross(loop[(i + 1) % loop.size()] - loop[0]);
  if (normal.stableNorm() == 0) normal = Eigen::Vector3d::UnitZ();
  normal.stableNormalize();
  const Eigen::Vector3d x = normal.unitOrthogonal();
  const Eigen::Vector3d y = normal.cross(x);
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& p : loop) flat.emplace_back(x.dot(p - loop[0]), y.dot(p - loop[0]));
  return flat;
}

Chords taken_chords(const HoleRegion& region) {
  Chords taken;
  const auto loop = static_cast<std::uint32_t>(region.loop);
  for (const Face& f : region.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k];
      const std::uint32_t b = f[(k + 1) % 3];
      if (a < loop && b < loop && (a + 1) % loop != b && (b + 1) % loop != a) taken.insert(chord(a, b));
    }
  return taken;
}

std::optional<Patch> clipped_patch(const std::vector<Eigen::Vector3d>& loop, const Chords& taken) {
  const std::vector<Eigen::Vector2d> flat = flattened(loop);
  Ring ring(loop.size());
  std::vector<double> angle(loop.size());
  for (std::uint32_t i = 0; i < loop.size(); ++i) angle[i] = ear_angle(flat, ring, i);
  Patch patch;
  while (ring.left() > 3) {
    std::uint32_t best = 0;
    double best_angle = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < loop.size(); ++i)
      if (angle[i] < best_angle && taken.count(chord(ring.previous(i), ring.next(i))) == 0) {
        best = i;
        best_angle = angle[i];
      }
    if (std::isinf(best_angle)) return std::nullopt;
    const std::uint32_t a = ring.previous(best);
    const std::uint32_t b = ring.next(best);
    patch.faces.push_back({a, best, b});
    ring.clip(best);
    angle[best] = std::numeric_limits<double>::infinity();
    angle[a] = ear_angle(flat, ring, a);
    angle[b] = ear_angle(flat, ring, b);
  }
  const std::uint32_t last = patch.faces.empty() ? 0 : patch.faces.back()[0];
  patch.faces.push_back({ring.previous(last), last, ring.next(last)});
  return patch;
}

Patch fan_patch(const std::vector<Eigen::Vector3d>& loop) {
  Patch patch;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : loop) offset += p - loop[0];
  patch.vertices.push_back(loop[0] + offset / static_cast<double>(loop.size()));
  const auto size = static_cast<std::uint32_t>(loop.size());
  for (std::uint32_t i = 0; i < size; ++i) patch.faces.push_back({i, (i + 1) % size, size});
  return patch;
}

bool closes_hole(const Patch& patch, std::size_t loop, const Chords& taken) {
  const std::size_t vertices = loop + patch.vertices.size();
  std::map<std::array<std::uint32_t, 2>, int> half_edges;
  for (const Face& f : patch.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k];
      const std::uint32_t b = f[(k + 1) % 3];
      if (a >= vertices || a == b || ++half_edges[{a, b}] > 1) return false;
    }
  std::size_t boundary = 0;
  for (const auto& [edge, count] : half_edges) {
    const bool on_loop = edge[0] < loop && edge[1] == (edge[0] + 1) % loop;
    const bool two_sided = half_edges.count({edge[1], edge[0]}) == 1;
    if (on_loop == two_sided) return false;
    if (on_loop) ++boundary;
    if (taken.count(chord(edge[0], edge[1])) != 0) return false;
  }
  return boundary == loop && std::all_of(patch.vertices.begin(), patch.vertices.end(),
                                         [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

}  // namespace drape::meshing
