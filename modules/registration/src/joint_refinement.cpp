#include "joint_refinement.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"

namespace drape::registration {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t coarse_samples = 1500;
constexpr std::size_t fine_samples = 5000;
constexpr double nearly_converged = 10;  // times the tolerance: from there on many samples count
constexpr std::size_t least_matches = 20;

// Motions are a rotation vector times `radius` and a translation, both about `center`: one unit of either
// moves the outermost points by about one unit of length.
struct MotionFrame {
  Eigen::Vector3d center;
  double radius;
};

struct OrderedPair {
  std::size_t from;  // its samples ...
  std::size_t to;    // ... on this surface
};

// Normal equations of one pair for the motion of `from` against `to`: H x = -g.
struct PairSystem {
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
};

struct Row {
  Vector6 jacobian;
  double residual;
  double weight;
};

double median_size(const std::vector<Row>& rows) {
  std::vector<double> sizes;
  sizes.reserve(rows.size());
  for (const Row& row : rows) sizes.push_back(std::abs(row.residual));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

// The residual n * (p - q) of p (moving with `from`) against the plane (q, n) (moving with `to`) changes by
// [p x n, n] * (x_from - x_to) for small motions x = (rotation, translation) of the two.
PairSystem pair_system(const ScanSurface& from, const ScanSurface& to, const Rigid3& world_from_from,
                       const Rigid3& world_from_to, const MotionFrame& frame, std::size_t samples,
                       double reach) {
  const Rigid3 to_from_from = world_from_to.inverse() * world_from_from;
  std::vector<Row> rows;
  for (const std::uint32_t i : from.sample(samples)) {
    const Eigen::Vector3d point_in_to = to_from_from * from.points()[i];
    const auto match = to.match(point_in_to, to_from_from.linear() * from.normals()[i], reach);
    if (!match) continue;
    const Eigen::Vector3d arm = (world_from_to * point_in_to - frame.center) / frame.radius;
    const Eigen::Vector3d normal = world_from_to.linear() * match->normal;
    Row row;
    row.jacobian << arm.cross(normal), normal;
    // Where samples lie further apart, as far off along diverging rays, ranges are less certain in
    // proportion.
    row.jacobian /= match->scale;
    row.residual = match->distance / match->scale;
    row.weight = from.confidences()[i] * match->weight;
    rows.push_back(row);
  }
  PairSystem system;
  if (rows.size() < least_matches) return system;
  // Tukey's biweight at 4.685 deviations, these from the median; never so narrow that a good fit starves.
  const double cut = std::max(4.685 * 1.4826 * median_size(rows), 0.1 * to.spacing());
  for (const Row& row : rows) {
    const double u = row.residual / cut;
    if (std::abs(u) >= 1) continue;
    const double weight = row.weight * (1 - u * u) * (1 - u * u);
    system.H.noalias() += weight * row.jacobian * row.jacobian.transpose();
    system.g += weight * row.residual * row.jacobian;
  }
  return system;
}

// One motion a scan, from all pairs. A little damping leaves at rest what nothing determines.
std::vector<Vector6> solve(const std::vector<OrderedPair>& pairs, const std::vector<PairSystem>& systems,
                           std::size_t scans) {
  const auto size = static_cast<Eigen::Index>(6 * scans);
  std::vector<Matrix6> diagonal(scans, Matrix6::Zero());
  Eigen::VectorXd g = Eigen::VectorXd::Zero(size);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_block = [&](std::size_t row, std::size_t column, const Matrix6& block) {
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        entries.emplace_back(static_cast<int>(6 * row) + r, static_cast<int>(6 * column) + c, block(r, c));
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [from, to] = pairs[k];
    diagonal[from] += systems[k].H;
    diagonal[to] += systems[k].H;
    g.segment<6>(static_cast<Eigen::Index>(6 * from)) += systems[k].g;
    g.segment<6>(static_cast<Eigen::Index>(6 * to)) -= systems[k].g;
    add_block(from, to, -systems[k].H);
    add_block(to, from, -systems[k].H);
  }
  double largest = 0;
  for (const Matrix6& block : diagonal) largest = std::max(largest, block.diagonal().maxCoeff());
  std::vector<Vector6> motions(scans, Vector6::Zero());
  if (!(largest > 0)) return motions;
  const Matrix6 damping = 1e-4 * largest * Matrix6::Identity();
  for (std::size_t i = 0; i < scans; ++i) add_block(i, i, diagonal[i] + damping);
  Eigen::SparseMatrix<double> H(size, size);
  H.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(H).solve(-g);
  if (!x.allFinite()) return motions;
  for (std::size_t i = 0; i < scans; ++i) motions[i] = x.segment<6>(static_cast<Eigen::Index>(6 * i));
  return motions;
}

Rigid3 moved(const Rigid3& world_from_scan, const Vector6& motion, const MotionFrame& frame) {
  const Eigen::Vector3d rotation = motion.head<3>() / frame.radius;
  const double angle = rotation.norm();
  Rigid3 step = Rigid3::Identity();
  if (angle > 0) step.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  step.translation() = frame.center + motion.tail<3>() - step.linear() * frame.center;
  Rigid3 result = step * world_from_scan;
  result.linear() = Eigen::Quaterniond(result.linear()).normalized().toRotationMatrix();
  return result;
}

double largest_move(const ScanSurface& surface, const Rigid3& before, const Rigid3& after) {
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p = surface.box().corner(static_cast<BoundingBox::CornerType>(corner));
    largest = std::max(largest, (after * p - before * p).norm());
  }
  return largest;
}

bool near_each_other(const ScanSurface& a, const Rigid3& world_from_a, const ScanSurface& b,
                     const Rigid3& world_from_b, double reach) {
  const double apart = (world_from_a * a.box().center() - world_from_b * b.box().center()).norm();
  return apart < (a.box().diagonal().norm() + b.box().diagonal().norm()) / 2 + reach;
}

MotionFrame motion_frame(std::span<const ScanSurface> surfaces, std::span<const Rigid3> world_from_scan,
                         std::span<const std::uint8_t> use) {
  BoundingBox box;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (use[i] != 0)
      for (int corner = 0; corner < 8; ++corner)
        box.extend(world_from_scan[i] *
                   surfaces[i].box().corner(static_cast<BoundingBox::CornerType>(corner)));
  return {box.center(), std::max(box.diagonal().norm() / 2, 1e-300)};
}

}  // namespace

JointResult refine_jointly(std::span<const ScanSurface> surfaces, std::span<const Rigid3> world_from_scan,
                           std::span<const std::uint8_t> use, const JointOptions& options,
                           const Progress& progress) {
  JointResult result{{world_from_scan.begin(), world_from_scan.end()}, false, 0};
  std::vector<Rigid3>& poses = result.world_from_scan;
  std::vector<std::uint8_t> takes_part(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    takes_part[i] = use[i] != 0 && surfaces[i].is_surface() ? 1 : 0;
  if (std::count(takes_part.begin(), takes_part.end(), std::uint8_t{1}) < 2) {
    result.converged = true;
    return result;
  }
  const MotionFrame frame = motion_frame(surfaces, poses, takes_part);
  double reach = std::max(options.start_reach, options.end_reach);
  bool exact = false;
  while (result.iterations < options.iterations && !result.converged) {
    progress.update(static_cast<double>(result.iterations) / options.iterations,
                    "fitting the scans together");
    const bool fine = reach <= options.end_reach;
    std::vector<OrderedPair> pairs;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      for (std::size_t j = 0; j < surfaces.size(); ++j)
        if (i != j && takes_part[i] != 0 && takes_part[j] != 0 &&
            near_each_other(surfaces[i], poses[i], surfaces[j], poses[j], reach))
          pairs.push_back({i, j});
    std::vector<PairSystem> systems(pairs.size());
    parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        systems[k] = pair_system(surfaces[pairs[k].from], surfaces[pairs[k].to], poses[pairs[k].from],
                                 poses[pairs[k].to], frame, exact ? fine_samples : coarse_samples, reach);
    });
    const std::vector<Vector6> motions = solve(pairs, systems, surfaces.size());
    double motion = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (takes_part[i] == 0) continue;
      const Rigid3 after = moved(poses[i], motions[i], frame);
      motion = std::max(motion, largest_move(surfaces[i], poses[i], after));
      poses[i] = after;
    }
    ++result.iterations;
    result.converged = exact && motion < options.tolerance;
    exact = exact || (fine && motion < nearly_converged * options.tolerance);
    reach = std::clamp(std::min(0.8 * reach, 4 * motion), options.end_reach, reach);
  }
  return result;
}

}  // namespace drape::registration
