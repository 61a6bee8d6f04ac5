// SPDX-License-Identifier: Apache-2.0
#include "skein/series/run_row.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "skein/shards/csv.hpp"

namespace skein::series {
namespace {

using ::testing::HasSubstr;

RunRow odd() {
  RunRow row;
  row.seed = 18446744073709551615U;
  row.ended_s = 0.1 + 0.2;
  row.broken = {{"leases", 3, 12.34, VehicleId{7}, "U7 says: \"a|b\", \\n, or\nnot"},
                {"ta|ken, back", 1, 1.0 / 3.0, kGroundStation, ""}};
  return row;
}

/// What is read again from a line of a file.
RunRow again(const RunRow& row, bool formation) {
  const std::string line = shards::csv_line(row_fields(row, formation));
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto fields = shards::csv_fields(line.substr(0, line.size() - 1));
  EXPECT_EQ(fields.size(), row_columns(formation).size());
  const auto read = parse_row(fields, formation);
  EXPECT_TRUE(read) << read.error().message;
  return *read;
}

TEST(RunRows, OfSitesReadBackAsTheyWere) {
  RunRow row = odd();
  row.excused = 4;
  EXPECT_EQ(again(row, false), row);
  RunRow held;
  held.seed = 1;
  held.done = true;
  held.ended_s = 156.5;
  EXPECT_EQ(again(held, false), held);
  EXPECT_EQ(shards::csv_line(row_fields(held, false)), "1,1,156.5,,0\n");
}

TEST(RunRows, OfFormationsReadBackAsTheyWere) {
  RunRow row = odd();
  row.least_m = 2.0000000000000004;
  row.lost = 2;
  row.reason = "U1: no place; \"why\", |\nU2";
  EXPECT_EQ(again(row, true), row);
  row.least_m = std::numeric_limits<double>::infinity();
  row.reason = "";
  row.broken.clear();
  EXPECT_EQ(again(row, true), row);
}

TEST(RunRows, SayWhatIsNone) {
  const auto problem = [](const std::vector<std::string>& fields, bool formation) {
    const auto row = parse_row(fields, formation);
    return row ? std::string{"none"} : row.error().message;
  };
  EXPECT_EQ(problem({"1", "1", "156.5", "", "0"}, false), "none");
  EXPECT_EQ(problem({"x", "1", "156.5", "", "0"}, false), "has no seed");
  EXPECT_THAT(problem({"1", "yes", "156.5", "", "0"}, false), HasSubstr("\"yes\""));
  EXPECT_THAT(problem({"1", "1", "", "", "0"}, false), HasSubstr("\"\""));
  EXPECT_THAT(problem({"1", "1", "156.5", "leases|1", "0"}, false), HasSubstr("leases|1"));
  EXPECT_THAT(problem({"1", "1", "156.5", "leases|1|0.5|-2|s", "0"}, false), HasSubstr("|-2|"));
  EXPECT_THAT(problem({"1", "1", "156.5", "", "-1"}, false), HasSubstr("\"-1\""));
  EXPECT_EQ(problem({"1", "1", "156.5", "", "2.5", "0", ""}, true), "none");
  EXPECT_THAT(problem({"1", "1", "156.5", "", "near", "0", ""}, true), HasSubstr("near"));
  EXPECT_THAT(problem({"1", "1", "156.5", "", "2.5", "all", ""}, true), HasSubstr("all"));
}

TEST(RunRows, HoldTheFirstViolationOfEachCheck) {
  hil::JudgedRun run;
  run.seed = 5;
  run.result.ended_at = at_seconds(100.0);
  run.broken = {{"leases",
                 "",
                 1,
                 "",
                 "",
                 {{VehicleId{1}, at_seconds(3.0), "twice"}, {VehicleId{2}, {}, "again"}}}};
  run.excused.resize(2);
  const RunRow row = row_of(run);
  EXPECT_FALSE(row.held());
  EXPECT_EQ(row.excused, 2U);
  EXPECT_EQ(row.ended_s, 100.0);
  ASSERT_EQ(row.broken.size(), 1U);
  EXPECT_EQ(row.broken[0], (Broken{"leases", 2, 3.0, VehicleId{1}, "twice"}));
}

}  // namespace
}  // namespace skein::series
