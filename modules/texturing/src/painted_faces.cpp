#include "painted_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"

namespace drape::texturing {
namespace {

constexpr double sample_px = 1.25;  // distance of the samples on a face
constexpr int most_samples = 64;    // along an edge
constexpr double coarse_px = 32;    // longer edges are halved; shorter ones cut where sight ends
constexpr double border_px = 0.5;   // a corner may lie this far outside the photo
constexpr int most_rounds = 40;
constexpr double grown_quality = 0.1;  // of a face painted with grown colours alone

using Corners = std::array<Eigen::Vector3d, 3>;

// A face on its way to being settled.
struct Work {
  std::uint32_t face;
  std::uint32_t source;  // the face of the given mesh that it is part of
};

struct Look {
  int samples = 0;
  int painted = 0;
  int full = 0;
  double cosine = 0;      // mean over the painted samples
  double longest_px = 0;  // infinite if a corner is behind the camera
  double area_px = 0;
  bool holds_corners = false;
};

class Looker {
 public:
  Looker(const TriangleMesh& given, std::span<const PhotoSight> sights) : normals_(given), sights_(sights) {}

  [[nodiscard]] const PhotoSight& sight(int view) const { return sights_[static_cast<std::size_t>(view)]; }
  [[nodiscard]] int views() const { return static_cast<int>(sights_.size()); }
  [[nodiscard]] std::uint8_t at(const Eigen::Vector3d& x, std::uint32_t source, int view) const {
    return sight(view).sees(x, normals_.at(source, x), normals_.of_face(source));
  }
  [[nodiscard]] Look look(const Corners& corners, std::uint32_t source, int view) const;

 private:
  SurfaceNormals normals_;
  std::span<const PhotoSight> sights_;
};

// In pixels; infinite if an end is behind the camera.
double length_between(const PhotoSight& sight, const Camera::Projected& a, const Camera::Projected& b) {
  const bool perspective = sight.camera().projection == Camera::Projection::perspective;
  if (perspective && !(a.depth > 0 && b.depth > 0)) return std::numeric_limits<double>::infinity();
  return (b.pixel - a.pixel).norm();
}

double projected_length(const PhotoSight& sight, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return length_between(sight, sight.camera().project(a), sight.camera().project(b));
}

Look Looker::look(const Corners& corners, std::uint32_t source, int view) const {
  Look found;
  const PhotoSight& s = sight(view);
  // One side of a plane is either all towards the camera or all away from it.
  if (!(normals_.of_face(source).dot(s.camera().towards_camera(corners[0])) > 0)) return found;
  std::array<Camera::Projected, 3> projected;
  for (std::size_t k = 0; k < 3; ++k) projected[k] = s.camera().project(corners[k]);
  for (std::size_t k = 0; k < 3; ++k)
    found.longest_px = std::max(found.longest_px, length_between(s, projected[k], projected[(k + 1) % 3]));
  if (std::isfinite(found.longest_px)) {
    std::array<Eigen::Vector2d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = s.lookup_of(projected[k].pixel);
    found.holds_corners =
        std::all_of(p.begin(), p.end(), [&](const auto& q) { return s.holds(q, border_px); });
    const Eigen::Vector2d u = p[1] - p[0];
    const Eigen::Vector2d v = p[2] - p[0];
    found.area_px = std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
  }
  const Eigen::Vector3d& face_normal = normals_.of_face(source);
  std::array<Eigen::Vector3d, 3> leaning;
  for (std::size_t k = 0; k < 3; ++k) leaning[k] = normals_.unscaled_at(source, corners[k]);
  // Most faces lie in plain sight.
  if (found.holds_corners && found.longest_px > sample_px) {
    std::array<Eigen::Vector3d, 3> unit;
    for (std::size_t k = 0; k < 3; ++k) unit[k] = leaning[k].stableNormalized();
    if (s.sees_plainly(corners, projected, unit, face_normal)) {
      const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
      found.samples = found.painted = found.full = 1;
      found.cosine =
          (leaning[0] + leaning[1] + leaning[2]).stableNormalized().dot(s.camera().towards_camera(middle));
      return found;
    }
  }
  const int n =
      static_cast<int>(std::clamp(std::ceil(found.longest_px / sample_px), 1.0, double{most_samples}));
  const auto sample = [&](double i, double j) {  // in steps of 1 / n along two edges
    const Eigen::Vector3d x =
        corners[0] + (i / n) * (corners[1] - corners[0]) + (j / n) * (corners[2] - corners[0]);
    const Eigen::Vector3d normal =
        (leaning[0] + (i / n) * (leaning[1] - leaning[0]) + (j / n) * (leaning[2] - leaning[0])).normalized();
    const std::uint8_t level = s.sees(x, normal, face_normal);
    ++found.samples;
    if (level == trust::none) return;
    ++found.painted;
    if (level == trust::full) ++found.full;
    found.cosine += normal.dot(s.camera().towards_camera(x));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      sample(i + 1 / 3.0, j + 1 / 3.0);
      if (i + j + 1 < n) sample(i + 2 / 3.0, j + 2 / 3.0);
    }
  if (found.painted > 0) found.cosine /= found.painted;
  return found;
}

struct Verdict {
  std::vector<Candidate> candidates;  // photos that see it whole
  std::vector<EdgeSplit> splits;      // otherwise where to cut it, if that is worth it
};

double share_of(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0;
}

// The last point from `seen` towards `hidden` that the photo still sees, as a share of the way.
double end_of_sight(const Looker& looker, const Eigen::Vector3d& seen, const Eigen::Vector3d& hidden,
                    std::uint32_t source, int view) {
  double least = 0;
  double most = 1;
  for (int i = 0; i < 12; ++i) {
    const double middle = (least + most) / 2;
    const bool sees = looker.at(seen + middle * (hidden - seen), source, view) != trust::none;
    (sees ? least : most) = middle;
  }
  return least;
}

void add_split(std::vector<EdgeSplit>& splits, std::uint32_t from, std::uint32_t to, double share) {
  if (from < to)
    splits.push_back({from, to, share});
  else
    splits.push_back({to, from, 1 - share});
}

std::vector<EdgeSplit> splits_of(const Looker& looker, const TriangleMesh& mesh, const Work& work, int view,
                                 double split_px) {
  const Face& f = mesh.faces[work.face];
  std::vector<EdgeSplit> splits;
  std::array<double, 3> length{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = f[k];
    const std::uint32_t b = f[(k + 1) % 3];
    const Eigen::Vector3d& xa = mesh.vertices[a];
    const Eigen::Vector3d& xb = mesh.vertices[b];
    length[k] = projected_length(looker.sight(view), xa, xb);
    if (length[k] <= split_px) continue;
    if (length[k] > coarse_px) {
      add_split(splits, a, b, 0.5);
      continue;
    }
    const bool sees_a = looker.at(xa, work.source, view) != trust::none;
    if (sees_a == (looker.at(xb, work.source, view) != trust::none)) continue;
    const double share = sees_a ? end_of_sight(looker, xa, xb, work.source, view)
                                : 1 - end_of_sight(looker, xb, xa, work.source, view);
    if (std::min(share, 1 - share) * length[k] > split_px / 2) add_split(splits, a, b, share);
  }
  if (!splits.empty()) return splits;
  const auto k = static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
  add_split(splits, f[k], f[(k + 1) % 3], 0.5);
  return splits;
}

Verdict verdict_on(const Looker& looker, const TriangleMesh& mesh, const Work& work, double split_px) {
  const Face& f = mesh.faces[work.face];
  const Corners corners = {mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]};
  const double area = scaled_face_normal(mesh, work.face).norm() / 2;
  Verdict verdict;
  int best_partial = -1;
  double best_share = 0;
  for (int view = 0; view < looker.views(); ++view) {
    const Look look = looker.look(corners, work.source, view);
    if (look.painted == 0) continue;
    if (look.painted == look.samples && look.holds_corners) {
      const double full = share_of(look.full, look.samples);
      const double density = area > 0 ? look.area_px / area : 0;
      verdict.candidates.push_back(
          {view, density * look.cosine * (grown_quality + (1 - grown_quality) * full), full});
    } else if (share_of(look.painted, look.samples) > best_share && look.longest_px > split_px) {
      best_share = share_of(look.painted, look.samples);
      best_partial = view;
    }
  }
  if (verdict.candidates.empty() && best_partial >= 0)
    verdict.splits = splits_of(looker, mesh, work, best_partial, split_px);
  return verdict;
}

// What has been decided so far, face by face of the mesh as it is now.
struct State {
  static constexpr std::uint32_t undecided = std::numeric_limits<std::uint32_t>::max();
  PaintedFaces surface;
  std::vector<std::uint32_t> sources;
};

std::vector<EdgeSplit> decide(const Looker& looker, State& state, double split_px, bool last_round) {
  std::vector<Work> open;
  auto& sets = state.surface.candidate_sets;
  for (std::size_t f = 0; f < sets.size(); ++f)
    if (sets[f] == State::undecided) open.push_back({static_cast<std::uint32_t>(f), state.sources[f]});
  std::vector<Verdict> verdicts(open.size());
  parallel_for(open.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      verdicts[i] = verdict_on(looker, state.surface.mesh, open[i], split_px);
  });
  std::vector<EdgeSplit> splits;
  for (std::size_t i = 0; i < open.size(); ++i) {
    Verdict& v = verdicts[i];
    if (!v.candidates.empty()) {
      sets[open[i].face] = static_cast<std::uint32_t>(state.surface.candidates.size());
      state.surface.candidates.push_back(std::move(v.candidates));
    } else if (v.splits.empty() || last_round) {
      sets[open[i].face] = 0;
    } else {
      splits.insert(splits.end(), v.splits.begin(), v.splits.end());
    }
  }
  return splits;
}

}  // namespace

void cut_edges(PaintedFaces& surface, std::vector<int>& chosen, std::span<const EdgeSplit> splits) {
  SplitMesh split = split_edges(surface.mesh, splits);
  std::vector<int> views;
  std::vector<std::uint32_t> sets;
  for (const std::uint32_t parent : split.parents) {
    views.push_back(chosen[parent]);
    sets.push_back(surface.candidate_sets[parent]);
  }
  surface.mesh = std::move(split.mesh);
  surface.candidate_sets = std::move(sets);
  chosen = std::move(views);
}

PaintedFaces split_at_sight(const TriangleMesh& mesh, std::span<const PhotoSight> sights, double split_px,
                            const Progress& progress) {
  const Looker looker(mesh, sights);
  State state;
  state.surface.mesh = mesh;
  state.surface.candidates.emplace_back();
  state.surface.candidate_sets.assign(mesh.faces.size(), State::undecided);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) state.sources.push_back(static_cast<std::uint32_t>(f));
  for (int round = 0;; ++round) {
    progress.update(1 - std::pow(0.6, round), "testing what the photos see");
    const std::vector<EdgeSplit> splits = decide(looker, state, split_px, round == most_rounds);
    if (splits.empty()) break;
    SplitMesh split = split_edges(state.surface.mesh, splits);
    std::vector<std::uint32_t> sets;
    std::vector<std::uint32_t> sources;
    for (const std::uint32_t parent : split.parents) {
      sets.push_back(state.surface.candidate_sets[parent]);
      sources.push_back(state.sources[parent]);
    }
    state.surface.mesh = std::move(split.mesh);
    state.surface.candidate_sets = std::move(sets);
    state.sources = std::move(sources);
  }
  return std::move(state.surface);
}

}  // namespace drape::texturing
