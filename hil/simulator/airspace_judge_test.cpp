// SPDX-License-Identifier: Apache-2.0
#include "airspace_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const AirspaceJudge::Limits kLimits{{2.0, 4.0}, 50.0, 0.5};

SeenBody body(std::uint16_t id, const Vec3& at) {
  SeenBody seen;
  seen.vehicle = VehicleId{id};
  seen.position_m = at;
  seen.airborne = true;
  return seen;
}

/// Two bodies that are seen at two moments.
struct Seen {
  Vec3 first_begin;
  Vec3 first_end;
  Vec3 second_begin;
  Vec3 second_end;
};

AirspaceJudge judged(const Seen& seen, bool airborne = true) {
  AirspaceJudge judge{kLimits};
  std::vector<SeenBody> begin{body(1, seen.first_begin), body(2, seen.second_begin)};
  std::vector<SeenBody> end{body(1, seen.first_end), body(2, seen.second_end)};
  begin[1].airborne = end[1].airborne = airborne;
  judge.step(begin, Instant{});
  judge.step(end, Instant{} + 20ms);
  return judge;
}

TEST(AirspaceJudge, SeesWhoPassBetweenTwoLooks) {
  // Each time 10 m apart, and half way through each other but for 1.5 m.
  const Seen through{{-5, 0, 20}, {5, 0, 20}, {5, 1.5, 20}, {-5, 1.5, 20}};
  AirspaceJudge judge = judged(through);
  EXPECT_NEAR(judge.least_m(), 1.5, 1e-9);
  const auto violations = judge.take();
  ASSERT_THAT(violations, SizeIs(1));
  EXPECT_THAT(violations[0].sentence, HasSubstr("1.50 m"));
  const Seen beside{{-5, 0, 20}, {5, 0, 20}, {5, 2.1, 20}, {-5, 2.1, 20}};
  EXPECT_THAT(judged(beside).take(), IsEmpty());
}

TEST(AirspaceJudge, LeavesAloneTwoThatNobodyFlies) {
  for (const bool both_unled : {true, false}) {
    for (const bool comes_down : {true, false}) {
      AirspaceJudge judge{kLimits};
      std::vector<SeenBody> bodies{body(1, {0, 0, 20}), body(2, {1.5, 0, 20})};
      bodies[0].unled = true;
      bodies[0].adrift = comes_down;
      bodies[1].unled = both_unled;
      judge.step(bodies, Instant{});
      judge.step(bodies, Instant{} + 20ms);
      EXPECT_THAT(judge.take(), SizeIs(both_unled && comes_down ? 0 : 1));
    }
  }
}

TEST(AirspaceJudge, WhoseProgramEndsBelowOneThatComesDownMightHaveLeft) {
  AirspaceJudge judge{kLimits};
  std::vector<SeenBody> bodies{body(1, {0, 0, 30}), body(2, {1.5, 0, 20})};
  bodies[0].unled = bodies[0].adrift = true;
  judge.step(bodies, Instant{});
  bodies[1].unled = true;
  judge.step(bodies, Instant{} + 20ms);
  bodies[0].position_m.z() = 20.0;
  judge.step(bodies, Instant{} + 40ms);
  EXPECT_THAT(judge.take(), SizeIs(1));
}

TEST(AirspaceJudge, WhoIsGivenBackBelowOneThatComesDownHasUntilItHasPassed) {
  AirspaceJudge judge{kLimits};
  std::vector<SeenBody> bodies{body(1, {0, 0, 20}), body(2, {1.5, 0, 20})};
  bodies[0].unled = bodies[0].adrift = bodies[1].unled = true;
  Instant now{};
  const auto step = [&] { judge.step(bodies, now += 20ms); };
  step();
  step();
  bodies[1].unled = false;
  step();
  EXPECT_THAT(judge.take(), IsEmpty());
  bodies[0].position_m.z() = 10.0;  // and then another comes
  step();
  step();
  bodies[0].position_m.z() = 20.0;
  step();
  step();
  EXPECT_THAT(judge.take(), SizeIs(1));
}

TEST(AirspaceJudge, CountsHeightsByTheirOwnMinimum) {
  const auto above = [](double by_m) {
    return Seen{{0, 0, 20}, {0, 0, 20}, {0, 0, 20 + by_m}, {0, 0, 20 + by_m}};
  };
  EXPECT_THAT(judged(above(3.9)).take(), SizeIs(1));
  EXPECT_THAT(judged(above(4.1)).take(), IsEmpty());
}

TEST(AirspaceJudge, WhoStandsOnTheGroundIsInNobodysWay) {
  const Seen near{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(judged(near).take(), SizeIs(1));
  EXPECT_THAT(judged(near, false).take(), IsEmpty());
}

TEST(AirspaceJudge, SeesWhoIsAboveTheCeiling) {
  const auto at = [](double height_m) {
    return Seen{{0, 0, height_m}, {0, 0, height_m}, {99, 0, 20}, {99, 0, 20}};
  };
  EXPECT_THAT(judged(at(50.4)).take(), IsEmpty()) << "as far as tracking allows for";
  const auto violations = judged(at(50.6)).take();
  ASSERT_THAT(violations, SizeIs(1)) << "told once";
  EXPECT_THAT(violations[0].sentence, HasSubstr("the ceiling is 50 m"));
}

}  // namespace
}  // namespace skein::hil
