// SPDX-License-Identifier: Apache-2.0
#include "failsafe.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

using Action = Failsafe::Action;

TEST(Failsafe, LaterRulesTakePrecedence) {
  const Instant now = at_seconds(10.0);
  Failsafe failsafe;
  EXPECT_EQ(failsafe.update(now, {}), nullptr);
  EXPECT_EQ(failsafe.action(), Action::none);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::none);
  EXPECT_EQ(failsafe.update(now, {.id_in_use = true}), &Failsafe::kIdInUse);
  EXPECT_EQ(failsafe.update(now, {.id_in_use = true}), nullptr) << "it is news once";
  EXPECT_EQ(failsafe.action(), Action::take_up_nothing);
  EXPECT_EQ(failsafe.update(now, {.spare = Failsafe::Spare{true, 0.0}}), &Failsafe::kRangeSpent);
  EXPECT_EQ(failsafe.action(), Action::come_home);
  EXPECT_EQ(failsafe.update(now, {.order = CommandKind::hold}), &Failsafe::kHold);
  EXPECT_EQ(failsafe.action(), Action::obey);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::held_by_operator);
  EXPECT_EQ(failsafe.update(now, {.order = CommandKind::resume}), &Failsafe::kResume);
  EXPECT_EQ(failsafe.action(), Action::come_home) << "the range stays spent";
}

TEST(Failsafe, AFenceThatIsLeftIsNewsOnceUntilItMayGoOn) {
  Failsafe failsafe;
  EXPECT_EQ(failsafe.update({}, {.left_fence = true}), &Failsafe::kLeftFence);
  EXPECT_EQ(failsafe.action(), Action::come_home);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::outside_fence);
  EXPECT_EQ(failsafe.update({}, {.left_fence = true}), nullptr);
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::resume}), &Failsafe::kResume);
  EXPECT_EQ(failsafe.action(), Action::none);
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::hold}), &Failsafe::kHold);
  EXPECT_EQ(failsafe.update({}, {.left_fence = true}), nullptr) << "it is held by order";
  EXPECT_EQ(failsafe.action(), Action::obey);
}

TEST(Failsafe, WhoIsPilotedTakesNothingUpUntilItIsGivenBack) {
  Failsafe failsafe;
  EXPECT_EQ(failsafe.update({}, {.piloted = false}), nullptr) << "nobody had it";
  EXPECT_EQ(failsafe.update({}, {.piloted = true}), &Failsafe::kPiloted);
  EXPECT_EQ(failsafe.update({}, {.piloted = true}), nullptr);
  EXPECT_EQ(failsafe.action(), Action::stay);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::piloted);
  EXPECT_EQ(failsafe.update({}, {.bar = Bar::setup_differs}), &Failsafe::kPiloted);
  EXPECT_EQ(failsafe.update({}, {.bar = Bar::none}), nullptr) << "its pilot has it still";
  EXPECT_EQ(failsafe.update({}, {.piloted = false}), &Failsafe::kMayWork);
  EXPECT_EQ(failsafe.action(), Action::none);
}

TEST(Failsafe, WhatIsOrderedOrHappensMeanwhileStandsWhenItIsGivenBack) {
  Failsafe failsafe;
  failsafe.update({}, {.piloted = true});
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::hold}), &Failsafe::kHold);
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::resume}), &Failsafe::kPiloted);
  failsafe.update({}, {.order = CommandKind::return_home});
  EXPECT_EQ(failsafe.update({}, {.piloted = false}), nullptr);
  EXPECT_EQ(failsafe.action(), Action::obey);
  failsafe.update({}, {.order = CommandKind::resume});
  failsafe.update({}, {.piloted = true});
  failsafe.update({}, {.left_fence = true});
  EXPECT_EQ(failsafe.update({}, {.piloted = false}), &Failsafe::kLeftFence);
}

TEST(Failsafe, EveryOrderIsObeyedAtOnce) {
  Failsafe failsafe;
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::hold}), &Failsafe::kHold);
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::return_home}), &Failsafe::kReturnHome);
  EXPECT_EQ(failsafe.update({}, {.order = CommandKind::give_back}), nullptr);
  EXPECT_EQ(failsafe.action(), Action::obey);
}

TEST(Failsafe, ABarredPathEndsTheTaskAndNothingElse) {
  Failsafe failsafe;
  const auto* response = failsafe.update({}, {.path_barred = true});
  ASSERT_EQ(response, &Failsafe::kPathBarred);
  EXPECT_EQ(response->lead, Failsafe::Lead::kept);
  EXPECT_EQ(failsafe.action(), Action::none);
}

TEST(Failsafe, LooksAtTheRangeAsRarelyAsItCanMatter) {
  Failsafe failsafe;
  EXPECT_TRUE(failsafe.wants_range(at_seconds(0.0)));
  EXPECT_EQ(failsafe.update(at_seconds(0.0), {.spare = Failsafe::Spare{false, 60.0}}), nullptr);
  EXPECT_FALSE(failsafe.wants_range(at_seconds(59.9)));
  EXPECT_TRUE(failsafe.wants_range(at_seconds(60.0)));
  failsafe.look_again(at_seconds(5.0));
  EXPECT_TRUE(failsafe.wants_range(at_seconds(5.0)));
  EXPECT_EQ(failsafe.update(at_seconds(5.0), {.spare = Failsafe::Spare{false, -10.0}}), nullptr);
  EXPECT_FALSE(failsafe.wants_range(at_seconds(5.9))) << "but not at every step";
  EXPECT_EQ(failsafe.update(at_seconds(6.0), {.spare = Failsafe::Spare{true, -20.0}}),
            &Failsafe::kRangeSpent);
  EXPECT_FALSE(failsafe.wants_range(at_seconds(100.0))) << "spent is spent";
  EXPECT_EQ(failsafe.update(at_seconds(100.0), {.spare = Failsafe::Spare{false, 50.0}}), nullptr);
  EXPECT_TRUE(failsafe.facts().range_spent);
}

}  // namespace
}  // namespace skein::mission
