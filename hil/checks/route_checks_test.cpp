// SPDX-License-Identifier: Apache-2.0
#include "test_record.hpp"

namespace skein::checks::testing {
namespace {

using ::testing::HasSubstr;

/// The two deliverers of the good record pass over the site at 60 s, eastward and northward.
RunRecord routes() {
  RunRecord record = good_record();
  const Vec2 site = record.sites.front().position;
  record.route_ends = {{kFromWest, site, 0.0, at_seconds(60.0)},
                       {kFromSouth, site, kPi / 2.0, at_seconds(60.0)}};
  return record;
}

TEST(RouteChecks, AGoodRecordHolds) {
  const CheckResult result = check_routes(routes(), {});
  EXPECT_TRUE(result.held());
  EXPECT_EQ(result.judged, 2U);
  EXPECT_EQ(result.measured, "spread 0.00 s, worst 0.0 m, 0.0 deg");
}

TEST(RouteChecks, ASpreadIsFoundAndACommonDelayIsNone) {
  RunRecord record = routes();
  delay(of(record, kFromWest), 1.2);
  EXPECT_THAT(only_sentence(check_routes(record, {})), HasSubstr("1.20 s apart"));
  delay(of(record, kFromSouth), 1.2);
  EXPECT_TRUE(check_routes(record, {}).held());
}

TEST(RouteChecks, APlanThatIsNotTogetherIsFoundAndOffsetsAreKept) {
  RunRecord record = routes();
  delay(of(record, kFromSouth), 5.0);
  record.route_ends[1].planned = at_seconds(65.0);  // as planned, and too late
  EXPECT_THAT(only_sentence(check_routes(record, {})), HasSubstr("5.00 s apart"));
  record.route_ends[1].offset = std::chrono::seconds{5};
  EXPECT_TRUE(check_routes(record, {}).held());
}

TEST(RouteChecks, AMissABearingAndAMissingTrackAreFound) {
  RunRecord record = routes();
  shift(of(record, kFromSouth), {31.0, 0.0});
  EXPECT_THAT(only_sentence(check_routes(record, {})), HasSubstr("31.0 m from the site"));
  record = routes();
  record.route_ends.front().heading_rad = radians(6.0);
  EXPECT_THAT(only_sentence(check_routes(record, {})), HasSubstr("6.0 deg off its bearing"));
  record = routes();
  of(record, kFromWest).track.resize(900);
  EXPECT_THAT(only_sentence(check_routes(record, {})), HasSubstr("the track does not show it"));
}

}  // namespace
}  // namespace skein::checks::testing
