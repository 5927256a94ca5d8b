#include "coarse_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "chamfer_search.hpp"
#include "distinct_poses.hpp"
#include "drape/base/parallel.hpp"

namespace drape::alignment {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr int atlas_views = 400;
constexpr int outline_views = 1000;
// One of so many views tells whether a frame is worth all of them, and of a few whether it is worth that.
constexpr std::size_t glanced_views = 10;
constexpr std::size_t few_views = 50;
constexpr std::size_t frames_after_few = 4;  // times as many as are compared with all views
constexpr double usual_perspective = 0.2;
constexpr double distinct_rad = 10 * radians;
constexpr double distinct_match_rad = 6 * radians;  // of candidates of the coarse search
constexpr std::size_t chamfer_matches_kept = 2500;
// About a place, in its radii and in those of each size. What was found there is often a part of the object,
// whose colours stand out more than the whole's do. An outline that lies a sixth of its size beside the
// object, or is a sixth too large, tells nothing of the right view.
constexpr std::array<double, 6> sizes_about = {0.85, 1, 1.18, 1.39, 1.64, 1.93};
constexpr std::array<double, 5> offsets_about = {0, -0.2, 0.2, -0.4, 0.4};
constexpr std::size_t frames_about = 4;  // of a size, which are compared with all views

Eigen::Matrix3d roll_matrix(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Whether less than an angle of that cosine lies between them: the trace of a turn is 1 + 2 cos of it.
bool turned_less(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, double cosine) {
  return a.cwiseProduct(b).sum() > 1 + 2 * cosine;
}

// The rolls that score better than those beside them. A disc scores alike at all of them: then one stands for
// all.
std::vector<int> best_rolls(const std::array<float, polar_angles>& scores) {
  std::vector<int> rolls;
  for (int r = 0; r < polar_angles; ++r) {
    const float here = scores[static_cast<std::size_t>(r)];
    const float before = scores[static_cast<std::size_t>((r + polar_angles - 1) % polar_angles)];
    const float after = scores[static_cast<std::size_t>((r + 1) % polar_angles)];
    if (here > before && here >= after) rolls.push_back(r);
  }
  if (rolls.empty()) rolls.push_back(0);
  return rolls;
}

std::vector<PolarFrame> frames_round(const PolarFrame& frame) {
  std::vector<PolarFrame> frames;
  for (const double dy : offsets_about)
    for (const double dx : offsets_about)
      frames.push_back({frame.center + frame.radius * Eigen::Vector2d(dx, dy), frame.radius});
  return frames;
}

}  // namespace

CoarseSearch::CoarseSearch(const OutlineMesh& mesh, const Evidence& evidence, const LensPrior& lens,
                           std::function<bool(const OutlinePose&)> allowed)
    : mesh_(mesh), evidence_(evidence), lens_(lens), allowed_(std::move(allowed)) {
  perspective_ = expected_perspective(evidence.frames(0).front());
  views_ = view_atlas(mesh_, atlas_views, perspective_);
}

std::vector<OutlinePose> CoarseSearch::starts(int effort, std::size_t most) const {
  if (effort > 0 && evidence_.outline() != nullptr) return by_outline(most);
  return by_frames(promising(evidence_.frames(effort)), most, evidence_.plan().most_in_a_place);
}

std::vector<OutlinePose> CoarseSearch::starts_about(const std::vector<OutlinePose>& places,
                                                    std::size_t most) const {
  std::vector<OutlinePose> all;
  OutlineDrawing drawing;
  for (const OutlinePose& place : places) {
    drawing.draw(mesh_, place, evidence_.window(0), false);
    const PolarFrame frame = polar_frame(drawing.stencil());
    if (!(frame.radius > 0)) continue;
    for (const double size : sizes_about) {
      const PolarFrame sized{frame.center, size * frame.radius};
      const std::vector<PolarFrame> frames = best_frames(frames_round(sized), glanced_views, frames_about);
      const std::vector<OutlinePose> starts = by_frames(frames, most, most);
      all.insert(all.end(), starts.begin(), starts.end());
    }
  }
  return all;
}

std::size_t CoarseSearch::listed(int effort) const {
  return evidence_.frames(effort).size() * views_.size() * polar_angles;
}

double CoarseSearch::expected_perspective(const PolarFrame& frame) const {
  if (lens_.orthographic) return 0;
  const std::optional<double> focal = lens_.fixed_focal_px ? lens_.fixed_focal_px : lens_.hinted_focal_px;
  if (!focal) return usual_perspective;
  // A body's radius of gyration in a picture is about half its bounding sphere's.
  return std::clamp(2 * frame.radius / evidence_.window(0).px_per_photo_px / *focal, 0.0, 0.6);
}

// The view was drawn in the middle of the picture: the same look elsewhere is that of a body turned along
// with the ray that it lies on. `scale`, `shift` and the body's `center` are in photo pixels.
OutlinePose CoarseSearch::pose_of(const AtlasView& view, double angle, double scale,
                                  const Eigen::Vector2d& shift, const Eigen::Vector2d& center) const {
  OutlinePose pose;
  pose.scale = scale;
  pose.shift = shift;
  pose.rotation = roll_matrix(angle) * view.rotation;
  if (lens_.orthographic) return pose;
  pose.perspective =
      lens_.fixed_focal_px ? pose.scale / *lens_.fixed_focal_px : perspective_prior(lens_, pose.scale).mean;
  pose.perspective = std::min(pose.perspective, 0.7);
  const double focal = pose.scale / std::max(pose.perspective, 1e-6);
  const Eigen::Vector3d ray(center.x(), center.y(), focal);
  pose.rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ray).toRotationMatrix() * pose.rotation;
  return pose;
}

OutlinePose CoarseSearch::pose_of(const Candidate& candidate, const PolarFrame& frame) const {
  const AtlasView& view = views_[candidate.view];
  const Window& window = evidence_.window(0);
  const double angle = 2 * std::numbers::pi * candidate.roll / polar_angles;
  const double scale = frame.radius / view.frame.radius / window.px_per_photo_px;
  const Eigen::Vector2d center = window.to_photo(frame.center);
  return pose_of(view, angle, scale, center - scale * (Eigen::Rotation2Dd(angle) * view.frame.center),
                 center);
}

// Where some of the views fit best, in the order given.
std::vector<PolarFrame> CoarseSearch::promising(std::vector<PolarFrame> frames) const {
  const std::size_t most = evidence_.plan().most_frames;
  if (frames.size() > 2 * frames_after_few * most)
    frames = best_frames(frames, few_views, frames_after_few * most);
  return best_frames(frames, glanced_views, most);
}

// Those where one view of each `stride` fits best, in the order given.
std::vector<PolarFrame> CoarseSearch::best_frames(const std::vector<PolarFrame>& frames, std::size_t stride,
                                                  std::size_t most) const {
  if (frames.size() <= most) return frames;
  std::vector<float> best(frames.size(), 0);
  parallel_for(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::unique_ptr<Evidence::RollScores> rolls = evidence_.rolls(frames[f]);
      for (std::size_t v = f % stride; v < views_.size(); v += stride) {
        std::array<float, polar_angles> scores{};
        rolls->score(views_[v].bits, scores);
        best[f] = std::max(best[f], *std::max_element(scores.begin(), scores.end()));
      }
    }
  });
  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return best[a] > best[b]; });
  order.resize(most);
  std::sort(order.begin(), order.end());
  std::vector<PolarFrame> kept;
  for (const std::size_t f : order) kept.push_back(frames[f]);
  return kept;
}

std::vector<OutlinePose> CoarseSearch::by_frames(const std::vector<PolarFrame>& frames, std::size_t most,
                                                 std::size_t most_in_a_place) const {
  std::vector<std::vector<Candidate>> found(frames.size() * views_.size());
  parallel_for(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::unique_ptr<Evidence::RollScores> rolls = evidence_.rolls(frames[f]);
      for (std::size_t v = 0; v < views_.size(); ++v) {
        std::array<float, polar_angles> scores{};
        rolls->score(views_[v].bits, scores);
        for (const int r : best_rolls(scores))
          found[f * views_.size() + v].push_back({scores[static_cast<std::size_t>(r)], f, v, r});
      }
    }
  });
  std::vector<Candidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return distinct(
      all.size(), [&](std::size_t i) { return pose_of(all[i], frames[all[i].frame]); }, distinct_rad, most,
      most_in_a_place);
}

std::vector<OutlinePose> CoarseSearch::by_outline(std::size_t most) const {
  const Window& window = evidence_.window(0);
  const std::vector<AtlasView> views = view_atlas(mesh_, outline_views, perspective_);
  const std::vector<ChamferMatch> matches =
      chamfer_matches(mesh_, views, *evidence_.outline(), chamfer_matches_kept);
  const auto pose_at = [&](std::size_t i) {
    const ChamferMatch& match = matches[i];
    const Eigen::Vector2d shift = window.to_photo(match.shift);
    return pose_of(views[match.view], match.angle, match.scale / window.px_per_photo_px, shift, shift);
  };
  return distinct(matches.size(), pose_at, distinct_match_rad, most, evidence_.plan().most_in_a_place);
}

std::vector<OutlinePose> CoarseSearch::distinct(std::size_t count,
                                                const std::function<OutlinePose(std::size_t)>& pose_at,
                                                double apart_rad, std::size_t most,
                                                std::size_t most_in_a_place) const {
  const SearchPlan plan = evidence_.plan();
  const double cos_apart = std::cos(apart_rad);
  std::vector<OutlinePose> starts;
  for (std::size_t i = 0; i < count && starts.size() < most; ++i) {
    const OutlinePose pose = pose_at(i);
    if (allowed_ && !allowed_(pose)) continue;
    const double nearest = plan.distinct_place * pose.scale;
    const bool seen = std::any_of(starts.begin(), starts.end(), [&](const OutlinePose& better) {
      return (better.shift - pose.shift).squaredNorm() < nearest * nearest &&
             std::abs(std::log(better.scale / pose.scale)) < plan.distinct_size &&
             turned_less(better.rotation, pose.rotation, cos_apart);
    });
    if (seen) continue;
    const auto crowd = static_cast<std::size_t>(std::count_if(
        starts.begin(), starts.end(), [&](const OutlinePose& better) { return in_one_place(better, pose); }));
    if (crowd < most_in_a_place) starts.push_back(pose);
  }
  return starts;
}

}  // namespace drape::alignment
