// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/agent_loop.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <limits>
#include <memory>
#include <semaphore>
#include <thread>
#include <vector>

#include "skein/mission/vehicle_agent.hpp"
#include "skein/onboard/threads.hpp"

namespace skein::onboard {
namespace {

mission::VehicleAgentConfig config() {
  mission::VehicleAgentConfig c;
  c.vehicle.id = {4};
  c.vehicle.cruise_speed_mps = 50.0;
  c.vehicle.speed_min_mps = 40.0;
  c.vehicle.speed_max_mps = 60.0;
  c.vehicle.turn_radius_m = 100.0;
  c.vehicle.range_m = 50000.0;
  c.vehicle.sensor_radius_m = 300.0;
  c.vehicle.assess_radius_m = 300.0;
  c.vehicle.capabilities.add(TaskKind::survey);
  c.instance = {99};
  c.search = {{3000.0, 0.0}};
  return c;
}

std::unique_ptr<mission::OnboardAgent> agent() {
  return std::make_unique<mission::VehicleAgent>(config(), at_seconds(-5.0));
}

struct Cabin {
  AgentLink link() {
    return {.receive = [this]() -> std::optional<AgentLink::Received> {
              if (inbox.empty()) return std::nullopt;
              auto first = std::move(inbox.front());
              inbox.pop_front();
              return first;
            },
            .send = [this](const mission::Message& message) { sent.push_back(message); },
            .dropped = [] { return std::uint64_t{3}; }};
  }
  template <class T>
  std::vector<T> sent_of() const {
    std::vector<T> found;
    for (const auto& message : sent) {
      if (const auto* wanted = std::get_if<T>(&message)) found.push_back(*wanted);
    }
    return found;
  }
  void step(double seconds) {
    control.state.write(
        VehicleState{.time = at_seconds(seconds), .groundspeed_mps = 50.0, .airspeed_mps = 50.0});
    loop.step(at_seconds(seconds));
  }

  std::deque<AgentLink::Received> inbox;
  std::vector<mission::Message> sent;
  ControlPorts control;
  Planner planner{[] {}};
  EventRing events;
  AgentLoop loop{agent(), {4}, link(), control, planner, events, at_seconds(-5.0)};
};

TEST(AgentLoop, IsOnTheNetworkBeforeTheMissionButDoesNotFly) {
  Cabin cabin;
  for (int i = 0; i < 98; ++i) cabin.step(-5.0 + 0.05 * i);
  EXPECT_NEAR(static_cast<double>(cabin.sent_of<mission::Telemetry>().size()), 49.0, 2.0);
  EXPECT_EQ(cabin.control.guidance.read(), nullptr);
  cabin.step(0.05);
  EXPECT_NE(cabin.control.guidance.read(), nullptr);  // the search begins
}

TEST(AgentLoop, TelemetryCarriesStateAndHealth) {
  Cabin cabin;
  cabin.control.overruns = 7;
  cabin.step(1.0);
  const auto telemetry = cabin.sent_of<mission::Telemetry>();
  ASSERT_EQ(telemetry.size(), 1U);
  EXPECT_EQ(telemetry[0].vehicle, VehicleId{4});
  EXPECT_EQ(telemetry[0].instance, InstanceId{99});
  EXPECT_EQ(telemetry[0].state.time, at_seconds(1.0));
  EXPECT_EQ(telemetry[0].control_overruns, 7U);
  EXPECT_EQ(telemetry[0].messages_dropped, 3U);
}

TEST(AgentLoop, NextStepIsSoonButNeverAtOnce) {
  Cabin cabin;
  for (int i = 0; i < 100; ++i) {
    const double now = 0.013 * i;
    cabin.step(now);
    EXPECT_GT(cabin.loop.next_step(), at_seconds(now));
    EXPECT_LE(cabin.loop.next_step(), at_seconds(now) + spec_of(ThreadRole::agent).period);
  }
}

TEST(AgentLoop, AFloodOfMessagesIsTakenInPortions) {
  Cabin cabin;
  for (int i = 0; i < 1000; ++i) cabin.inbox.push_back({mission::HazardReport{}, {2}});
  cabin.step(1.0);
  EXPECT_EQ(cabin.inbox.size(), 1000U - AgentLoop::kMessagesPerStep);
}

TEST(AgentLoop, PassesTheOperatorsCommandsOnOnceEachAndAsTheyWere) {
  Cabin cabin;
  std::vector<mission::Command> heard;
  AgentLink link = cabin.link();
  link.on_command = [&heard](const mission::Command& command) { heard.push_back(command); };
  AgentLoop loop{agent(), {4}, link, cabin.control, cabin.planner, cabin.events, at_seconds(-5.0)};
  using mission::CommandKind;
  for (const auto& command : {mission::Command{{4}, 10, CommandKind::give_back},
                              mission::Command{{4}, 10, CommandKind::give_back},
                              mission::Command{{5}, 11, CommandKind::give_back},
                              mission::Command{kGroundStation, 12, CommandKind::resume}}) {
    cabin.inbox.push_back({command, kGroundStation});
  }
  loop.step(at_seconds(1.0));
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0].kind, CommandKind::give_back);
  EXPECT_EQ(heard[0].vehicle, VehicleId{4});
  EXPECT_EQ(heard[1].vehicle, kGroundStation);
}

TEST(Planner, AnswersRequestsUntilStopped) {
  std::counting_semaphore<> ready{0};
  Planner planner{[&] { ready.release(); }};
  std::thread thread{[&] { planner.run(); }};
  mission::PlanningRequest request;
  request.round.number = 5;
  ASSERT_TRUE(planner.request(request));
  ready.acquire();
  const auto result = planner.result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->round.number, 5U);
  EXPECT_FALSE(planner.result());
  planner.stop();
  thread.join();
}

/// A colony that would go on for ever, one vehicle, and a clock that moves when it is asked.
TEST(Planner, EndsAPlanInTimeForItsAnswer) {
  std::counting_semaphore<> ready{0};
  Instant now{};
  Planner planner{[&] { ready.release(); }, [&now] { return now += std::chrono::milliseconds{1}; }};
  mission::PlanningRequest request;
  request.answer_by = at_seconds(0.5);
  request.params.method = planning::AllocationMethod::colony;
  request.params.colony.generations = std::numeric_limits<int>::max();
  auto& problem = request.problem;
  problem.site.deliveries = {{0.0, {}}};
  problem.open_tasks = problem.site.tasks_after_survey();
  planning::Candidate candidate;
  candidate.id = VehicleId{1};
  candidate.pose = {-3000.0, 0.0, 0.0};
  candidate.speed_mps = 50.0;
  candidate.planning_radius_m = 165.0;
  candidate.range_left_m = 18000.0;
  candidate.final_approach_m = 300.0;
  candidate.capabilities.add(TaskKind::deliver);
  candidate.loads = 1;
  problem.candidates = {candidate};
  std::thread thread{[&] { planner.run(); }};
  ASSERT_TRUE(planner.request(request));
  ready.acquire();
  const auto result = planner.result();
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->allocation.ok());
  planner.stop();
  thread.join();
  EXPECT_GE(now, request.answer_by - Planner::kAnswerMargin);
  EXPECT_LT(now, request.answer_by);
}

TEST(Planner, RefusesWhatItCannotHold) {
  Planner planner{[] {}};
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(planner.request({}));
  EXPECT_FALSE(planner.request({}));
  EXPECT_EQ(planner.dropped(), 1U);
}

}  // namespace
}  // namespace skein::onboard
