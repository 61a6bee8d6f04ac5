// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/formation_agent.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace skein::mission {
namespace {

constexpr VehicleId kSelf{3};

/// A copter that is where it began, or where it is put.
struct Copter {
  explicit Copter(const formation::MotionLimits& limits = {}) {
    FormationAgentConfig config;
    config.vehicle = kSelf;
    config.limits = limits;
    agent = std::make_unique<FormationAgent>(config, now);
    put({0.0, 0.0, 10.0});
  }
  void put(const Vec3& place) {
    VehicleState state;
    state.time = now;
    state.x_m = place.x();
    state.y_m = place.y();
    state.z_m = place.z();
    agent->on_state(state, now);
    while (const auto message = agent->poll_message()) {
      if (const auto* said = std::get_if<FormationStatus>(&*message)) status = *said;
    }
    while (const auto given = agent->poll_guidance()) track = std::get<MotionTrack>(*given);
  }
  /// Where its track has it.
  void fly(double seconds) {
    for (const Instant until = now + from_seconds(seconds); now < until;) {
      now += formation::kSlot;
      put(track ? track->at(now).position_m : Vec3{0.0, 0.0, 10.0});
    }
  }
  void is_beside(VehicleId other, const Vec3& place, double off_m) const {
    FormationStatus said;
    said.vehicle = other;
    said.position_m = place;
    said.progress.off_m = off_m;
    agent->on_message(said, other, now);
  }
  void tell(const Message& message) const { agent->on_message(message, kGroundStation, now); }
  [[nodiscard]] std::vector<MissionEvent> events() const {
    std::vector<MissionEvent> all;
    while (auto event = agent->poll_event()) all.push_back(*event);
    return all;
  }

  Instant now = at_seconds(1.0);
  std::unique_ptr<FormationAgent> agent;
  FormationStatus status;
  std::optional<MotionTrack> track;
};

formation::Change ahead(std::uint32_t number) {
  formation::Change change;
  change.number = number;
  change.start = at_seconds(2.0);
  change.movers = {{kSelf, {{0.0, 0.0, 10.0}, {20.0, 0.0, 10.0}}, 0}};
  return change;
}

TEST(FormationAgent, SaysWhichCommandsItHasTaken) {
  Copter copter;
  copter.tell(Command{kSelf, 10, CommandKind::hold});
  copter.tell(Command{kSelf, 10, CommandKind::hold});  // sent again
  copter.tell(Command{kSelf, 11, CommandKind::return_home});
  copter.tell(Command{kSelf, 12, CommandKind::resume});
  const auto events = copter.events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].body, EventBody{event::Commanded{CommandKind::hold}});
  EXPECT_EQ(events[1].body, EventBody{event::Commanded{CommandKind::resume}});
}

TEST(FormationAgent, RefusesAChangeThatIsTooFastInAnyDerivative) {
  formation::Change change = ahead(1);
  for (double* const limit :
       {&change.limits.speed_mps, &change.limits.acceleration_mps2, &change.limits.jerk_mps3}) {
    Copter copter;
    const double was = *limit;
    *limit *= 1.01;
    copter.tell(change);
    *limit = was;
    const auto events = copter.events();
    ASSERT_EQ(events.size(), 1U);
    const auto* refused = std::get_if<event::ChangeRefused>(&events[0].body);
    ASSERT_NE(refused, nullptr);
    EXPECT_EQ(refused->why, event::ChangeRefusal::too_fast);
  }
  Copter copter;
  copter.tell(change);
  EXPECT_EQ(copter.events().back().kind(), EventKind::change_taken_up);
}

TEST(FormationAgent, TakesUpNoChangeWhoseTimesCannotBeCounted) {
  std::vector<formation::Change> bad(3, ahead(1));
  bad[0].limits.speed_mps = 1e-300;
  bad[1].limits.jerk_mps3 = 1e-300;
  bad[2].roundabout = formation::Roundabout{{-10.0, 0.0}, 1e-300};
  bad[2].movers[0].level = 1;
  for (const formation::Change& change : bad) {
    Copter copter;
    copter.tell(change);
    EXPECT_TRUE(copter.events().empty());
    EXPECT_EQ(copter.agent->counters().bad_messages, 1U);
  }
}

TEST(FormationAgent, WhomItsPilotHasTakesUpNothingAndRestsWhereItIsGivenBack) {
  Copter copter;
  copter.tell(ahead(1));
  copter.fly(4.0);
  copter.agent->on_piloted(true, copter.now);
  EXPECT_EQ(copter.agent->telemetry().detail, ActivityDetail::piloted);
  EXPECT_EQ(copter.agent->telemetry().activity, Activity::holding);
  copter.fly(3.0);
  EXPECT_TRUE(copter.status.at_rest);
  EXPECT_LT(copter.status.reference_m.x(), 19.0) << "it stops on its way";
  copter.fly(5.0);
  EXPECT_EQ(copter.events().back().kind(), EventKind::change_taken_up) << "it waits for nobody";
  const Vec3 there{5.0, 7.0, 12.0};
  copter.tell(ahead(2));
  const auto refused = copter.events();
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(std::get<event::ChangeRefused>(refused.front().body).why,
            event::ChangeRefusal::obeys_others);

  copter.now += formation::kSlot;
  copter.put(there);
  EXPECT_GT(copter.status.progress.off_m, 5.0);
  copter.agent->on_piloted(false, copter.now);
  copter.now += formation::kSlot;
  copter.put(there);
  EXPECT_EQ(copter.status.progress.change, 0U) << "of none that is flown";
  EXPECT_LT(copter.status.progress.off_m, 1e-9);
  EXPECT_LT((copter.track->at(copter.now + std::chrono::minutes{1}).position_m - there).norm(),
            1e-9);
  copter.tell(ahead(1));
  EXPECT_TRUE(copter.events().empty()) << "what it has flown is not flown again";
  formation::Change back = ahead(3);
  back.movers.front().points.front() = there;
  copter.tell(back);
  EXPECT_EQ(copter.events().back().kind(), EventKind::change_taken_up);
  copter.fly(60.0);
  EXPECT_LT((copter.status.reference_m - back.movers.front().points.back()).norm(), 1e-9);
}

TEST(FormationAgent, WhomItsPilotHadBeforeAnyChangeRestsWhereItIsGivenBack) {
  Copter copter;
  copter.agent->on_piloted(true, copter.now);
  copter.now += formation::kSlot;
  copter.put({30.0, 0.0, 10.0});
  EXPECT_NEAR(copter.status.progress.off_m, 30.0, 1e-9) << "of where it was taken";
  copter.agent->on_piloted(false, copter.now);
  copter.fly(1.0);
  EXPECT_NEAR(copter.status.position_m.x(), 30.0, 1e-9);
  EXPECT_NEAR(copter.status.progress.off_m, 0.0, 1e-9);
}

TEST(FormationAgent, StopsBeforeWhoIsOffWhatItFollowsUntilThatIsElsewhere) {
  Copter copter;
  const formation::Change change = ahead(1);
  copter.tell(change);
  copter.fly(2.0);
  const Vec3 on_its_way{10.0, 0.5, 10.0};
  copter.is_beside({4}, on_its_way, 2.0);
  copter.fly(30.0);
  const double apart_m = (copter.status.position_m - on_its_way).norm();
  const double of_vehicles_m = change.separation.horizontal_m - 1.0;  // without what both are off
  EXPECT_GE(apart_m, of_vehicles_m);
  EXPECT_LT(apart_m, of_vehicles_m + 2.0);
  const auto told = copter.events();
  const auto* waits = std::get_if<event::Waiting>(&told.back().body);
  ASSERT_NE(waits, nullptr);
  EXPECT_EQ(waits->vehicle, VehicleId{4});
  copter.is_beside({4}, on_its_way, 0.1);
  copter.fly(30.0);
  EXPECT_LT(copter.status.position_m.x(), 8.0) << "it rests there, and flies nothing";
  copter.is_beside({4}, {10.0, 9.0, 10.0}, 0.1);
  copter.fly(30.0);
  EXPECT_NEAR(copter.status.position_m.x(), 20.0, 1e-6);
}

TEST(FormationAgent, LeavesWhoIsNearAndOffWhatItFollows) {
  Copter copter;
  copter.is_beside({4}, {-1.0, 0.0, 10.0}, 2.0);
  copter.tell(ahead(1));
  copter.fly(60.0);
  EXPECT_NEAR(copter.status.position_m.x(), 20.0, 1e-6);
}

}  // namespace
}  // namespace skein::mission
