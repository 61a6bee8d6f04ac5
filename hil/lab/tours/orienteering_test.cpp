// SPDX-License-Identifier: Apache-2.0
#include "skein/tours/orienteering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace skein::planning {
namespace {

using ::testing::HasSubstr;

// Two go from (0, 0) to (10, 0) in 12 s: one over (5, 3), the other over what lies on the way.
constexpr const char* kInstance =
    "n 6\nm 2\ntmax 12.0\n"
    "0.0\t0.0\t0\n"
    "5.0\t3.0\t30\n"
    "3.0\t0.0\t5\n"
    "7.0\t0.0\t5\n"
    "5.0\t-9.0\t90\n"
    "10.0\t0.0\t0\n";

TEST(Orienteering, TheBestTeamLeavesOutWhatIsTooFar) {
  const auto problem = parse_orienteering(kInstance, "p");
  ASSERT_TRUE(problem.ok()) << problem.error().message;
  EXPECT_EQ(score_of(*problem), 130.0);
  const auto plan = branch_and_bound(*problem, {});
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  EXPECT_TRUE(plan->proven);
  EXPECT_EQ(score_of(*problem, *plan), 40.0);
  EXPECT_NEAR(plan->objective * score_of(*problem), 40.0, 1e-9);
  ASSERT_EQ(plan->left_out.size(), 1U);
  EXPECT_EQ(plan->left_out.front(), SiteId{4});
}

TEST(Orienteering, SaysWhichLineIsWrong) {
  const auto why = [](const std::string& text) {
    const auto problem = parse_orienteering(text, "p");
    return problem ? std::string{} : problem.error().message;
  };
  EXPECT_THAT(why("m 2\n"), HasSubstr("p:1: 'n NUMBER'"));
  EXPECT_THAT(why("n 3\nm 1\ntmax 5\n0 0 0\n1 1\n"), HasSubstr("p:5: a place is three numbers"));
  EXPECT_THAT(why("n 3\nm 1\ntmax 5\n0 0 0\n1 1 1\n"), HasSubstr("p:6: a place"));
  EXPECT_THAT(why("n 131\nm 1\ntmax 5\n"), HasSubstr("130 places"));
}

}  // namespace
}  // namespace skein::planning
