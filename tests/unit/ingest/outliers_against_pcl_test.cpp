// The fused neighbourhood pass against PCL's filter and normals, as its naive twin.
#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <set>

#include "analytic_scans.hpp"
#include "drape/ingest/clean_scan.hpp"

namespace drape::ingest {
namespace {

// A sphere's points at random, with noise, and strays all round it.
RangeScan sphere_with_strays(int points, int strays, double nearest, double furthest) {
  Rng rng(7);
  RangeScan scan;
  const auto direction = [&] {
    return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  };
  for (int i = 0; i < points; ++i) scan.cloud.positions.emplace_back((50 + 0.2 * rng.normal()) * direction());
  for (int i = 0; i < strays; ++i)
    scan.cloud.positions.emplace_back(rng.uniform(nearest, furthest) * direction());
  // PCL computes in floats: the same values for both.
  for (auto& p : scan.cloud.positions) p = p.cast<float>().cast<double>();
  return scan;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const RangeScan& scan) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : scan.cloud.positions)
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  return cloud;
}

CleanOptions outliers_only(int neighbors, double sigma) {
  CleanOptions options;
  options.outlier_neighbors = neighbors;
  options.outlier_sigma = sigma;
  options.min_island_points = 0;
  return options;
}

TEST(OutliersAgainstPcl, TheSamePointsGo) {
  const RangeScan scan = sphere_with_strays(20000, 300, 20, 100);
  for (const auto& [neighbors, sigma] : {std::pair(16, 3.0), std::pair(8, 2.0), std::pair(30, 5.0)}) {
    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
    filter.setInputCloud(to_pcl(scan));
    filter.setMeanK(neighbors);
    filter.setStddevMulThresh(sigma);
    pcl::Indices kept;
    filter.filter(kept);

    const CleanedScan cleaned = clean_scan(scan, outliers_only(neighbors, sigma), {});
    ASSERT_EQ(cleaned.scan.cloud.size(), kept.size()) << neighbors << " neighbours, " << sigma << " sigma";
    for (std::size_t i = 0; i < kept.size(); ++i)
      EXPECT_EQ(cleaned.scan.cloud.positions[i], scan.cloud.positions[static_cast<std::size_t>(kept[i])]);
    EXPECT_EQ(cleaned.dropped.at("outlier"), scan.cloud.size() - kept.size());
  }
}

TEST(OutliersAgainstPcl, NormalsAreThoseOfTheKeptPoints) {
  // The strays lie 7.5 above points that are 2.8 apart: every second normal is fitted to a stray at first.
  CleanOptions options = outliers_only(4, 3.0);
  options.normal_radius_spacings = 4;
  const CleanedScan cleaned = clean_scan(sphere_with_strays(4000, 100, 57, 58), options, {});
  ASSERT_GT(cleaned.dropped.at("outlier"), 90U);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(to_pcl(cleaned.scan));
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setKSearch(51);  // pi * 4^2 neighbours and the point itself
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  ASSERT_EQ(normals.size(), cleaned.scan.cloud.size());
  std::size_t agree = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3f n = normals[i].getNormalVector3fMap();
    agree += std::abs(n.dot(cleaned.scan.cloud.normals[i])) > 0.9999F ? 1 : 0;
  }
  // Strays that stayed have no sound plane, and in floats it can turn: leave one in a hundred.
  EXPECT_GE(agree, normals.size() * 99 / 100);
}

}  // namespace
}  // namespace drape::ingest
