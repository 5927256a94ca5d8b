#include "global_placement.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <optional>
#include <vector>

#include "drape/ingest/estimate_normals.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

struct Searched {
  explicit Searched(const test::ScannedShape& of)
      : scans(of.scans.begin(), of.scans.begin() + 2), search(make(*this)) {}
  Searched(const Searched&) = delete;
  Searched& operator=(const Searched&) = delete;

  static GlobalSearch make(Searched& self) {
    for (const RangeScan& scan : self.scans)
      self.surfaces.emplace_back(scan, self.normals.emplace_back(ingest::estimate_normals(scan)));
    return {std::vector<PlacedScan>(2), self.scans, self.surfaces, {}};
  }

  std::vector<RangeScan> scans;
  std::deque<std::vector<Eigen::Vector3f>> normals;
  std::vector<ScanSurface> surfaces;
  GlobalSearch search;
};

TEST(GlobalSearch, ARefutedPoseIsNotTakenAgain) {
  Searched two(test::turned_anyhow(test::scan_from_sides(test::wavy_field(), 0.05), 5));
  const GlobalPlacement first = two.search.place({});
  ASSERT_TRUE(first.scans[0].placed && first.scans[1].placed) << first.pairs[0].reason;
  ASSERT_TRUE(first.pairs[0].accepted);
  EXPECT_TRUE(two.search.objection(1, first.scans).reason.empty());
  const RefutedPair refuted{0, 1, first.pairs[0].second_from_first, "as the test wants it"};
  // Whether there is another way to lay them or not, it is not this one.
  const std::optional<GlobalPlacement> second = two.search.place_otherwise({refuted}, {});
  if (second && second->pairs[0].accepted) {
    const Eigen::Vector3d p = two.surfaces[0].box().center();
    EXPECT_GT((second->pairs[0].second_from_first * p - refuted.other_from_scan * p).norm(),
              two.search.voxel());
  }
}

TEST(GlobalSearch, WhatRefutesNothingThatWasFoundChangesNothing) {
  Searched two(test::turned_anyhow(test::scan_from_sides(test::wavy_field(), 0.05), 5));
  const GlobalPlacement first = two.search.place({});
  Rigid3 elsewhere = first.pairs[0].second_from_first;
  elsewhere.translation() += Eigen::Vector3d(100, 0, 0);
  const auto second = two.search.place_otherwise({{1, 0, elsewhere.inverse(), "far off"}}, {});
  ASSERT_TRUE(second);
  ASSERT_TRUE(second->pairs[0].accepted) << second->pairs[0].reason;
  const Eigen::Vector3d p = two.surfaces[0].box().center();
  EXPECT_LT((second->pairs[0].second_from_first * p - first.pairs[0].second_from_first * p).norm(),
            two.search.voxel());
}

}  // namespace
}  // namespace drape::registration
