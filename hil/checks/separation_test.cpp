// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "skein/base/random.hpp"
#include "test_record.hpp"

namespace skein::checks {
namespace {

using namespace checks::testing;  // most of it: NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;

/// Straight flight at constant velocity, `rate_hz` points a second.
recording::Recording straight(VehicleId id, const Vec2& start, const Vec2& velocity,
                              double height_m, double climb_mps, double until_s,
                              double rate_hz = 20.0, double offset_s = 0.0) {
  recording::Recording recorded;
  recorded.vehicle = id;
  for (int i = 0; offset_s + i / rate_hz <= until_s; ++i) {
    const double t = offset_s + i / rate_hz;
    recording::TrackPoint point;
    point.state.time = at_seconds(t);
    const Vec2 here = start + t * velocity;
    point.state.x_m = here.x();
    point.state.y_m = here.y();
    point.state.z_m = height_m + t * climb_mps;
    recorded.track.push_back(point);
  }
  return recorded;
}

RunRecord pair_of(recording::Recording a, recording::Recording b) {
  RunRecord record;
  record.recordings = {std::move(a), std::move(b)};
  return record;
}

TEST(Separation, AHeadOnMeetingIsFoundAtItsNearest) {
  // They pass at 10.03 s, between the points of both tracks and of the grid.
  const auto record =
      pair_of(straight(kFromWest, {-601.8, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
              straight(kFromSouth, {601.8, 12.0}, {-60.0, 0.0}, 305.0, 0.0, 20.0, 20.0, 0.013));
  const std::string sentence = only_sentence(check_separation(record, {}));
  EXPECT_THAT(sentence, HasSubstr("came at 10.03 s within 12.0 m horizontally and 5.0 m vert"));
}

/// Whenever it is: at the end of what is looked at together, and at the end of the tracks.
TEST(Separation, EveryStepOfTheFlightIsJudged) {
  for (const double meets_s : {9.85, 9.95, 10.05, 19.95}) {
    const double away_m = 60.0 * meets_s;
    // In one layer for a tenth of a second only, as they pass.
    const double rate_mps = 400.0;
    const auto record = pair_of(straight(kFromWest, {-away_m, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
                                straight(kFromSouth, {away_m, 0.0}, {-60.0, 0.0},
                                         300.0 - rate_mps * meets_s, rate_mps, 20.0));
    EXPECT_FALSE(check_separation(record, {}).held()) << meets_s;
  }
}

TEST(Separation, HeightOrDistanceIsEnough) {
  const auto meeting = [](double height, double beside) {
    return pair_of(straight(kFromWest, {-600.0, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
                   straight(kFromSouth, {600.0, beside}, {-60.0, 0.0}, height, 0.0, 20.0));
  };
  EXPECT_TRUE(check_separation(meeting(320.1, 0.0), {}).held());
  EXPECT_FALSE(check_separation(meeting(319.9, 0.0), {}).held());
  EXPECT_TRUE(check_separation(meeting(300.0, 30.1), {}).held());
  EXPECT_FALSE(check_separation(meeting(300.0, 29.9), {}).held());
}

TEST(Separation, TheNearestPassHasItsMomentWhereTheLimitIsKept) {
  const auto record = pair_of(straight(kFromWest, {-600.0, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
                              straight(kFromSouth, {600.0, 40.0}, {-60.0, 0.0}, 300.0, 0.0, 20.0));
  const CheckResult result = check_separation(record, {});
  EXPECT_TRUE(result.held());
  ASSERT_TRUE(result.moment);
  EXPECT_NEAR(to_seconds(*result.moment), 10.0, 0.05);
  const auto apart = pair_of(straight(kFromWest, {-600.0, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
                             straight(kFromSouth, {600.0, 0.0}, {-60.0, 0.0}, 500.0, 0.0, 20.0));
  EXPECT_FALSE(check_separation(apart, {}).moment);  // never in one layer
}

TEST(Separation, AClimbThroughAnotherAtADistanceInTimeIsNone) {
  // Horizontally together at 10 s, vertically only from 16 s on.
  const auto record = pair_of(straight(kFromWest, {-600.0, 0.0}, {60.0, 0.0}, 300.0, 0.0, 20.0),
                              straight(kFromSouth, {600.0, 0.0}, {-60.0, 0.0}, 400.0, -5.0, 20.0));
  EXPECT_TRUE(check_separation(record, {}).held());
}

TEST(Separation, OneEncounterIsOneViolation) {
  const auto record = pair_of(straight(kFromWest, {0.0, 0.0}, {50.0, 0.0}, 300.0, 0.0, 60.0),
                              straight(kFromSouth, {-10.0, 0.0}, {50.3, 0.0}, 300.0, 0.0, 60.0));
  EXPECT_THAT(only_sentence(check_separation(record, {})), HasSubstr("within 0.0 m"));
}

TEST(Separation, ThirtyTwoVehiclesAreJudgedQuickly) {
  Random random{4};
  RunRecord record;
  for (unsigned i = 1; i <= 32; ++i) {
    const Vec2 start{random.uniform(0.0, 5000.0), random.uniform(0.0, 5000.0)};
    record.recordings.push_back(straight(VehicleId{static_cast<std::uint16_t>(i)}, start,
                                         50.0 * unit_vector(random.uniform(-kPi, kPi)),
                                         300.0 + 100.0 * (i % 3), 0.0, 250.0));
  }
  const auto begin = std::chrono::steady_clock::now();
  const CheckResult result = check_separation(record, {});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(result.judged, 496U);
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_LT(took.count(), 2.0);
}

}  // namespace
}  // namespace skein::checks
