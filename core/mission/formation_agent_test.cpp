// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/formation_agent.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace skein::mission {
namespace {

constexpr VehicleId kSelf{3};

/// A copter that is where it began.
struct Copter {
  explicit Copter(const formation::MotionLimits& limits = {}) {
    FormationAgentConfig config;
    config.vehicle = kSelf;
    config.limits = limits;
    agent = std::make_unique<FormationAgent>(config, now);
    VehicleState state;
    state.time = now;
    state.z_m = 10.0;
    agent->on_state(state, now);
  }
  void tell(const Message& message) const { agent->on_message(message, kGroundStation, now); }
  [[nodiscard]] std::vector<MissionEvent> events() const {
    std::vector<MissionEvent> all;
    while (auto event = agent->poll_event()) all.push_back(*event);
    return all;
  }

  Instant now = at_seconds(1.0);
  std::unique_ptr<FormationAgent> agent;
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

}  // namespace
}  // namespace skein::mission
