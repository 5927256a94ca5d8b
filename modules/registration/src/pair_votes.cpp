#include "pair_votes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace drape::registration {
namespace {

constexpr std::size_t pair_points = 500;       // of either scan
constexpr std::size_t reference_points = 125;  // of the source
constexpr std::size_t peaks_per_reference = 3;
constexpr float least_distance_voxels = 4;  // closer pairs determine no turn
constexpr float distance_bin_voxels = 2.5F;
constexpr float distance_tolerance_voxels = 1;
constexpr int angle_bins = 15;  // of 12 degrees
constexpr float angle_tolerance_bins = 0.35F;
constexpr int turn_bins = 30;  // of 12 degrees
constexpr float pi = std::numbers::pi_v<float>;

struct Oriented {
  Eigen::Vector3f point;
  Eigen::Matrix3f axes;  // the normal, and two axes across it
};

std::vector<Oriented> evenly_chosen(const CoarseScan& scan, std::size_t count) {
  std::vector<Oriented> chosen;
  if (scan.size() == 0) return chosen;
  const Eigen::Vector3d origin = scan.points()[0];  // so that floats hold coordinates of any size
  const std::size_t taken = std::min(count, scan.size());
  for (std::size_t k = 0; k < taken; ++k) {
    const std::size_t i = k * scan.size() / taken;
    Oriented& o = chosen.emplace_back();
    o.point = (scan.points()[i] - origin).cast<float>();
    const Eigen::Vector3f normal = scan.normals()[i].cast<float>();
    const Eigen::Vector3f across = normal.unitOrthogonal();
    o.axes << normal, across, normal.cross(across);
  }
  return chosen;
}

// The feature of Drost et al. 2010, eq. 1, in bins, and the turn of the second point about the first one's
// normal.
struct PairFeature {
  float distance;
  std::array<float, 3> angles;
  float turn;  // radians
};

float angle_in_bins(float cosine) {
  return std::acos(std::clamp(cosine, -1.0F, 1.0F)) * (static_cast<float>(angle_bins) / pi);
}

std::optional<PairFeature> feature_of(const Oriented& first, const Oriented& second, float voxel) {
  const Eigen::Vector3f step = second.point - first.point;
  const float distance = step.norm();
  if (!(distance >= least_distance_voxels * voxel)) return std::nullopt;
  const Eigen::Vector3f local = first.axes.transpose() * step;
  return PairFeature{
      distance / (distance_bin_voxels * voxel),
      {angle_in_bins(local.x() / distance), angle_in_bins(second.axes.col(0).dot(step) / distance),
       angle_in_bins(first.axes.col(0).dot(second.axes.col(0)))},
      std::atan2(local.z(), local.y())};
}

// All pairs of the target by their features.
class PairTable {
 public:
  PairTable(const std::vector<Oriented>& points, float voxel) {
    struct Entry {
      std::size_t bin;
      Start start;
    };
    std::vector<Entry> entries;
    entries.reserve(points.size() * points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t j = 0; j < points.size(); ++j) {
        if (i == j) continue;
        const auto feature = feature_of(points[i], points[j], voxel);
        if (!feature) continue;
        const auto distance = static_cast<int>(feature->distance);
        distance_bins_ = std::max(distance_bins_, distance + 1);
        std::array<int, 3> angles{};
        for (std::size_t k = 0; k < 3; ++k)
          angles[k] = std::min(static_cast<int>(feature->angles[k]), angle_bins - 1);
        entries.push_back({bin_of(distance, angles), {static_cast<std::uint32_t>(i), feature->turn}});
      }
    begin_.assign(static_cast<std::size_t>(distance_bins_ * angle_bins * angle_bins * angle_bins) + 1, 0);
    for (const Entry& entry : entries) ++begin_[entry.bin + 1];
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    starts_.resize(entries.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const Entry& entry : entries) starts_[next[entry.bin]++] = entry.start;
  }

  struct Start {
    std::uint32_t point;
    float turn;
  };

  /// Calls visit(first, last) with the target's pairs in each bin that the feature may belong to.
  template <class Visit>
  void for_each_like(const PairFeature& feature, const Visit& visit) const {
    constexpr float tolerance = distance_tolerance_voxels / distance_bin_voxels;
    const Range distances = range_of(feature.distance, tolerance, distance_bins_);
    std::array<Range, 3> angles{};
    for (std::size_t k = 0; k < 3; ++k)
      angles[k] = range_of(feature.angles[k], angle_tolerance_bins, angle_bins);
    for (int d = distances.first; d <= distances.last; ++d)
      for (int a = angles[0].first; a <= angles[0].last; ++a)
        for (int b = angles[1].first; b <= angles[1].last; ++b)
          for (int c = angles[2].first; c <= angles[2].last; ++c) {
            const std::size_t bin = bin_of(d, {a, b, c});
            visit(starts_.data() + begin_[bin], starts_.data() + begin_[bin + 1]);
          }
  }

 private:
  struct Range {
    int first;
    int last;
  };
  static Range range_of(float value, float tolerance, int bins) {
    return {std::clamp(static_cast<int>(value - tolerance), 0, bins),
            std::min(static_cast<int>(value + tolerance), bins - 1)};
  }
  static std::size_t bin_of(int distance, const std::array<int, 3>& angles) {
    return static_cast<std::size_t>(
        ((distance * angle_bins + angles[0]) * angle_bins + angles[1]) * angle_bins + angles[2]);
  }

  int distance_bins_ = 0;
  std::vector<std::uint32_t> begin_;
  std::vector<Start> starts_;
};

struct Peak {
  std::size_t reference;  // of the source
  std::size_t point;      // of the target
  float turn;             // radians
  float votes;
};

// Where the votes for one reference point pile up: its best places on the target.
std::vector<Peak> peaks_of(std::size_t reference, const std::vector<Oriented>& source, const PairTable& table,
                           float voxel, std::vector<float>& votes) {
  std::fill(votes.begin(), votes.end(), 0.0F);
  for (std::size_t j = 0; j < source.size(); ++j) {
    if (j == reference) continue;
    const auto feature = feature_of(source[reference], source[j], voxel);
    if (!feature) continue;
    table.for_each_like(*feature, [&](const PairTable::Start* first, const PairTable::Start* last) {
      if (first == last) return;
      const float weight = 1 / std::sqrt(static_cast<float>(last - first));
      for (const PairTable::Start* start = first; start != last; ++start) {
        const float turn = (start->turn - feature->turn) * (turn_bins / (2 * pi)) + 2 * turn_bins;
        votes[start->point * turn_bins + static_cast<std::size_t>(turn) % turn_bins] += weight;
      }
    });
  }
  std::vector<Peak> peaks;
  for (std::size_t point = 0; point < votes.size() / turn_bins; ++point) {
    const float* bins = votes.data() + point * turn_bins;
    Peak best{reference, point, 0, 0};
    for (int t = 0; t < turn_bins; ++t) {  // a turn and its noise spread over two bins
      const int after = (t + 1) % turn_bins;
      const float sum = bins[t] + bins[after];
      if (sum > best.votes) {
        best.votes = sum;
        best.turn = (static_cast<float>(t) + 0.5F + bins[after] / sum) * (2 * pi / turn_bins);
      }
    }
    if (best.votes > 0) peaks.push_back(best);
  }
  const auto kept = peaks.begin() + static_cast<std::ptrdiff_t>(std::min(peaks_per_reference, peaks.size()));
  std::partial_sort(peaks.begin(), kept, peaks.end(), [](const Peak& a, const Peak& b) {
    return a.votes != b.votes ? a.votes > b.votes : a.point < b.point;
  });
  peaks.erase(kept, peaks.end());
  return peaks;
}

Rigid3 motion_of(const Peak& peak, const std::vector<Oriented>& source, const std::vector<Oriented>& target,
                 const Eigen::Vector3d& source_origin, const Eigen::Vector3d& target_origin) {
  const Eigen::Matrix3d from = source[peak.reference].axes.cast<double>();
  const Eigen::Matrix3d to = target[peak.point].axes.cast<double>();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(static_cast<double>(peak.turn), Eigen::Vector3d::UnitX()).toRotationMatrix();
  Rigid3 motion = Rigid3::Identity();
  motion.linear() = Eigen::Quaterniond(to * turn * from.transpose()).normalized().toRotationMatrix();
  motion.translation() = target_origin + target[peak.point].point.cast<double>() -
                         motion.linear() * (source_origin + source[peak.reference].point.cast<double>());
  return motion;
}

}  // namespace

std::vector<MotionGuess> voted_motions(const CoarseScan& source, const CoarseScan& target, std::size_t most) {
  const std::vector<Oriented> from = evenly_chosen(source, pair_points);
  const std::vector<Oriented> to = evenly_chosen(target, pair_points);
  if (from.empty() || to.empty()) return {};
  const auto voxel = static_cast<float>(source.voxel());
  const PairTable table(to, voxel);
  std::vector<float> votes(to.size() * turn_bins);
  struct Voted {
    Rigid3 motion;
    double votes;
    double support = 0;
  };
  std::vector<Voted> voted;
  const std::size_t stride = std::max<std::size_t>(1, from.size() / reference_points);
  for (std::size_t reference = 0; reference < from.size(); reference += stride)
    for (const Peak& peak : peaks_of(reference, from, table, voxel, votes))
      voted.push_back({motion_of(peak, from, to, source.points()[0], target.points()[0]),
                       static_cast<double>(peak.votes)});

  // Reference points that say the same add up.
  BoundingBox box;
  for (const auto& p : source.points()) box.extend(p);
  const auto alike = [&](const Rigid3& a, const Rigid3& b) {
    return (a * box.center() - b * box.center()).norm() < 4 * source.voxel() &&
           (a.linear().transpose() * b.linear()).trace() > 1 + 2 * std::cos(0.35);
  };
  for (Voted& one : voted)
    for (const Voted& other : voted)
      if (alike(one.motion, other.motion)) one.support += other.votes;
  std::stable_sort(voted.begin(), voted.end(),
                   [](const Voted& a, const Voted& b) { return a.support > b.support; });
  std::vector<MotionGuess> guesses;
  for (const Voted& one : voted) {
    if (guesses.size() == most) break;
    if (std::none_of(guesses.begin(), guesses.end(), [&](const MotionGuess& kept) {
          return (kept.target_from_source * box.center() - one.motion * box.center()).norm() <
                     2 * source.voxel() &&
                 (kept.target_from_source.linear().transpose() * one.motion.linear()).trace() >
                     1 + 2 * std::cos(0.15);
        }))
      guesses.push_back({one.motion, static_cast<std::size_t>(one.support)});
  }
  return guesses;
}

}  // namespace drape::registration
