#include "drape/base/disjoint_sets.hpp"

#include <gtest/gtest.h>

namespace drape {
namespace {

TEST(DisjointSets, AreCalledByTheirLeastMemberInWhateverOrderJoined) {
  DisjointSets sets(6);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(sets.find(i), i);
  sets.join(5, 3);
  sets.join(4, 5);
  sets.join(1, 4);
  EXPECT_EQ(sets.find(0), 0U);
  EXPECT_EQ(sets.find(2), 2U);
  for (const std::uint32_t member : {1U, 3U, 4U, 5U}) EXPECT_EQ(sets.find(member), 1U);
}

}  // namespace
}  // namespace drape
