#include "drape/ingest/clean_scan.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "analytic_scans.hpp"
#include "drape/base/parallel.hpp"
#include "drape/ingest/estimate_normals.hpp"
#include "support.hpp"

namespace drape::ingest {
namespace {

using test::scan_field;

// Every filter that an option can switch off, off.
CleanOptions keep_all() {
  CleanOptions options;
  options.mixed_pixel_angle_deg = 90;
  options.outlier_sigma = 0;
  options.max_incidence_deg = 90;
  options.min_island_points = 0;
  return options;
}

// A plate in front of a wall, 30 apart, and along the plate's left edge one column of points in the air.
struct PlateAndVeil {
  RangeScan scan;
  std::vector<std::int32_t> veil;
};
PlateAndVeil plate_and_veil(double noise) {
  const auto field = test::united(test::box_field({100, 100, 1}),
                                  [plate = test::box_field({15, 15, 1})](const Eigen::Vector3d& p) {
                                    return plate(p - Eigen::Vector3d(0, 0, 30));
                                  });
  PlateAndVeil result{scan_field(field, Rigid3::Identity(), {.noise = noise}), {}};
  const RangeGrid& grid = *result.scan.grid;
  Rng rng(11);
  for (int row = 16; row < 44; ++row) {
    const std::int32_t index = grid.at(row, 14);  // the plate covers the columns 15 to 44
    result.scan.cloud.positions[static_cast<std::size_t>(index)].z() = rng.uniform(10, 22);
    result.veil.push_back(index);
  }
  return result;
}

void expect_consistent_grid(const RangeScan& scan) {
  ASSERT_TRUE(scan.grid);
  std::vector<int> seen(scan.cloud.size(), 0);
  for (const std::int32_t cell : scan.grid->cells) {
    ASSERT_GE(cell, RangeGrid::missing);
    ASSERT_LT(cell, static_cast<std::int32_t>(scan.cloud.size()));
    if (cell >= 0) ++seen[static_cast<std::size_t>(cell)];
  }
  for (const int count : seen) EXPECT_EQ(count, 1);
}

TEST(CleanScan, KeepsAGoodScanWhole) {
  const RangeScan raw = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {.noise = 0.05});
  const CleanedScan cleaned = clean_scan(raw, {}, {});
  EXPECT_EQ(cleaned.scan.cloud.positions, raw.cloud.positions);
  for (const char* filter : {"outlier", "not_finite", "duplicate", "mixed_pixel", "grazing", "island"})
    EXPECT_EQ(cleaned.dropped.at(filter), 0U) << filter;
  EXPECT_NEAR(cleaned.scan.spacing, 1.0, 1e-9);
  EXPECT_EQ(cleaned.scan.cloud.normals.size(), cleaned.scan.cloud.size());
  EXPECT_EQ(cleaned.scan.cloud.confidences.size(), cleaned.scan.cloud.size());
}

TEST(CleanScan, DropsWhatIsNotFiniteAndWhatIsThereTwice) {
  RangeScan raw = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {.rows = 20, .columns = 20});
  raw.cloud.positions[5].x() = std::numeric_limits<double>::quiet_NaN();
  raw.cloud.positions[7].z() = std::numeric_limits<double>::infinity();
  raw.cloud.positions[50] = raw.cloud.positions[40];
  raw.cloud.positions[60] = raw.cloud.positions[40];
  const CleanedScan cleaned = clean_scan(raw, keep_all(), {});
  EXPECT_EQ(cleaned.dropped.at("not_finite"), 2U);
  EXPECT_EQ(cleaned.dropped.at("duplicate"), 2U);
  EXPECT_EQ(cleaned.scan.cloud.size(), 396U);
  EXPECT_EQ(cleaned.scan.cloud.positions[38], raw.cloud.positions[40]) << "the first of the equal ones stays";
  expect_consistent_grid(cleaned.scan);
  EXPECT_EQ(cleaned.scan.grid->at(0, 5), RangeGrid::missing);
  EXPECT_EQ(cleaned.scan.grid->at(2, 0), 38);
}

TEST(CleanScan, AttributesFollowTheirPoints) {
  RangeScan raw = plate_and_veil(0).scan;
  for (const auto& p : raw.cloud.positions) {
    raw.cloud.colors.emplace_back(p.cast<float>());
    raw.cloud.intensities.push_back(static_cast<float>(p.x()));
    raw.cloud.confidences.push_back(0.5F);
  }
  const RangeScan scan = clean_scan(raw, {}, {}).scan;
  ASSERT_LT(scan.cloud.size(), raw.cloud.size());
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    EXPECT_EQ(scan.cloud.colors[i], scan.cloud.positions[i].cast<float>());
    EXPECT_EQ(scan.cloud.intensities[i], static_cast<float>(scan.cloud.positions[i].x()));
    EXPECT_LE(scan.cloud.confidences[i], 0.5F) << "what the scanner stated, times the cosine";
  }
  expect_consistent_grid(scan);
}

TEST(CleanScan, MixedPixelsGoAndTheirSurfacesStay) {
  for (const double noise : {0.0, 0.2}) {
    const auto [raw, veil] = plate_and_veil(noise);
    CleanOptions options = keep_all();
    options.mixed_pixel_angle_deg = 80;
    const CleanedScan cleaned = clean_scan(raw, options, {});
    EXPECT_EQ(cleaned.dropped.at("mixed_pixel"), veil.size());
    for (const auto& p : cleaned.scan.cloud.positions) EXPECT_TRUE(p.z() < 3 || p.z() > 28) << p.transpose();
    expect_consistent_grid(cleaned.scan);
    // The steps of the veil to its sides are between 8 and 21: no steeper than 83 to 88 degrees.
    options.mixed_pixel_angle_deg = 89;
    EXPECT_EQ(clean_scan(raw, options, {}).dropped.at("mixed_pixel"), 0U);
  }
}

TEST(CleanScan, MixedPixelsOfDivergingRaysGoToo) {
  const auto field = test::united(test::box_field({400, 400, 1}),
                                  [plate = test::box_field({15, 15, 1})](const Eigen::Vector3d& p) {
                                    return plate(p - Eigen::Vector3d(0, 0, 60));
                                  });
  RangeScan raw = scan_field(field, Rigid3::Identity(), {.diverging = true});
  const Eigen::Vector3d eye = raw.view.vector;
  // Between plate and wall: the leftmost column of the plate moves back along its rays.
  int moved = 0;
  for (int row = 0; row < raw.grid->rows; ++row)
    for (int column = 0; column < raw.grid->columns; ++column) {
      const auto index = raw.grid->at(row, column);
      const auto before = raw.grid->at(row, std::max(0, column - 1));
      if (index < 0 || raw.cloud.positions[index].z() < 50 || raw.cloud.positions[before].z() > 50) continue;
      Eigen::Vector3d& p = raw.cloud.positions[static_cast<std::size_t>(index)];
      p = eye + 1.2 * (p - eye);
      ++moved;
      break;
    }
  ASSERT_GT(moved, 15);
  CleanOptions options = keep_all();
  options.mixed_pixel_angle_deg = 80;
  const CleanedScan cleaned = clean_scan(raw, options, {});
  EXPECT_EQ(cleaned.dropped.at("mixed_pixel"), static_cast<std::size_t>(moved));
}

TEST(CleanScan, NoiseOfADenseScanIsNoMixedPixel) {
  // Noise of ten spacings: nearly every step on this flat wall is steep.
  const RangeScan raw = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {.noise = 10});
  CleanOptions options = keep_all();
  options.mixed_pixel_angle_deg = 80;
  EXPECT_LT(clean_scan(raw, options, {}).dropped.at("mixed_pixel"), raw.cloud.size() / 1000);
}

TEST(CleanScan, StatisticalOutliersByTheirOptions) {
  RangeScan raw = test::without_grid(scan_field(test::sphere_field(25), Rigid3::Identity(), {}));
  const std::size_t good = raw.cloud.size();
  Rng rng(5);
  for (int i = 0; i < 20; ++i)
    raw.cloud.positions.emplace_back(rng.uniform(-40, 40), rng.uniform(-40, 40), rng.uniform(40, 80));
  CleanOptions options = keep_all();
  options.outlier_sigma = 3;
  const CleanedScan cleaned = clean_scan(raw, options, {});
  EXPECT_GE(cleaned.dropped.at("outlier"), 15U);
  EXPECT_LE(cleaned.dropped.at("outlier"), 20U + good / 50);
  options.outlier_sigma = 0;
  EXPECT_EQ(clean_scan(raw, options, {}).dropped.at("outlier"), 0U);
  // A pair of strays hides from a count of one neighbour.
  raw.cloud.positions.resize(good);
  raw.cloud.positions.emplace_back(0, 0, 80);
  raw.cloud.positions.emplace_back(0, 0, 81);
  options.outlier_sigma = 3;
  options.outlier_neighbors = 1;
  const RangeScan with_pair = clean_scan(raw, options, {}).scan;
  EXPECT_EQ(with_pair.cloud.positions.back(), Eigen::Vector3d(0, 0, 81));
  options.outlier_neighbors = 8;
  EXPECT_LT(clean_scan(raw, options, {}).scan.cloud.positions.back().z(), 30);
}

TEST(CleanScan, FarSurfacesOfDivergingRaysAreNoOutliers) {
  // A floor below the scanner: ten times sparser far away.
  RangeScan raw;
  raw.view = {ScanView::Kind::origin, {0, 0, 1.5}};
  for (int ring = 0; ring < 60; ++ring)
    for (int spoke = 0; spoke < 360; ++spoke) {
      const double radius = 1.0 * std::pow(1.0 + 2 * std::numbers::pi / 360, 3 * ring);
      const double angle = 2 * std::numbers::pi * spoke / 360;
      raw.cloud.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  CleanOptions options = keep_all();
  options.outlier_sigma = 2;
  EXPECT_LT(clean_scan(raw, options, {}).dropped.at("outlier"), raw.cloud.size() / 20);
  EXPECT_GT(clean_scan(test::without_view(raw), options, {}).dropped.at("outlier"), raw.cloud.size() / 20)
      << "what the range saves us from";
}

TEST(CleanScan, GrazingReturnsByTheirAngle) {
  const RangeScan raw =
      scan_field(test::sphere_field(25), Rigid3::Identity(), {.rows = 120, .columns = 120, .pitch = 0.5});
  for (const double limit : {60.0, 75.0}) {
    CleanOptions options = keep_all();
    options.max_incidence_deg = limit;
    const CleanedScan cleaned = clean_scan(raw, options, {});
    // The share of a disc outside sin(limit), to within the estimated normals at the rim.
    const double expected =
        std::pow(std::cos(limit * std::numbers::pi / 180), 2) * static_cast<double>(raw.cloud.size());
    EXPECT_NEAR(static_cast<double>(cleaned.dropped.at("grazing")) / expected, 1.0, 0.2) << limit;
  }
  EXPECT_EQ(clean_scan(raw, keep_all(), {}).dropped.at("grazing"), 0U);
  CleanOptions unseen = keep_all();
  unseen.max_incidence_deg = 60;
  EXPECT_EQ(clean_scan(test::without_view(test::without_grid(raw)), unseen, {}).dropped.at("grazing"), 0U);
}

TEST(CleanScan, SmallIslandsByTheirSizeAndDistance) {
  const auto wall = test::box_field({20, 20, 1});
  const auto chip = [box = test::box_field({2.4, 2.4, 1})](const Eigen::Vector3d& p) {
    return box(p - Eigen::Vector3d(0, 0, 12));
  };
  const RangeScan raw = scan_field(test::united(wall, chip), Rigid3::Identity(), {});
  for (const RangeScan& scan : {raw, test::without_grid(raw)}) {
    CleanOptions options = keep_all();
    options.min_island_points = 30;
    options.island_gap_spacings = 3;
    const CleanedScan cleaned = clean_scan(scan, options, {});
    EXPECT_EQ(cleaned.dropped.at("island"), 16U) << "the 4 by 4 samples of the chip";
    for (const auto& p : cleaned.scan.cloud.positions) EXPECT_LT(p.z(), 5);
    options.min_island_points = 16;
    EXPECT_EQ(clean_scan(scan, options, {}).dropped.at("island"), 0U);
    options.min_island_points = 30;
    options.island_gap_spacings = 12;
    EXPECT_EQ(clean_scan(scan, options, {}).dropped.at("island"), 0U);
  }
}

TEST(CleanScan, SmallIslandsOfDivergingRays) {
  const auto field = test::united(test::box_field({20, 20, 1}),
                                  [box = test::box_field({2.4, 2.4, 1})](const Eigen::Vector3d& p) {
                                    return box(p - Eigen::Vector3d(0, 0, 12));
                                  });
  CleanOptions options = keep_all();
  options.min_island_points = 40;
  options.island_gap_spacings = 3;
  const RangeScan raw = scan_field(field, Rigid3::Identity(), {.diverging = true});
  for (const RangeScan& scan : {raw, test::without_grid(raw)}) {
    const CleanedScan cleaned = clean_scan(scan, options, {});
    EXPECT_EQ(cleaned.dropped.at("island"), 36U) << "6 by 6 samples, 0.935 apart";
    for (const auto& p : cleaned.scan.cloud.positions) EXPECT_LT(p.z(), 5);
  }
}

TEST(CleanScan, FarSurfacesOfDivergingRaysAreNoIslands) {
  // A wall along a logarithmic spiral round the eye: always seen at 45 degrees, its end 150 times as far as
  // its start.
  RangeScan raw;
  raw.view = {ScanView::Kind::origin, Eigen::Vector3d::Zero()};
  raw.grid = RangeGrid{20, 500, {}};
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 500; ++column) {
      const double around = 0.01 * column;
      const Eigen::Vector3d ray(std::cos(around), std::sin(around), 0.01 * row);
      raw.grid->cells.push_back(static_cast<std::int32_t>(raw.cloud.size()));
      raw.cloud.positions.emplace_back(std::exp(around) * ray);
    }
  CleanOptions options = keep_all();
  options.min_island_points = 5000;
  EXPECT_EQ(clean_scan(raw, options, {}).dropped.at("island"), 0U);
}

TEST(CleanScan, NormalsOfTheFileStayUnlessAskedOtherwise) {
  RangeScan raw = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {});
  const Eigen::Vector3f odd = Eigen::Vector3f(0.6F, 0, -0.8F);
  raw.cloud.normals.assign(raw.cloud.size(), 3 * odd);
  CleanOptions options = keep_all();
  for (const auto& n : clean_scan(raw, options, {}).scan.cloud.normals)
    EXPECT_NEAR((n + odd).norm(), 0, 1e-6) << "unit length, turned to the scanner";
  options.normals = Normals::estimate;
  for (const auto& n : clean_scan(raw, options, {}).scan.cloud.normals) EXPECT_NEAR(n.z(), 1, 1e-6);
  raw.cloud.normals[3].setZero();
  options.normals = Normals::automatic;
  for (const auto& n : clean_scan(raw, options, {}).scan.cloud.normals)
    EXPECT_NEAR(n.z(), 1, 1e-6) << "normals with gaps are no normals";
}

TEST(CleanScan, NormalRadiusReachesTheEstimate) {
  const RangeScan raw = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {.noise = 0.3});
  const auto spread = [&](double radius) {
    CleanOptions options = keep_all();
    options.normal_radius_spacings = radius;
    double sum = 0;
    for (const auto& n : clean_scan(raw, options, {}).scan.cloud.normals) sum += 1 - n.z();
    return sum;
  };
  EXPECT_LT(spread(5.0), 0.3 * spread(2.0));
}

TEST(CleanScan, ConfidenceIsTheCosineOfTheIncidence) {
  const double tilt_deg = 40;
  const RangeScan raw =
      scan_field(test::box_field({200, 200, 5}), test::rotation_deg(tilt_deg, Eigen::Vector3d::UnitX()),
                 {.rows = 40, .columns = 40, .most_depth = 1000});
  const CleanedScan cleaned = clean_scan(raw, keep_all(), {});
  ASSERT_FALSE(cleaned.scan.cloud.empty());
  for (const float c : cleaned.scan.cloud.confidences)
    EXPECT_NEAR(c, std::cos(tilt_deg * std::numbers::pi / 180), 1e-4);
  for (const float c :
       clean_scan(test::without_view(test::without_grid(raw)), keep_all(), {}).scan.cloud.confidences)
    EXPECT_EQ(c, 1.0F);
}

TEST(CleanScan, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const bool grid : {true, false}) {
    RangeScan raw = plate_and_veil(0.1).scan;
    if (!grid) raw = test::without_view(test::without_grid(raw));
    set_thread_count(1);
    const RangeScan one = clean_scan(raw, {}, {}).scan;
    set_thread_count(4);
    const RangeScan four = clean_scan(raw, {}, {}).scan;
    set_thread_count(0);
    EXPECT_EQ(one.cloud.positions, four.cloud.positions);
    EXPECT_EQ(one.cloud.normals, four.cloud.normals);
    EXPECT_EQ(one.cloud.confidences, four.cloud.confidences);
    EXPECT_EQ(one.spacing, four.spacing);
  }
}

TEST(CleanScan, OfNoPoints) {
  const CleanedScan cleaned = clean_scan(RangeScan{}, {}, {});
  EXPECT_TRUE(cleaned.scan.cloud.empty());
  EXPECT_EQ(cleaned.scan.spacing, 0.0);
  RangeScan empty_grid;
  empty_grid.grid = RangeGrid{2, 2, std::vector<std::int32_t>(4, RangeGrid::missing)};
  EXPECT_TRUE(clean_scan(empty_grid, {}, {}).scan.cloud.empty());
}

TEST(CleanScan, OfPointsThatAreAllTheSame) {
  RangeScan raw;
  raw.cloud.positions.assign(1000, {1, 2, 3});
  const CleanedScan cleaned = clean_scan(raw, {}, {});
  EXPECT_EQ(cleaned.scan.cloud.size(), 1U);
  EXPECT_EQ(cleaned.dropped.at("duplicate"), 999U);
}

TEST(CleanScan, OfPointsThatAreAllNotFinite) {
  RangeScan raw;
  raw.cloud.positions.assign(10, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(clean_scan(raw, {}, {}).scan.cloud.empty());
}

TEST(CleanScan, OfThreePointsAndOfALine) {
  RangeScan three;
  three.cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(clean_scan(three, {}, {}).scan.cloud.size(), 3U);
  RangeScan line;
  for (int i = 0; i < 100; ++i) line.cloud.positions.emplace_back(i, 0, 0);
  const CleanedScan cleaned = clean_scan(line, {}, {});
  EXPECT_GE(cleaned.scan.cloud.size(), 90U);
  for (const auto& n : cleaned.scan.cloud.normals) EXPECT_NEAR(n.norm(), 1, 1e-5);
}

RangeScan flat_lattice() {
  return scan_field(test::box_field({100, 100, 1}), Rigid3::Identity(), {});  // 60 x 60 points, 1 apart
}

TEST(CleanScan, KeepsWhatLiesInTheCropBox) {
  CleanOptions options = keep_all();
  options.crop_box = {-10, -5, -100, 10, 5, 100};
  const CleanedScan cleaned = clean_scan(flat_lattice(), options, {});
  EXPECT_EQ(cleaned.scan.cloud.size(), 200U);
  EXPECT_EQ(cleaned.dropped.at("cropped"), 3400U);
  for (const auto& p : cleaned.scan.cloud.positions) {
    EXPECT_LE(std::abs(p.x()), 10);
    EXPECT_LE(std::abs(p.y()), 5);
  }
}

TEST(CleanScan, DropsReturnsThatAreTooWeakOrTooStrong) {
  RangeScan raw = flat_lattice();
  CleanOptions options = keep_all();
  options.min_intensity = 0.25;
  options.max_intensity = 0.75;
  EXPECT_EQ(clean_scan(raw, options, {}).dropped.at("intensity"), 0U) << "nothing is known of returns";
  for (std::size_t i = 0; i < raw.cloud.size(); ++i)
    raw.cloud.intensities.push_back(static_cast<float>(i % 4) / 3);  // 0, 1/3, 2/3, 1
  const CleanedScan cleaned = clean_scan(raw, options, {});
  EXPECT_EQ(cleaned.dropped.at("intensity"), 1800U);
  for (const float intensity : cleaned.scan.cloud.intensities) EXPECT_NEAR(intensity, 0.5F, 0.2F);
}

TEST(CleanScan, DropsPointsWithTooFewAround) {
  RangeScan raw = test::without_grid(flat_lattice());
  const std::size_t sound = raw.cloud.size();
  for (int i = 0; i < 5; ++i) raw.cloud.positions.emplace_back(10 * i, 0, 20);
  raw.cloud.positions.emplace_back(0.5, 0, 20);  // two that have only each other
  CleanOptions options = keep_all();
  options.outlier_radius_spacings = 2.5;
  options.outlier_radius_points = 3;
  const CleanedScan cleaned = clean_scan(raw, options, {});
  EXPECT_EQ(cleaned.dropped.at("sparse"), 6U);
  EXPECT_EQ(cleaned.scan.cloud.size(), sound);
  options.outlier_radius_points = 1;
  EXPECT_EQ(clean_scan(raw, options, {}).dropped.at("sparse"), 4U);
}

TEST(CleanScan, ThinningKeepsThePointThatWasSeenBest) {
  RangeScan raw = flat_lattice();
  for (std::size_t i = 0; i < raw.cloud.size(); ++i)
    raw.cloud.confidences.push_back(i % 7 == 0 ? 1.0F : 0.5F);
  CleanOptions options = keep_all();
  options.thin_voxel_spacings = 10;
  const CleanedScan cleaned = clean_scan(raw, options, {});
  EXPECT_EQ(cleaned.scan.cloud.size(), 36U);
  EXPECT_EQ(cleaned.dropped.at("thinned"), 3564U);
  for (const float confidence : cleaned.scan.cloud.confidences)
    EXPECT_NEAR(confidence, 1.0F, 1e-5F) << "each voxel of a hundred points has a good one";
}

TEST(CleanScan, IsLessConfidentOfWhatLiesFar) {
  // Two plates, one twice as far from the scanner as the other, the far one with fewer points.
  const auto field =
      test::united([box = test::box_field({21, 100, 1})](
                       const Eigen::Vector3d& p) { return box(p - Eigen::Vector3d(-18, 0, 0)); },
                   [box = test::box_field({400, 400, 1})](const Eigen::Vector3d& p) {
                     return box(p - Eigen::Vector3d(0, 0, -200));
                   });
  const RangeScan raw =
      scan_field(field, Rigid3::Identity(), {.distance = 200, .most_depth = 900, .diverging = true});
  const CleanedScan cleaned = clean_scan(raw, keep_all(), {});
  for (std::size_t i = 0; i < cleaned.scan.cloud.size(); ++i) {
    const Eigen::Vector3d& p = cleaned.scan.cloud.positions[i];
    const Eigen::Vector3d ray = p - raw.view.vector;
    if (std::abs(cleaned.scan.cloud.normals[i].z()) < 0.999F) continue;  // at the edge between them
    const double cosine = -ray.normalized().z();
    EXPECT_NEAR(cleaned.scan.cloud.confidences[i], p.z() > -100 ? cosine : cosine / 2, 0.05);
  }
}

TEST(CleanScan, OptionsHaveNamesRangesAndHelp) {
  CleanOptions options;
  for (const Option& option : options_of(options)) EXPECT_FALSE(option.help.empty()) << option.name;
}

}  // namespace
}  // namespace drape::ingest
