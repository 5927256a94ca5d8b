#include "support_plane.hpp"

#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/msac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace drape::ingest {
namespace {

using Plane = Eigen::Hyperplane<double, 3>;

constexpr std::size_t most_samples = 20'000;
constexpr double least_share = 1.0 / 6;  // of the points on the plane
constexpr double least_in_front = 0.95;  // of the other points

// The plane with the most support among some of the points. PCL's coordinates are floats, so it sees them
// about their mean; its random numbers start from a fixed seed.
std::optional<Plane> best_plane(const std::vector<Eigen::Vector3d>& points, double tolerance) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / most_samples);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) center += point / static_cast<double>(points.size());
  const pcl::PointCloud<pcl::PointXYZ>::Ptr sample(new pcl::PointCloud<pcl::PointXYZ>);
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Vector3f p = (points[i] - center).cast<float>();
    sample->push_back({p.x(), p.y(), p.z()});
  }
  const pcl::SampleConsensusModelPlane<pcl::PointXYZ>::Ptr model(
      new pcl::SampleConsensusModelPlane<pcl::PointXYZ>(sample));
  pcl::MEstimatorSampleConsensus<pcl::PointXYZ> search(model, tolerance);
  // PCL prints what it does not like of its own random samples.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  search.setMaxIterations(2000);
  search.setProbability(0.9999);
  if (!search.computeModel()) return std::nullopt;
  Eigen::VectorXf coefficients;
  search.getModelCoefficients(coefficients);
  std::vector<int> inliers;
  search.getInliers(inliers);
  Eigen::VectorXf refined;
  model->optimizeModelCoefficients(inliers, coefficients, refined);
  const Eigen::Vector3d normal = refined.head<3>().cast<double>();
  if (!normal.allFinite() || normal.norm() < 0.5) return std::nullopt;
  Plane plane(normal.normalized(), static_cast<double>(refined[3]) / normal.norm());
  plane.offset() -= plane.normal().dot(center);
  return plane;
}

// Turned so that the scanner is in front.
void face(Plane& plane, const ScanView& view, const Eigen::Vector3d& near) {
  if (plane.normal().dot(view.towards_scanner(plane.projection(near))) < 0) plane.coeffs() *= -1;
}

}  // namespace

std::vector<std::uint8_t> support_plane(const RangeScan& scan, const ScanView& view, double tolerance) {
  const std::vector<Eigen::Vector3d>& points = scan.cloud.positions;
  std::vector<std::uint8_t> flags(points.size(), 0);
  if (points.size() < 3 || view.kind == ScanView::Kind::unknown || !(tolerance > 0)) return flags;
  std::optional<Plane> plane = best_plane(points, tolerance);
  if (!plane) return flags;
  face(*plane, view, points[points.size() / 2]);

  std::size_t on = 0;
  std::size_t in_front = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = plane->signedDistance(points[i]);
    on += std::abs(height) <= tolerance ? 1 : 0;
    in_front += height > tolerance ? 1 : 0;
    flags[i] = height <= tolerance ? 1 : 0;
  }
  const auto others = static_cast<double>(points.size() - on);
  const bool supports = static_cast<double>(on) >= least_share * static_cast<double>(points.size()) &&
                        others > 0 && static_cast<double>(in_front) >= least_in_front * others;
  if (!supports) std::fill(flags.begin(), flags.end(), std::uint8_t{0});
  return flags;
}

}  // namespace drape::ingest
