#include "drape/stages/stage_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "drape/stages/units.hpp"

namespace drape::stages {
namespace {

TEST(StageTable, EveryReadHasAnEarlierProducer) {
  const auto table = stage_table();
  for (std::size_t i = 0; i < table.size(); ++i)
    for (const pipeline::Artifact& artifact : table[i].reads) {
      const bool produced = std::any_of(
          table.begin(), table.begin() + static_cast<std::ptrdiff_t>(i), [&](const pipeline::Stage& earlier) {
            return earlier.name == artifact.stage && std::find(earlier.writes.begin(), earlier.writes.end(),
                                                               artifact.pattern) != earlier.writes.end();
          });
      EXPECT_TRUE(produced) << table[i].name << " reads " << artifact.stage << "/" << artifact.pattern;
    }
}

TEST(StageTable, NamesAreUniqueAndEveryOptionIsExplained) {
  std::set<std::string> names;
  for (const pipeline::Stage& stage : stage_table()) {
    EXPECT_TRUE(names.insert(stage.name).second);
    EXPECT_FALSE(stage.summary.empty());
    std::set<std::string> options;
    for (const Option& option : stage.instantiate().options) {
      EXPECT_TRUE(options.insert(option.name).second) << stage.name << "." << option.name;
      EXPECT_GE(option.help.size(), 10U) << stage.name << "." << option.name;
      // The default must be a value that the option itself would take.
      if (option.kind == OptionKind::numbers) continue;
      const auto parsed = parse_option(option, option.kind == OptionKind::text ? "" : readable(option.get()));
      EXPECT_TRUE(std::holds_alternative<OptionValue>(parsed)) << stage.name << "." << option.name;
    }
  }
}

TEST(Units, GuessedByTheDiagonal) {
  const BoundingBox bunny(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.15, 0.15, 0.12));
  const BoundingBox can(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(100, 190, 120));
  EXPECT_EQ(guess_units(bunny).name, "m");
  EXPECT_EQ(guess_units(can).name, "mm");
}

}  // namespace
}  // namespace drape::stages
