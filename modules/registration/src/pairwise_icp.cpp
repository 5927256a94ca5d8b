#include "pairwise_icp.hpp"

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/icp.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace drape::registration {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

// PCL computes in floats: positions about their own centre, in units of the object's size.
Cloud::Ptr to_pcl(const OrientedPoints& oriented, const Rigid3& motion, const Eigen::Vector3d& center,
                  double unit) {
  auto cloud = std::make_shared<Cloud>();
  cloud->reserve(oriented.points.size());
  for (std::size_t i = 0; i < oriented.points.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() = ((motion * oriented.points[i] - center) / unit).cast<float>();
    p.getNormalVector3fMap() = (motion.linear() * oriented.normals[i]).cast<float>();
    cloud->push_back(p);
  }
  return cloud;
}

// PCL tells the console when it finds too few matches; here that is one way for a trial to end.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

}  // namespace

Rigid3 pairwise_icp(const OrientedPoints& source, const OrientedPoints& target,
                    const Rigid3& target_from_source_guess, std::span<const double> reaches) {
  if (source.points.empty() || target.points.empty()) return target_from_source_guess;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const auto& p : target.points) center += p / static_cast<double>(target.points.size());
  double unit = 0;
  for (const auto& p : target.points) unit = std::max(unit, (p - center).norm());
  if (!(unit > 0)) return target_from_source_guess;

  const QuietPcl quiet;
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  auto compatible = std::make_shared<pcl::registration::CorrespondenceRejectorSurfaceNormal>();
  compatible->setThreshold(std::cos(M_PI / 4));
  icp.addCorrespondenceRejector(compatible);
  icp.setInputTarget(to_pcl(target, Rigid3::Identity(), center, unit));
  icp.setMaximumIterations(40);
  // In units of the object's size, squared: steps under a ten-thousandth of it end a round.
  icp.setTransformationEpsilon(1e-8);
  icp.setEuclideanFitnessEpsilon(1e-10);

  Rigid3 target_from_source = target_from_source_guess;
  for (const double reach : reaches) {
    icp.setInputSource(to_pcl(source, target_from_source, center, unit));
    icp.setMaxCorrespondenceDistance(reach / unit);
    Cloud aligned;
    icp.align(aligned);
    const Eigen::Matrix4d step = icp.getFinalTransformation().cast<double>();
    if (!step.allFinite()) return target_from_source;
    Rigid3 motion = Rigid3::Identity();
    motion.linear() = Eigen::Quaterniond(step.topLeftCorner<3, 3>()).normalized().toRotationMatrix();
    const Eigen::Vector3d shift = unit * step.topRightCorner<3, 1>();
    motion.translation() = center + shift - motion.linear() * center;
    target_from_source = motion * target_from_source;
  }
  return target_from_source;
}

}  // namespace drape::registration
