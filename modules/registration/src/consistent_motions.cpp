#include "consistent_motions.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

namespace drape::registration {
namespace {

// In voxels: two points of one place lie up to about a voxel apart when each scan has its own voxels.
constexpr double distance_tolerance = 1.5;
constexpr double agree_distance = 2;
constexpr double least_distance = 4;  // points closer than that determine no rotation
constexpr float cosine_tolerance = 0.25F;
constexpr double agree_cosine = 0.7;
constexpr std::size_t seeds = 150;
constexpr std::size_t linked = 20;

struct Matched {
  Eigen::Vector3f source, target, source_normal, target_normal;
};

std::vector<Matched> matched_points(const CoarseScan& source, const CoarseScan& target,
                                    std::span<const FeatureMatch> matches) {
  std::vector<Matched> result;
  if (matches.empty()) return result;
  const Eigen::Vector3d source_origin = source.points()[matches[0].source];
  const Eigen::Vector3d target_origin = target.points()[matches[0].target];
  for (const FeatureMatch& m : matches)
    result.push_back({(source.points()[m.source] - source_origin).cast<float>(),
                      (target.points()[m.target] - target_origin).cast<float>(),
                      source.normals()[m.source].cast<float>(), target.normals()[m.target].cast<float>()});
  return result;
}

// Which matches are compatible, a row of bits each.
class Compatibility {
 public:
  Compatibility(const std::vector<Matched>& matches, double voxel)
      : words_((matches.size() + 63) / 64), bits_(matches.size() * words_) {
    const auto tolerance = static_cast<float>(distance_tolerance * voxel);
    const auto least = static_cast<float>(least_distance * voxel);
    for (std::size_t i = 0; i < matches.size(); ++i)
      for (std::size_t j = i + 1; j < matches.size(); ++j)
        if (compatible(matches[i], matches[j], tolerance, least)) {
          set(i, j);
          set(j, i);
        }
  }

  [[nodiscard]] bool operator()(std::size_t i, std::size_t j) const {
    return (bits_[i * words_ + j / 64] >> (j % 64) & 1) != 0;
  }
  [[nodiscard]] std::size_t common(std::size_t i, std::size_t j) const {
    std::size_t count = 0;
    for (std::size_t w = 0; w < words_; ++w)
      count += static_cast<std::size_t>(std::popcount(bits_[i * words_ + w] & bits_[j * words_ + w]));
    return count;
  }
  template <class Visit>
  void for_each(std::size_t i, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w)
      for (std::uint64_t rest = bits_[i * words_ + w]; rest != 0; rest &= rest - 1)
        visit(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
  }

 private:
  static bool compatible(const Matched& a, const Matched& b, float tolerance, float least) {
    const Eigen::Vector3f in_source = b.source - a.source;
    const Eigen::Vector3f in_target = b.target - a.target;
    const float s = in_source.norm();
    const float t = in_target.norm();
    if (!(std::abs(s - t) < tolerance) || s < least || t < least) return false;
    const auto same = [](float x, float y) { return std::abs(x - y) < cosine_tolerance; };
    return same(a.source_normal.dot(b.source_normal), a.target_normal.dot(b.target_normal)) &&
           same(a.source_normal.dot(in_source) / s, a.target_normal.dot(in_target) / t) &&
           same(b.source_normal.dot(in_source) / s, b.target_normal.dot(in_target) / t);
  }
  void set(std::size_t i, std::size_t j) { bits_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64); }

  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

// Sums for the motion of least squares; a normal counts like a point `arm` away from the middle.
class MotionFit {
 public:
  MotionFit(const CoarseScan& source, const CoarseScan& target)
      : source_(source), target_(target), arm_(4 * source.voxel()) {}

  void add(const FeatureMatch& m) {
    const Eigen::Vector3d& s = source_.points()[m.source];
    const Eigen::Vector3d& t = target_.points()[m.target];
    source_sum_ += s;
    target_sum_ += t;
    products_ += t * s.transpose();
    normals_ += target_.normals()[m.target] * source_.normals()[m.source].transpose();
    ++count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] Rigid3 motion() const {
    const auto n = static_cast<double>(count_);
    const Eigen::Matrix3d covariance =
        products_ - target_sum_ * source_sum_.transpose() / n + arm_ * arm_ * normals_;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
    Rigid3 motion = Rigid3::Identity();
    motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    motion.translation() = (target_sum_ - motion.linear() * source_sum_) / n;
    return motion;
  }

 private:
  const CoarseScan& source_;
  const CoarseScan& target_;
  double arm_;
  Eigen::Vector3d source_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d normals_ = Eigen::Matrix3d::Zero();
  std::size_t count_ = 0;
};

MotionFit fit_to_agreeing(const CoarseScan& source, const CoarseScan& target,
                          std::span<const FeatureMatch> matches, const Rigid3& motion) {
  MotionFit fit(source, target);
  const double limit = std::pow(agree_distance * source.voxel(), 2);
  for (const FeatureMatch& m : matches)
    if ((motion * source.points()[m.source] - target.points()[m.target]).squaredNorm() < limit &&
        (motion.linear() * source.normals()[m.source]).dot(target.normals()[m.target]) > agree_cosine)
      fit.add(m);
  return fit;
}

// Fits the motion to what agrees with it, twice.
MotionGuess settled(const CoarseScan& source, const CoarseScan& target, std::span<const FeatureMatch> matches,
                    Rigid3 motion) {
  MotionGuess guess;
  for (int round = 0; round < 2; ++round) {
    const MotionFit fit = fit_to_agreeing(source, target, matches, motion);
    guess.target_from_source = motion;
    guess.agreeing = fit.count();
    if (fit.count() < 3) break;
    motion = fit.motion();
  }
  return guess;
}

std::vector<MotionGuess> best_distinct(std::vector<MotionGuess> guesses, const CoarseScan& source,
                                       std::size_t most) {
  std::stable_sort(guesses.begin(), guesses.end(),
                   [](const MotionGuess& a, const MotionGuess& b) { return a.agreeing > b.agreeing; });
  BoundingBox box;
  for (const auto& p : source.points()) box.extend(p);
  const auto alike = [&](const Rigid3& a, const Rigid3& b) {
    return (a * box.center() - b * box.center()).norm() < 3 * source.voxel() &&
           (a.linear().transpose() * b.linear()).trace() > 1 + 2 * std::cos(0.15);
  };
  std::vector<MotionGuess> kept;
  for (const MotionGuess& guess : guesses) {
    if (kept.size() == most || guess.agreeing < 3) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const MotionGuess& k) {
          return alike(k.target_from_source, guess.target_from_source);
        }))
      kept.push_back(guess);
  }
  return kept;
}

}  // namespace

std::vector<MotionGuess> consistent_motions(const CoarseScan& source, const CoarseScan& target,
                                            std::span<const FeatureMatch> matches, std::size_t most) {
  const Compatibility compatible(matched_points(source, target, matches), source.voxel());
  struct Link {
    std::size_t match;
    std::size_t strength;
  };
  std::vector<std::vector<Link>> links(matches.size());
  std::vector<std::size_t> strengths(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i)
    compatible.for_each(i, [&](std::size_t j) {
      if (j < i) return;
      const std::size_t strength = compatible.common(i, j);
      if (strength == 0) return;
      links[i].push_back({j, strength});
      links[j].push_back({i, strength});
      strengths[i] += strength;
      strengths[j] += strength;
    });
  std::vector<std::size_t> order(matches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return strengths[a] > strengths[b]; });
  if (order.size() > seeds) order.resize(seeds);

  std::vector<MotionGuess> guesses;
  for (const std::size_t seed : order) {
    std::vector<Link>& strongest = links[seed];
    std::stable_sort(strongest.begin(), strongest.end(),
                     [](const Link& a, const Link& b) { return a.strength > b.strength; });
    if (strongest.size() < 2) continue;
    MotionFit fit(source, target);
    fit.add(matches[seed]);
    for (std::size_t k = 0; k < std::min(linked, strongest.size()); ++k) fit.add(matches[strongest[k].match]);
    guesses.push_back(settled(source, target, matches, fit.motion()));
  }
  return best_distinct(std::move(guesses), source, most);
}

std::vector<MotionGuess> motions_with_rotation(const CoarseScan& source, const CoarseScan& target,
                                               std::span<const FeatureMatch> matches,
                                               const Eigen::Matrix3d& rotation, std::size_t most) {
  std::vector<MotionGuess> guesses;
  for (const FeatureMatch& m : matches) {
    if ((rotation * source.normals()[m.source]).dot(target.normals()[m.target]) < agree_cosine) continue;
    Rigid3 motion = Rigid3::Identity();
    motion.linear() = rotation;
    motion.translation() = target.points()[m.target] - rotation * source.points()[m.source];
    guesses.push_back(settled(source, target, matches, motion));
  }
  return best_distinct(std::move(guesses), source, most);
}

}  // namespace drape::registration
