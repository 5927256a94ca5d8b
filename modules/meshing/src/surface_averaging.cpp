#include "surface_averaging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace drape::meshing {
namespace {

constexpr int bends_stride = 4;  // of the widest rounds, on a lattice: their reach goes by the bends

// In the lattice's own proportions, where a spacing is one across and deep.
std::vector<Eigen::Vector3f> unit_normals(const std::vector<RangeSample>& samples) {
  std::vector<Eigen::Vector3f> normals(samples.size());
  parallel_for(samples.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      normals[i] = Eigen::Vector3f(samples[i].slope_x, samples[i].slope_y, -1).normalized();
  });
  return normals;
}

// Averages round off the normals beside a crease: a sample there takes the mean normal of the neighbours of
// that one of its own neighbours whose surroundings differ much less than its own, to `ratio` of that at most
// (Kuwahara et al. 1976, on normals). Elsewhere no sample changes.
std::vector<RangeSample> with_sharp_creases(std::vector<RangeSample> samples,
                                            const SampleNeighbors& neighbors, float ratio) {
  constexpr std::size_t least_seen = 6;
  const std::vector<Eigen::Vector3f> normals = unit_normals(samples);
  std::vector<Eigen::Vector3f> sums(samples.size(), Eigen::Vector3f::Zero());
  std::vector<float> spreads(samples.size(), std::numeric_limits<float>::infinity());
  neighbors.for_all([&](std::size_t i, std::span<const std::uint32_t> around) {
    if (!seen(samples[i])) return;
    sums[i] = normals[i];
    std::size_t count = 1;
    for (const std::uint32_t j : around) {
      if (!seen(samples[j])) continue;
      sums[i] += normals[j];
      ++count;
    }
    if (count >= least_seen) spreads[i] = 1 - sums[i].norm() / static_cast<float>(count);
  });
  neighbors.for_all([&](std::size_t i, std::span<const std::uint32_t> around) {
    if (!seen(samples[i])) return;
    std::size_t best = i;
    for (const std::uint32_t j : around)
      if (spreads[j] < spreads[best]) best = j;
    if (!(spreads[best] < ratio * spreads[i]) || !(sums[best].z() < 0)) return;
    samples[i].slope_x = -sums[best].x() / sums[best].z();
    samples[i].slope_y = -sums[best].y() / sums[best].z();
  });
  return samples;
}

// Deviation of the difference between the normals of neighbours. Those of adjacent ones have most of their
// noise in common once they were averaged: it is that at the stride which counts.
float normal_noise_of(const std::vector<RangeSample>& samples, const std::vector<Eigen::Vector3f>& normals,
                      const SampleNeighbors& neighbors, int stride) {
  std::vector<float> differences;
  neighbors.for_some(
      [&](std::size_t i, std::span<const std::uint32_t> around) {
        if (!seen(samples[i])) return;
        for (const std::uint32_t j : around)
          if (seen(samples[j])) differences.push_back((normals[i] - normals[j]).norm());
      },
      stride);
  return deviation_of(std::move(differences));
}

// How much the surface turns about each sample, from 0 where it is as good as flat to 1.
std::vector<float> bends_of(const std::vector<RangeSample>& samples, const SampleNeighbors& neighbors) {
  // 1 - the length of the mean normal; nearly flat shapes have less than the one, under heavy noise, and
  // small round ones more than the other.
  constexpr float flat = 0.001F;
  constexpr float bent = 0.02F;
  const std::vector<Eigen::Vector3f> normals = unit_normals(samples);
  std::vector<float> bends(samples.size(), 1.0F);
  neighbors.for_all(
      [&](std::size_t i, std::span<const std::uint32_t> around) {
        if (!seen(samples[i])) return;
        Eigen::Vector3f sum = normals[i];
        float count = 1;
        for (const std::uint32_t j : around) {
          if (!seen(samples[j])) continue;
          sum += normals[j];
          ++count;
        }
        const float spread = std::max(flat, 1 - sum.norm() / count);
        bends[i] = std::min(1.0F, std::log(spread / flat) / std::log(bent / flat));
      },
      bends_stride);
  return bends;
}

// How far a neighbour lies off a sample along the ray, in spacings, by their tangent planes, and what it
// counts.
struct Tie {
  float off = 0;
  float weight = 0;
};

// What counts as one surface. `bends` are those of the samples, or none.
class Likeness {
 public:
  Likeness(const std::vector<RangeSample>& samples, const SampleNeighbors& neighbors, const Sight& sight,
           float noise, int stride, float share_of_its_plane, const std::vector<float>& bends)
      : samples_(samples),
        share_of_its_plane_(share_of_its_plane),
        bends_(bends),
        sight_(sight),
        normals_(unit_normals(samples)),
        per_pixel_(static_cast<float>(1 / sight.pixels_per_spacing)) {
    // In deviations.
    constexpr float most_difference = 4;
    constexpr float most_distance = 3;
    // Curved surfaces without noise are still one surface.
    constexpr float least_normal_limit = 0.15F;
    const float normal_noise = normal_noise_of(samples, normals_, neighbors, stride);
    per_normal_limit_ = 1 / std::max(least_normal_limit, most_difference * normal_noise);
    per_distance_limit_ = 1 / (most_distance * noise);
  }

  [[nodiscard]] float spacing(std::size_t i) const {
    return static_cast<float>(sight_.spacing_at(static_cast<double>(samples_[i].depth)));
  }
  [[nodiscard]] Tie tie(std::size_t center, std::size_t i, float spacing, int stride) const {
    const RangeSample& c = samples_[center];
    const RangeSample& n = samples_[i];
    if (!seen(n)) return {};
    const float dx = (n.column - c.column) * per_pixel_;
    const float dy = (n.row - c.row) * per_pixel_;
    const float dz = (n.depth - c.depth) / spacing;
    const float off_mine = dz - c.slope_x * dx - c.slope_y * dy;
    const float off_its = dz - n.slope_x * dx - n.slope_y * dy;
    const float from_mine = off_mine * normals_[center].z();
    const float from_its = off_its * normals_[i].z();
    const float apart = std::max(std::abs(from_mine), std::abs(from_its)) * per_distance_limit_;
    // A steep surface's samples are far apart: the reach is that of the stride in space.
    const float reach = reach_strides(center, stride) * static_cast<float>(stride);
    const float like =
        1 - (normals_[i] - normals_[center]).squaredNorm() * per_normal_limit_ * per_normal_limit_;
    const float near = 1 - apart * apart;
    const float close = 1 - (dx * dx + dy * dy + dz * dz) / (reach * reach);
    if (!(like > 0 && near > 0 && close > 0)) return {};
    const float product = like * near * close;
    return {off_mine + share_of_its_plane_ * (off_its - off_mine), product * product};
  }

 private:
  [[nodiscard]] float reach_strides(std::size_t center, int stride) const {
    constexpr float usual = 3;
    constexpr float on_flat = 4;
    constexpr float on_bent = 1.6F;
    if (stride < bends_stride || bends_.empty()) return usual;
    return on_flat + bends_[center] * (on_bent - on_flat);
  }

  const std::vector<RangeSample>& samples_;
  float share_of_its_plane_;
  const std::vector<float>& bends_;
  const Sight& sight_;
  std::vector<Eigen::Vector3f> normals_;
  float per_pixel_;
  float per_normal_limit_ = 0;
  float per_distance_limit_ = 0;
};

RangeSample averaged(const std::vector<RangeSample>& samples, const Likeness& likeness, std::size_t center,
                     std::span<const std::uint32_t> around, int stride) {
  RangeSample result = samples[center];
  const float spacing = likeness.spacing(center);
  float weight = 1;
  float shift = 0;
  for (const std::uint32_t i : around) {
    const auto [off, w] = likeness.tie(center, i, spacing, stride);
    if (!(w > 0)) continue;
    weight += w;
    shift += w * off;
    result.slope_x += w * samples[i].slope_x;
    result.slope_y += w * samples[i].slope_y;
  }
  result.depth += shift / weight * spacing;
  result.slope_x /= weight;
  result.slope_y /= weight;
  return result;
}

RangeSample part_of_the_way(const RangeSample& from, RangeSample to, float part) {
  to.depth = from.depth + part * (to.depth - from.depth);
  to.slope_x = from.slope_x + part * (to.slope_x - from.slope_x);
  to.slope_y = from.slope_y + part * (to.slope_y - from.slope_y);
  return to;
}

float averaged(const std::vector<float>& values, const Likeness& likeness, std::size_t center,
               std::span<const std::uint32_t> around, int stride) {
  const float spacing = likeness.spacing(center);
  float sum = values[center];
  float weight = 1;
  for (const std::uint32_t i : around) {
    const float w = likeness.tie(center, i, spacing, stride).weight;
    if (!(w > 0)) continue;  // the value of one that is not seen is no number
    weight += w;
    sum += w * values[i];
  }
  return sum / weight;
}

// How samples are averaged.
struct Averaging {
  struct Round {
    int stride = 1;
    float share = 1;  // of the way to the average
    bool flat_only = false;
  };
  std::vector<Round> rounds;
  // What a neighbour says of a sample's depth is by the sample's tangent plane and, to this share, by its
  // own. Where the surface bends the two err by as much to either side.
  float share_of_its_plane = 0;
  float share_of_rest = 1;        // of what the rounds took away and a second time leave
  float crease_spread_ratio = 0;  // see with_sharp_creases; 0: creases are left as the rounds make them
};

// With fewer rounds noise is left, with more shape goes: on simulated scans of two shapes these do best at
// 0.2 and 0.4 spacings of noise, and of three at 0.8. A share of a half gives a bent surface back what
// averaging takes; somewhat more also what the smoothing of the fused field will take. Noise that is less
// does not need that, and creases keep their place without.
Averaging averaging_for(float noise, bool on_lattice) {
  Averaging averaging;
  if (noise >= 0.1F) averaging.rounds = {{1}};
  if (noise >= 0.15F) averaging.rounds = {{1}, {2}};
  if (noise >= 0.3F) averaging.rounds = {{1}, {2}, {2}};
  if (on_lattice) {
    const float heavy = std::clamp((noise - 0.4F) / 0.2F, 0.0F, 1.0F);
    if (heavy > 0) {
      averaging.rounds.insert(averaging.rounds.end(), 2, {bends_stride, heavy});
      averaging.rounds.insert(averaging.rounds.end(), 2, {bends_stride, heavy, true});
    }
    averaging.share_of_its_plane = 0.65F * heavy;
    averaging.share_of_rest = 1 - 0.4F * heavy;
    averaging.crease_spread_ratio = 0.5F * heavy;
    return averaging;
  }
  if (noise >= 0.5F) averaging.rounds.push_back({4});
  std::size_t rounds = 0;
  for (const Averaging::Round& round : averaging.rounds)
    rounds += static_cast<std::size_t>(round.stride * round.stride);
  averaging.rounds.assign(rounds, {1});
  return averaging;
}

}  // namespace

float deviation_of(std::vector<float> magnitudes) {
  if (magnitudes.empty()) return 0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return 1.4826F * *middle;
}

std::vector<RangeSample> averaged_over_surfaces(std::vector<RangeSample> samples,
                                                const SampleNeighbors& neighbors, const Sight& sight,
                                                float noise) {
  const Averaging averaging = averaging_for(noise, neighbors.has_strides());
  if (averaging.rounds.empty()) return samples;
  std::vector<float> rest(samples.size(), 0.0F);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = samples[i].depth;
  std::vector<float> bends;
  const auto share_of = [&bends](const Averaging::Round& round, std::size_t i) {
    return round.flat_only ? round.share * (1 - bends[i]) : round.share;
  };
  bool first = true;
  for (const Averaging::Round& round : averaging.rounds) {
    // The first normals are mostly noise: there are no creases to be told from it yet.
    if (averaging.crease_spread_ratio > 0 && !first)
      samples = with_sharp_creases(std::move(samples), neighbors, averaging.crease_spread_ratio);
    first = false;
    if (round.stride == bends_stride && bends.empty()) bends = bends_of(samples, neighbors);
    const std::vector<RangeSample> before = samples;
    const Likeness likeness(before, neighbors, sight, noise, round.stride, averaging.share_of_its_plane,
                            bends);
    neighbors.for_all(
        [&](std::size_t i, std::span<const std::uint32_t> around) {
          if (!seen(before[i])) return;
          const RangeSample average = averaged(before, likeness, i, around, round.stride);
          samples[i] = part_of_the_way(before[i], average, share_of(round, i));
        },
        round.stride);
  }
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= samples[i].depth;
  const Likeness likeness(samples, neighbors, sight, noise, averaging.rounds.back().stride,
                          averaging.share_of_its_plane, bends);
  for (const Averaging::Round& round : averaging.rounds) {
    const std::vector<float> before = rest;
    neighbors.for_all(
        [&](std::size_t i, std::span<const std::uint32_t> around) {
          if (!seen(samples[i])) return;
          const float average = averaged(before, likeness, i, around, round.stride);
          rest[i] += share_of(round, i) * (average - before[i]);
        },
        round.stride);
  }
  for (std::size_t i = 0; i < rest.size(); ++i) samples[i].depth += averaging.share_of_rest * rest[i];
  return samples;
}

}  // namespace drape::meshing
