// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/agent_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "skein/onboard/threads.hpp"

namespace skein::onboard {
namespace {

mission::VehicleNodeConfig config() {
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
  return {.agent = c, .program = "skein-onboard 1.0", .flight_controller = "simulated"};
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
  AgentLoop loop{config(), link(), control, planner, events, at_seconds(-5.0)};
};

TEST(AgentLoop, HandsGuidanceToControlAndMessagesToTheNetwork) {
  Cabin cabin;
  for (int i = 0; i < 98; ++i) cabin.step(-5.0 + 0.05 * i);
  EXPECT_FALSE(cabin.sent_of<mission::Telemetry>().empty());
  EXPECT_EQ(cabin.control.guidance.read(), nullptr);
  cabin.step(0.05);
  EXPECT_NE(cabin.control.guidance.read(), nullptr);  // the search begins
}

TEST(AgentLoop, TelemetryCarriesStateAndWhatWasLost) {
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

/// It costs locks and copies, and steps come up to 50 times a second.
TEST(AgentLoop, AsksForTheConditionOnlyWhenItIsTold) {
  Cabin cabin;
  AgentLink link = cabin.link();
  int asked = 0;
  link.mode = [&asked] { return "GUIDED " + std::to_string(++asked); };
  AgentLoop loop{config(), link, cabin.control, cabin.planner, cabin.events, at_seconds(0.0)};
  for (int i = 0; i < 100; ++i) {
    const Instant now = at_seconds(0.02 * i);
    cabin.control.state.write(VehicleState{.time = now});
    loop.step(now);
  }
  const auto told = cabin.sent_of<mission::Health>();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].mode, "GUIDED 1");
  EXPECT_EQ(told[1].mode, "GUIDED 3");  // telemetry: twice a second
  EXPECT_EQ(asked, 4);
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

TEST(AgentLoop, CarriesNoticesModeAndTheGivingBackOfTheAircraft) {
  Cabin cabin;
  AgentLink link = cabin.link();
  std::deque<mission::FlightNotice> notices{{at_seconds(0.5), true, {AutopilotNews::rebooted}}};
  link.notice = [&notices]() -> std::optional<mission::FlightNotice> {
    if (notices.empty()) return std::nullopt;
    auto first = std::move(notices.front());
    notices.pop_front();
    return first;
  };
  link.mode = [] { return std::string{"LOITER, piloted"}; };
  std::vector<Instant> given_back;
  link.give_back = [&given_back](Instant issued) { given_back.push_back(issued); };
  std::vector<recording::AgentRecord> records;
  link.record = [&records](recording::AgentRecord record) { records.push_back(std::move(record)); };
  AgentLoop loop{config(), link, cabin.control, cabin.planner, cabin.events, at_seconds(-5.0)};
  cabin.inbox.push_back({mission::Command{{4}, 10, mission::CommandKind::give_back}, {}});
  loop.step(at_seconds(1.0));
  EXPECT_EQ(given_back, std::vector{at_seconds(0.009)});
  const auto events = cabin.sent_of<mission::MissionEvent>();
  ASSERT_FALSE(events.empty());
  const mission::EventBody rebooted = mission::event::FlightWarning{{AutopilotNews::rebooted}};
  EXPECT_EQ(events.back().body, rebooted);
  ASSERT_EQ(cabin.sent_of<mission::Health>().size(), 1U);
  EXPECT_EQ(cabin.sent_of<mission::Health>()[0].mode, "LOITER, piloted");
  const auto recorded = [&records]<class Record>(const Record& /*like*/) {
    return std::count_if(records.begin(), records.end(),
                         [](const auto& r) { return std::holds_alternative<Record>(r); });
  };
  EXPECT_EQ(recorded(recording::NoticeGiven{}), 1);
  EXPECT_EQ(recorded(recording::ConditionGiven{}), 1);
  loop.step(at_seconds(1.1));
  EXPECT_EQ(recorded(recording::ConditionGiven{}), 1);  // the same
  EXPECT_EQ(recorded(recording::TimeoutGiven{}), 2);
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
  problem.open_tasks = tasks_after_survey(problem.site);
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
