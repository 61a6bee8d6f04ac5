// SPDX-License-Identifier: Apache-2.0
#include "skein/series/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace skein::series {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

shards::Series series(const char* kind) {
  shards::Series series;
  series.kind = kind;
  series.file = "s.yaml";
  series.faults = "mixed";
  if (series.kind == kSites) series.plan = "plan.yaml";
  series.separation_m = 2.5;
  return series;
}

TEST(Summaries, CountRunsOfSites) {
  Summary summary{series(kSites), "hil"};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RunRow row;
    row.seed = seed;
    row.done = seed < 3;
    row.ended_s = 10.0 * static_cast<double>(seed);
    if (seed == 3) row.broken = {{"leases", 2, 3.0, VehicleId{1}, "twice"}};
    if (seed == 2) row.excused = 4;
    summary.add(row);
  }
  EXPECT_FALSE(summary.held());
  EXPECT_EQ(summary.text(),
            "seed 3 VIOLATED\n"
            "  leases: 3.00 s, U1: twice (and 1 more)\n"
            "  again: hil simulate s.yaml --seed 3 --faults mixed --routes plan.yaml --trace\n"
            "runs       3, seeds 1 to 3\n"
            "violated   1; leases 1\n"
            "excused    4 in 1 runs, proven unavoidable: seeds 2\n"
            "all sites  done in 2 runs, after 10.0 s at least, 15.0 s on average, 20.0 s at most\n"
            "FAIL\n");
}

TEST(Summaries, CountRunsOfFormations) {
  Summary summary{series(kFormation), "hil"};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RunRow row;
    row.seed = seed;
    row.done = seed == 1;
    row.ended_s = 100.0;
    row.least_m = 5.0 - static_cast<double>(seed);
    row.lost = 1;
    if (!row.done)
      row.reason = "U" + std::to_string(seed) + " is " + std::to_string(9 * seed) + " m off";
    if (seed == 4)
      row.broken = {{"separation", 1, 3.0, {}, "U1 and U2"}, {"ceiling", 1, 4.0, {}, "U1"}};
    summary.add(row);
  }
  EXPECT_EQ(summary.text(),
            "seed 4 VIOLATED\n"
            "  separation: 3.00 s, U1 and U2\n"
            "  ceiling: 4.00 s, U1\n"
            "  again: hil simulate s.yaml --seed 4 --faults mixed --trace\n"
            "runs       4, seeds 1 to 4, 100 s of mission time each on average\n"
            "violated   1\n"
            "separation 1.00 m at least; 2.5 m are wanted\n"
            "lost       4 vehicles\n"
            "script     done in 1 runs\n"
            "held       3: U# is # m off\n"
            "FAIL\n");
}

TEST(Summaries, ShowTheFirstFailuresAndCountTheOthers) {
  for (const char* kind : {kSites, kFormation}) {
    Summary summary{series(kind), "hil"};
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      RunRow row;
      row.seed = seed;
      row.excused = 1;
      row.broken = {{"leases", 1, 3.0, VehicleId{1}, "twice"}};
      summary.add(row);
    }
    const std::string text = summary.text();
    EXPECT_THAT(text, StartsWith("seed 1 VIOLATED\n"));
    EXPECT_THAT(text, HasSubstr("seed 20 VIOLATED\n"));
    EXPECT_THAT(text, Not(HasSubstr("seed 21 VIOLATED\n")));
    EXPECT_THAT(text, HasSubstr("... and 5 seeds more\n"));
    if (kind == kSites) {
      EXPECT_THAT(text, HasSubstr(", 20, ...\nall sites  done in 0 runs\n"));
    }
    EXPECT_THAT(text, EndsWith("FAIL\n"));
  }
}

}  // namespace
}  // namespace skein::series
