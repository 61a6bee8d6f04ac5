// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/reexecution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "skein/configuration/vehicle_config.hpp"
#include "skein/onboard/node_config.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/recording/log.hpp"
#include "skein/recording/writer.hpp"

namespace skein::hil {
namespace {

using recording::Content;
using recording::Entry;
using ::testing::HasSubstr;

constexpr Instant kBegin{std::chrono::seconds{-2}};
constexpr Duration kStep = std::chrono::milliseconds{50};
constexpr VehicleId kOther{255};
constexpr const char* kProgram = "skein-onboard 1.0";

configuration::VehicleConfig config(std::uint16_t id) {
  configuration::VehicleConfig c;
  c.time.epoch_unix_ns = 1'700'000'000'000'000'000;
  c.vehicle.id = VehicleId{id};
  c.vehicle.cruise_speed_mps = 50.0;
  c.vehicle.speed_min_mps = 40.0;
  c.vehicle.speed_max_mps = 60.0;
  c.vehicle.turn_radius_m = 100.0;
  c.vehicle.range_m = 50000.0;
  c.vehicle.sensor_radius_m = 300.0;
  c.vehicle.assess_radius_m = 300.0;
  c.vehicle.final_approach_m = 300.0;
  c.vehicle.loads = 1;
  c.vehicle.height_m = 100.0 + 50.0 * id;
  for (const TaskKind kind : {TaskKind::survey, TaskKind::deliver, TaskKind::assess}) {
    c.vehicle.capabilities.add(kind);
  }
  c.start = {0.0, 400.0 * id, 0.3};
  c.search = {{6000.0, 400.0 * id}};
  c.network.port = static_cast<std::uint16_t>(17400 + 2 * id);
  return c;
}

/// A vehicle whose control is perfect: what onboard::AgentLoop does, in virtual time from before
/// the mission on, with the planner's work done at once.
class Vehicle {
 public:
  Vehicle(std::uint16_t id, const std::filesystem::path& folder)
      : config_{config(id)},
        instance_{1000U + id},
        node_{onboard::node_config(config_, std::nullopt, instance_, kProgram), kBegin},
        writer_{open(folder)} {
    note(recording::AgentStart{instance_, kProgram, kBegin});
  }

  void step(Instant now) {
    now_ = now;
    VehicleState state;
    const Pose2 pose = plan_ ? plan_->timed.pose_at(now) : config_.start;
    state.time = now;
    state.x_m = pose.x_m;
    state.y_m = pose.y_m;
    state.z_m = config_.vehicle.height_m;
    state.heading_rad = state.course_rad = pose.heading_rad;
    state.groundspeed_mps = state.airspeed_mps = 50.0;
    state.distance_flown_m = 50.0 * std::max(0.0, to_seconds(now));
    note(recording::StateGiven{state, now});
    node_.on_state(state, now);
    hand_out();
    for (; !inbox.empty(); inbox.pop_front()) {
      const auto& [message, sender] = inbox.front();
      if (sender == config_.vehicle.id) note(recording::NamesakeHeard{now});
      note(recording::MessageRecord{message, sender, now});
      node_.on_message(message, sender, now);
      hand_out();
    }
    while (!asked_.empty()) {
      const auto request = std::move(asked_.front());
      asked_.pop_front();
      mission::PlanningResult result{request.round,
                                     planning::allocate(request.params, request.problem),
                                     std::chrono::milliseconds{3}};
      note(recording::PlanningGiven{request.round, 0, result.took, now});
      node_.on_planning_result(result, now);
      hand_out();
    }
    for (; !notices.empty(); notices.pop_front()) {
      note(recording::NoticeGiven{notices.front(), now});
      node_.on_notice(notices.front(), now);
      hand_out();
    }
    if (now.time_since_epoch() % std::chrono::seconds{20} == Duration{}) {
      const mission::Condition condition{"GUIDED", overruns_, ++overruns_ / 3};
      note(recording::ConditionGiven{condition, now});
      node_.on_condition(condition);
      mission::Preflight checks;  // said beside the node
      checks.vehicle = config_.vehicle.id;
      note(recording::MessageRecord{mission::Message{checks}, config_.vehicle.id, now});
    }
    note(recording::TimeoutGiven{now});
    node_.on_timeout(now);
    hand_out();
  }

  std::deque<std::pair<mission::Message, VehicleId>> inbox;
  std::deque<mission::FlightNotice> notices;
  std::vector<mission::Message> outbox;

 private:
  [[nodiscard]] recording::Writer open(const std::filesystem::path& folder) const {
    recording::Writer::Options options;
    options.session.node = config_.vehicle.id;
    options.session.instance = instance_;
    options.session.configuration = to_yaml(config_);
    auto writer =
        recording::Writer::open(folder / recording::folder_name(config_.vehicle.id), options);
    EXPECT_TRUE(writer.ok());
    return std::move(writer).value();
  }
  void note(const recording::AgentRecord& record) { writer_.write(record); }
  void hand_out() {
    while (const auto guidance = node_.poll_guidance()) {
      plan_ = std::get<mission::FlightPlan>(*guidance);
      std::visit([this](const auto& made) { note(made); }, recording::made(*guidance, now_));
    }
    while (auto message = node_.poll_message()) {
      note(recording::MessageRecord{*message, config_.vehicle.id, now_});
      outbox.push_back(std::move(*message));
    }
    while (auto request = node_.poll_planning_request()) asked_.push_back(std::move(*request));
    while (node_.poll_event()) {
    }
  }

  configuration::VehicleConfig config_;
  InstanceId instance_;
  mission::VehicleNode node_;
  recording::Writer writer_;
  Instant now_{};
  std::uint64_t overruns_ = 0;
  std::optional<mission::FlightPlan> plan_;
  std::deque<mission::PlanningRequest> asked_;
};

/// Three vehicles find a site, agree on who does what, deliver and assess: 150 s.
void fly(const std::filesystem::path& folder) {
  std::vector<std::unique_ptr<Vehicle>> vehicles;
  for (std::uint16_t id = 1; id <= 3; ++id) {
    vehicles.push_back(std::make_unique<Vehicle>(id, folder));
  }
  Site site;
  site.id = SiteId{1};
  site.position = {2500.0, 800.0};
  site.deliveries = {{0.5, {}}};
  site.assessments.resize(1);
  for (Instant now = kBegin; now < at_seconds(150.0); now += kStep) {
    if (now == at_seconds(5.0)) {
      for (auto& v : vehicles)
        v->inbox.emplace_back(mission::SiteReport{VehicleId{1}, site}, kOther);
    }
    if (now == at_seconds(30.0)) {
      vehicles[0]->notices.push_back({now, true, {AutopilotNews::rebooted}});
      // Another node under its number, which it takes for no word of its own.
      mission::HazardReport hazard{{HazardId{7}, {-3000.0, -3000.0}, 50.0}};
      vehicles[1]->inbox.emplace_back(hazard, VehicleId{2});
      vehicles[2]->inbox.emplace_back(mission::Command{{3}, 1, mission::CommandKind::hold}, kOther);
    }
    if (now == at_seconds(140.0)) {
      vehicles[2]->notices.push_back({now, true, {AutopilotNews::mode_changed}});
    }
    for (auto& v : vehicles) v->step(now);
    for (std::size_t from = 0; from < vehicles.size(); ++from) {
      const VehicleId sender{static_cast<std::uint16_t>(from + 1)};
      for (const auto& message : vehicles[from]->outbox) {
        for (std::size_t to = 0; to < vehicles.size(); ++to) {
          if (to != from) vehicles[to]->inbox.emplace_back(message, sender);
        }
        if (const auto* request = std::get_if<mission::AuthorisationRequest>(&message)) {
          vehicles[from]->inbox.emplace_back(
              mission::Authorisation{request->round, request->site, true, "test", now},
              kGroundStation);
        }
      }
      vehicles[from]->outbox.clear();
    }
  }
}

std::filesystem::path g_flown;

class ReexecutionTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    g_flown =
        std::filesystem::temp_directory_path() / ("skein-rerun-" + std::to_string(::getpid()));
    fly(g_flown);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(g_flown); }

  /// The leader's recording, or another's, with some records changed: `change` may alter an entry,
  /// or say false to leave it out. The result of running that.
  static Result<Reexecution> altered(const std::function<bool(Entry&)>& change,
                                     const char* vehicle = "vehicle-01") {
    auto log = recording::Log::open(g_flown / vehicle);
    EXPECT_TRUE(log.ok());
    const auto folder = g_flown / "altered";
    {
      recording::Writer::Options options;
      options.session = log->sessions().front();
      auto writer = recording::Writer::open(folder, options);
      EXPECT_TRUE(writer.ok());
      log->for_each_written([&](Entry entry) {
        if (!change(entry)) return true;
        std::visit(
            [&]<class Record>(const Record& record) {
              if constexpr (std::is_same_v<Record, mission::Message>) {
                writer->write(record, entry.sender, entry.time);
              } else if constexpr (std::is_constructible_v<recording::AgentRecord, Record>) {
                writer->write(recording::AgentRecord{record});
              } else if constexpr (std::is_same_v<Record, recording::Gap>) {
                writer->write(record);
              }
            },
            entry.content);
        return true;
      });
    }
    auto result = reexecute(folder);
    std::filesystem::remove_all(folder);
    return result;
  }
};

TEST_F(ReexecutionTest, GivesWhatTheFlightGave) {
  std::uint64_t allocations = 0;
  for (const char* name : {"vehicle-01", "vehicle-02", "vehicle-03"}) {
    const auto result = reexecute(g_flown / name);
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result->difference, "") << name << " at " << to_seconds(result->differs_at);
    EXPECT_GT(result->inputs, 6000U);
    EXPECT_GT(result->plans, 0U);
    EXPECT_GT(result->messages, 450U);  // telemetry (2 Hz at least) and health (1 Hz) among them
    EXPECT_EQ(result->until, at_seconds(149.95));
    allocations += result->allocations;
  }
  EXPECT_GT(allocations, 0U);
}

TEST_F(ReexecutionTest, FindsAPlanThatIsNotTheAgents) {
  Instant at{};
  std::uint64_t count = 0;
  const auto result = altered([&](Entry& entry) {
    const auto* made = std::get_if<recording::PlanMade>(&entry.content);
    if (made == nullptr || ++count != 2) return true;
    auto plan = *made->plan;
    plan.timed.speed_mps += 1e-9;
    at = entry.time;
    entry.content = recording::PlanMade{std::make_shared<const mission::FlightPlan>(plan), at};
    return true;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->differs_at, at);
  EXPECT_THAT(result->difference, HasSubstr("recorded, and given now otherwise"));
  EXPECT_THAT(result->difference, HasSubstr("50.000000001"));
}

TEST_F(ReexecutionTest, FindsAMessageThatWasNeverGiven) {
  const auto result = altered([](Entry& entry) {
    const auto* message = std::get_if<mission::Message>(&entry.content);
    return message == nullptr || entry.sender != VehicleId{2} ||
           !std::holds_alternative<coalition::Message>(*message);
  });
  ASSERT_TRUE(result.ok());
  EXPECT_NE(result->difference, "");
}

TEST_F(ReexecutionTest, FindsAStateThatWasAnother) {
  const auto result = altered([](Entry& entry) {
    auto* given = std::get_if<recording::StateGiven>(&entry.content);
    if (given != nullptr && given->now == at_seconds(5.0)) given->state.x_m += 1e-6;
    return true;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_NE(result->difference, "");
  EXPECT_GE(result->differs_at, at_seconds(5.0));
}

/// A condition, a notice or a namesake's message that was not given.
TEST_F(ReexecutionTest, EveryKindOfInputCounts) {
  const auto without = [](const char* vehicle, auto is_it) {
    return altered(
        [&](Entry& entry) { return entry.time < at_seconds(20.0) || !is_it(entry.content); },
        vehicle);
  };
  const auto condition = without("vehicle-01", [](const Content& content) {
    return std::holds_alternative<recording::ConditionGiven>(content);
  });
  ASSERT_TRUE(condition.ok());
  EXPECT_THAT(condition->difference, HasSubstr("Telemetry"));
  const auto notice = without("vehicle-01", [](const Content& content) {
    return std::holds_alternative<recording::NoticeGiven>(content);
  });
  ASSERT_TRUE(notice.ok());
  EXPECT_THAT(notice->difference, HasSubstr("rebooted"));
  const auto namesake = without("vehicle-02", [](const Content& content) {
    return std::holds_alternative<recording::NamesakeHeard>(content);
  });
  ASSERT_TRUE(namesake.ok());
  EXPECT_THAT(namesake->difference, HasSubstr("HazardReport"));
}

TEST_F(ReexecutionTest, FindsAWordOfHealthThatWasAnother) {
  const auto result = altered([](Entry& entry) {
    auto* message = std::get_if<mission::Message>(&entry.content);
    if (message == nullptr || entry.sender != VehicleId{1}) return true;
    if (auto* health = std::get_if<mission::Health>(message)) health->mode = "GUIDE";
    return true;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(result->difference, HasSubstr("Health"));
}

TEST_F(ReexecutionTest, FindsWhatTheRecordingLacks) {
  bool left_out = false;
  const auto result = altered([&](Entry& entry) {
    const auto* message = std::get_if<mission::Message>(&entry.content);
    if (left_out || message == nullptr || entry.sender != VehicleId{1}) return true;
    left_out = true;
    return false;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_NE(result->difference, "");
}

TEST_F(ReexecutionTest, AGapEndsTheComparison) {
  bool told = false;
  auto log = recording::Log::open(g_flown / "vehicle-01");
  const auto result = altered([&](Entry& entry) {
    if (entry.time < at_seconds(100.0)) return true;
    if (!told) {
      entry.content = recording::Gap{7};
      told = true;
      return true;
    }
    return !std::holds_alternative<mission::Message>(entry.content);
  });
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->difference, "");
  ASSERT_TRUE(result->gap);
  EXPECT_LT(result->until, at_seconds(100.0));
  EXPECT_GT(result->until, at_seconds(98.0));
}

TEST_F(ReexecutionTest, ARecordingWithoutItsBeginningCannotBeRunAnew) {
  const auto result = altered([](Entry& entry) { return entry.time > at_seconds(10.0); });
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().message, HasSubstr("has given way to what came later"));
  EXPECT_FALSE(reexecute(g_flown / "vehicle-09").ok());
}

}  // namespace
}  // namespace skein::hil
