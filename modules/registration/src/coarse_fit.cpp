#include "coarse_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "motion_step.hpp"

namespace drape::registration {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double least_cosine = 0.70710678118654752;
constexpr std::size_t least_matches = 12;
constexpr double damping = 1e-3;

// Beside the border of a surface nothing lies on it: between samples the nearest is at most about a voxel
// aside.
bool beside(const Eigen::Vector3d& step, double distance, double voxel) {
  const double aside = 1.5 * voxel;
  return step.squaredNorm() - distance * distance > aside * aside;
}

// Sums of squared distances along the normals that motions move what is shared by.
struct Moves {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
  Matrix6 squares = Matrix6::Zero();
};

Moves moves_of(const CoarseScan& target, const std::vector<std::uint32_t>& on) {
  Moves moves;
  const auto count = static_cast<double>(on.size());
  for (const std::uint32_t i : on) moves.center += target.points()[i] / count;
  double squares = 0;
  for (const std::uint32_t i : on) squares += (target.points()[i] - moves.center).squaredNorm() / count;
  moves.radius = std::sqrt(squares);
  if (!(moves.radius > 0)) return moves;
  for (const std::uint32_t i : on) {
    Vector6 row;
    row << ((target.points()[i] - moves.center) / moves.radius).cross(target.normals()[i]),
        target.normals()[i];
    moves.squares.noalias() += row * row.transpose();
  }
  return moves;
}

double hold_of(const CoarseScan& target, const std::vector<std::uint32_t>& on) {
  const Moves moves = moves_of(target, on);
  if (!(moves.radius > 0)) return 0;
  const Vector6 sizes =
      Eigen::SelfAdjointEigenSolver<Matrix6>(moves.squares, Eigen::EigenvaluesOnly).eigenvalues();
  return sizes[0] / sizes.mean();
}

struct Shared {
  std::size_t samples = 0;
  std::vector<std::uint32_t> on;  // points of the target that samples lie on, one each
  double squares = 0;             // of their distances
};

Shared shared_points(const CoarseScan& source, const CoarseScan& target, const Rigid3& target_from_source,
                     std::size_t stride) {
  Shared shared;
  for (std::size_t i = 0; i < source.size(); i += stride) {
    ++shared.samples;
    const Eigen::Vector3d point = target_from_source * source.points()[i];
    const auto nearest = target.nearest(point);
    if (!nearest) continue;
    const Eigen::Vector3d& normal = target.normals()[*nearest];
    const Eigen::Vector3d step = point - target.points()[*nearest];
    const double distance = normal.dot(step);
    if (std::abs(distance) > target.voxel() || beside(step, distance, target.voxel()) ||
        normal.dot(target_from_source.linear() * source.normals()[i]) < least_cosine)
      continue;
    shared.on.push_back(*nearest);
    shared.squares += distance * distance;
  }
  return shared;
}

}  // namespace

CoarseFit measure_fit(const CoarseScan& source, const CoarseScan& target, const Rigid3& target_from_source,
                      std::size_t stride) {
  const Shared shared = shared_points(source, target, target_from_source, stride);
  if (shared.on.empty()) return {};
  const auto matched = static_cast<double>(shared.on.size());
  return {matched / static_cast<double>(shared.samples), std::sqrt(shared.squares / matched) / target.voxel(),
          hold_of(target, shared.on)};
}

SharedMotions shared_motions(const CoarseScan& source, const CoarseScan& target,
                             const Rigid3& target_from_source) {
  const Moves moves = moves_of(target, shared_points(source, target, target_from_source, 1).on);
  SharedMotions result;
  if (!(moves.radius > 0)) return result;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(moves.squares);
  result.holds = solver.eigenvalues() / solver.eigenvalues().mean();
  result.center = moves.center;
  result.radius = moves.radius;
  result.motions = solver.eigenvectors();
  return result;
}

Rigid3 SharedMotions::along(int which, double length) const {
  const Eigen::Vector3d rotation = length / radius * motions.col(which).head<3>();
  const double angle = rotation.norm();
  Rigid3 motion = Rigid3::Identity();
  if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  motion.translation() = center + length * motions.col(which).tail<3>() - motion.linear() * center;
  return motion;
}

Rigid3 fit_coarsely(const CoarseScan& source, const CoarseScan& target,
                    const Rigid3& target_from_source_guess, std::size_t stride, int steps) {
  Rigid3 motion = target_from_source_guess;
  const double voxel = target.voxel();
  BoundingBox box;
  for (const auto& p : source.points()) box.extend(p);
  double reach = 2 * voxel;
  for (int round = 0; round < steps; ++round) {
    MotionStep sums(motion * box.center());
    std::size_t matches = 0;
    for (std::size_t i = 0; i < source.size(); i += stride) {
      const Eigen::Vector3d point = motion * source.points()[i];
      const auto nearest = target.nearest(point);
      if (!nearest) continue;
      const Eigen::Vector3d own = motion.linear() * source.normals()[i];
      const Eigen::Vector3d& other = target.normals()[*nearest];
      if (own.dot(other) < least_cosine) continue;
      const Eigen::Vector3d normal = (own + other).normalized();
      const Eigen::Vector3d step = point - target.points()[*nearest];
      const double distance = normal.dot(step);
      if (std::abs(distance) >= reach || beside(step, distance, voxel)) continue;
      const double u = distance / reach;
      const double weight = (1 - u * u) * (1 - u * u);
      sums.add(point, normal, distance, weight);
      ++matches;
    }
    if (matches < least_matches) return motion;
    const auto [after, size] = sums.applied_to(motion, std::max(box.diagonal().norm() / 2, voxel), damping);
    motion = after;
    if (reach <= voxel && size < 0.01 * voxel) break;
    reach = std::max(voxel, 0.9 * reach);
  }
  return motion;
}

}  // namespace drape::registration
