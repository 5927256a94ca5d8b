#include "drape/alignment/point_pose.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "drape/base/error.hpp"

namespace drape::alignment {
namespace {

using Parameters = Eigen::Matrix<double, 7, 1>;  // rotation vector, x/z, y/z, log z, log focal length

constexpr double usual_focal = 1.2;    // of the longer side: between a phone's and a portrait lens
constexpr double focal_spread = 0.6;   // standard deviation of its logarithm
constexpr double click_share = 0.003;  // how exactly people click, of the longer side
constexpr int directions = 24;
constexpr int rolls = 4;
constexpr int most_iterations = 60;

struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d middle = Eigen::Vector3d::UnitZ();  // x/z, y/z, log z of the points' middle
  double log_focal = 0;
};

struct Problem {
  std::vector<PointPair> pairs;  // points about their middle, of size 1; pixels about the photo's middle
  double click_px = 1;
  double log_focal = 0;
  bool fixed_focal = false;
};

Pose moved(const Pose& pose, const Parameters& step) {
  Pose result = pose;
  const double angle = step.head<3>().norm();
  if (angle > 0)
    result.rotation = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix() * pose.rotation;
  result.middle += step.segment<3>(3);
  result.log_focal += step[6];
  return result;
}

Eigen::Vector3d in_camera(const Pose& pose, const Eigen::Vector3d& point) {
  const double z = std::exp(pose.middle.z());
  return pose.rotation * point + Eigen::Vector3d(pose.middle.x() * z, pose.middle.y() * z, z);
}

// Of each pair in x and y, then the pull on the focal length. Infinite where a point lies behind the camera.
Eigen::VectorXd residuals(const Problem& problem, const Pose& pose) {
  const auto count = static_cast<Eigen::Index>(problem.pairs.size());
  Eigen::VectorXd result(2 * count + 1);
  const double focal = std::exp(pose.log_focal);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointPair& pair = problem.pairs[static_cast<std::size_t>(i)];
    const Eigen::Vector3d x = in_camera(pose, pair.point);
    if (x.z() < 0.05)
      result.segment<2>(2 * i).setConstant(1e6);
    else
      result.segment<2>(2 * i) = (focal * x.head<2>() / x.z() - pair.pixel) / problem.click_px;
  }
  result[2 * count] = (pose.log_focal - problem.log_focal) / focal_spread;
  return result;
}

Eigen::MatrixXd derivatives(const Problem& problem, const Pose& pose) {
  constexpr double h = 1e-6;
  Eigen::MatrixXd result(2 * problem.pairs.size() + 1, 7);
  for (int k = 0; k < 7; ++k) {
    Parameters step = Parameters::Zero();
    step[k] = h;
    result.col(k) =
        (residuals(problem, moved(pose, step)) - residuals(problem, moved(pose, -step))) / (2 * h);
  }
  if (problem.fixed_focal) result.col(6).setZero();
  return result;
}

// The pose, and half its squared residuals.
std::pair<Pose, double> refined(const Problem& problem, Pose pose) {
  Eigen::VectorXd r = residuals(problem, pose);
  double cost = r.squaredNorm();
  double damping = 1e-3;
  for (int i = 0; i < most_iterations && damping < 1e9; ++i) {
    const Eigen::MatrixXd J = derivatives(problem, pose);
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal() *= 1 + damping;
    normal.diagonal().array() += 1e-9;
    Parameters step = normal.ldlt().solve(-J.transpose() * r);
    // A step of more than half a turn or of a factor of e is not to be trusted.
    step *= std::min(1.0, 1 / std::max(1e-12, step.cwiseAbs().maxCoeff()));
    const Pose next = moved(pose, step);
    const Eigen::VectorXd next_r = residuals(problem, next);
    const double next_cost = next_r.squaredNorm();
    if (!(next_cost < cost)) {
      damping *= 10;
      continue;
    }
    const bool done = cost - next_cost < 1e-10 * cost;
    pose = next;
    r = next_r;
    cost = next_cost;
    damping = std::max(1e-9, damping / 10);
    if (done) break;
  }
  return {pose, cost};
}

// Views from all sides (a Fibonacci lattice), each rolled by quarters of a turn.
std::vector<Eigen::Matrix3d> rotations() {
  std::vector<Eigen::Matrix3d> list;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions;
    const double azimuth = 2 * std::numbers::pi * i / std::numbers::phi;
    const double flat = std::sqrt(1 - z * z);
    const Eigen::Vector3d axis(flat * std::cos(azimuth), flat * std::sin(azimuth), z);
    const Eigen::Matrix3d look =
        Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (int k = 0; k < rolls; ++k)
      list.push_back(
          Eigen::AngleAxisd(k * 2 * std::numbers::pi / rolls, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
          look);
  }
  return list;
}

// How far the points are from lying on one line: the second singular value as a share of the first.
template <int Rows>
double breadth(const Eigen::Matrix<double, Rows, Eigen::Dynamic>& points) {
  const Eigen::Matrix<double, Rows, Eigen::Dynamic> centered =
      points.colwise() - points.rowwise().mean().eval();
  const auto values = Eigen::JacobiSVD<Eigen::MatrixXd>(centered).singularValues();
  return values[0] > 0 ? values[1] / values[0] : 0;
}

}  // namespace

PointPose camera_from_points(const std::vector<PointPair>& pairs, int width, int height,
                             std::optional<double> focal_px) {
  constexpr std::size_t least_pairs = 4;
  constexpr double least_breadth = 0.02;
  if (pairs.size() < least_pairs)
    throw config_error("a camera needs {} pairs of points at least; these are {}", least_pairs, pairs.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic> points(3, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Matrix<double, 2, Eigen::Dynamic> pixels(2, points.cols());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = pairs[i].point;
    pixels.col(static_cast<Eigen::Index>(i)) = pairs[i].pixel;
  }
  if (!points.allFinite() || !pixels.allFinite())
    throw config_error("the pairs of points hold what is no number");
  if (breadth<3>(points) < least_breadth || breadth<2>(pixels) < least_breadth)
    throw config_error("the pairs of points lie on one line; a camera needs some off it");

  const Eigen::Vector3d middle = points.rowwise().mean();
  const double size = std::sqrt((points.colwise() - middle).colwise().squaredNorm().mean());
  const Eigen::Vector2d center(width / 2.0, height / 2.0);
  const double side = std::max(width, height);
  Problem problem;
  problem.click_px = click_share * side;
  problem.log_focal = std::log(focal_px.value_or(usual_focal * side));
  problem.fixed_focal = focal_px.has_value();
  for (const PointPair& pair : pairs)
    problem.pairs.push_back({pair.pixel - center, (pair.point - middle) / size});

  const Eigen::Vector2d pixel_middle = pixels.rowwise().mean() - center;
  const double spread_px =
      std::sqrt((pixels.colwise() - pixels.rowwise().mean().eval()).colwise().squaredNorm().mean());
  const double focal = std::exp(problem.log_focal);
  Pose best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& rotation : rotations()) {
    // As far off as makes the points as large as the pixels have them, but with all of them in front.
    const double depth = std::max(2.0, 0.8 * focal / spread_px);
    const Pose start{
        rotation, {pixel_middle.x() / focal, pixel_middle.y() / focal, std::log(depth)}, problem.log_focal};
    const auto [pose, cost] = refined(problem, start);
    if (cost < best_cost) {
      best = pose;
      best_cost = cost;
    }
  }

  PointPose result;
  result.camera.width = width;
  result.camera.height = height;
  const double f = std::exp(best.log_focal);
  result.camera.K << f, 0, center.x(), 0, f, center.y(), 0, 0, 1;
  result.camera.camera_from_world.linear() = best.rotation;
  result.camera.camera_from_world.translation() =
      size * in_camera(best, Eigen::Vector3d::Zero()) - best.rotation * middle;
  double squares = 0;
  for (const PointPair& pair : pairs)
    squares += (result.camera.project(pair.point).pixel - pair.pixel).squaredNorm();
  result.rms_px = std::sqrt(squares / static_cast<double>(pairs.size()));
  return result;
}

}  // namespace drape::alignment
