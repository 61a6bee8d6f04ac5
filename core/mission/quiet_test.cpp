// SPDX-License-Identifier: Apache-2.0
// Who steps a vehicle only where it is not quiet (OnboardAgent::quiet_until()) gets the same from
// it, byte for byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "agent_parts_test.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/vehicle_node.hpp"

namespace skein::mission {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 40ms;
constexpr std::uint16_t kVehicles = 5;

/// Exactly where its plan has it.
class Vehicle {
 public:
  Vehicle(std::uint16_t number, bool rests)
      : rests_{rests},
        start_{-300.0 * number, 150.0 * number, 0.0},
        node_{config(number), Instant{-1s}} {}

  void step(Instant now) {
    untold_ = state(now);
    if (rests_ && now < quiet_until_) return;
    tell();
    drain(now);
  }
  void hear(const Message& message, VehicleId sender, Instant now) {
    tell();
    node_.on_message(message, sender, now);
    drain(now);
  }
  void plan(Instant now) {
    for (const PlanningRequest& request : std::exchange(requests_, {})) {
      tell();
      node_.on_planning_result(
          {request.round, planning::allocate(request.params, request.problem), {}}, now);
      drain(now);
    }
  }
  [[nodiscard]] std::vector<Message> take_said() { return std::exchange(said_, {}); }

  std::size_t steps = 0;
  std::vector<MissionEvent> events;
  std::vector<FlightPlan> plans;

 private:
  static VehicleNodeConfig config(std::uint16_t number) {
    VehicleAgentConfig agent = plane_config();
    agent.vehicle.id = {number};
    agent.instance = {number};
    agent.search = {{2000.0, 400.0 * number}};
    if (number == kVehicles) agent.vehicle.range_m = 5000.0;
    return {.agent = agent, .program = "test", .flight_controller = "none"};
  }
  [[nodiscard]] VehicleState state(Instant now) {
    const double flown_s = std::max(0.0, to_seconds(now));
    const Pose2 pose = plans.empty() ? start_ : plans.back().timed.pose_at(now);
    VehicleState state;
    state.time = now;
    state.x_m = pose.x_m;
    state.y_m = pose.y_m;
    state.heading_rad = state.course_rad = pose.heading_rad;
    state.groundspeed_mps = state.airspeed_mps = kTestSpeed_mps;
    state.distance_flown_m = flown_s * kTestSpeed_mps;
    // One has a battery, which lasts for half of what its configuration says.
    if (node_.vehicle() == VehicleId{3}) {
      state.battery_percent = static_cast<std::uint8_t>(45.0 - state.distance_flown_m / 250.0);
    }
    return state;
  }
  void tell() {
    if (!untold_) return;
    node_.on_state(*untold_, untold_->time);
    untold_.reset();
    ++steps;
  }
  void drain(Instant now) {
    while (auto message = node_.poll_message()) said_.push_back(std::move(*message));
    while (auto event = node_.poll_event()) events.push_back(std::move(*event));
    while (auto guidance = node_.poll_guidance()) plans.push_back(std::get<FlightPlan>(*guidance));
    while (auto request = node_.poll_planning_request()) requests_.push_back(std::move(*request));
    quiet_until_ = node_.quiet_until(now);
  }

  bool rests_;
  Pose2 start_;
  VehicleNode node_;
  Instant quiet_until_ = Instant::min();
  std::optional<VehicleState> untold_;
  std::vector<Message> said_;
  std::vector<PlanningRequest> requests_;
};

/// Who said what kind of message when.
struct Word {
  Instant at;
  VehicleId from;
  std::size_t kind = 0;
  friend bool operator==(const Word&, const Word&) = default;
};

bool same_event(const MissionEvent& a, const MissionEvent& b) {
  return a.time == b.time && a.round == b.round && a.task == b.task && a.body == b.body;
}

bool same_plan(const FlightPlan& a, const FlightPlan& b) {
  return a.number == b.number && a.timed.start_time == b.timed.start_time &&
         a.timed.path.length_m() == b.timed.path.length_m();
}

/// What is said comes to all others at the next tick; the ground station grants what is asked.
class Team {
 public:
  explicit Team(bool rests) {
    for (std::uint16_t n = 1; n <= kVehicles; ++n) vehicles.emplace_back(n, rests);
  }
  void tell(const Message& message, VehicleId sender) { air_.emplace_back(message, sender); }
  void fly_until(Instant until) {
    for (; now < until; now += kTick) tick();
  }
  [[nodiscard]] std::size_t steps() const {
    std::size_t all = 0;
    for (const Vehicle& vehicle : vehicles) all += vehicle.steps;
    return all;
  }
  [[nodiscard]] bool saw(EventKind kind) const {
    return std::ranges::any_of(vehicles, [kind](const Vehicle& vehicle) {
      return std::ranges::any_of(vehicle.events,
                                 [kind](const MissionEvent& e) { return e.kind() == kind; });
    });
  }

  Instant now{-1s};
  std::vector<Vehicle> vehicles;
  std::vector<Word> said;

 private:
  void tick() {
    for (const auto& [message, sender] : std::exchange(air_, {})) {
      for (std::uint16_t n = 1; n <= kVehicles; ++n) {
        if (sender != VehicleId{n}) vehicles[n - 1U].hear(message, sender, now);
      }
    }
    for (std::uint16_t n = 1; n <= kVehicles; ++n) {
      Vehicle& vehicle = vehicles[n - 1U];
      vehicle.plan(now);
      vehicle.step(now);
      for (const Message& message : vehicle.take_said()) say(message, VehicleId{n});
    }
  }
  void say(const Message& message, VehicleId sender) {
    if (const auto* asked = std::get_if<AuthorisationRequest>(&message)) {
      tell(Authorisation{asked->round, asked->site, true, "test", now, {}, {}, {}}, kGroundStation);
    }
    said.push_back({now, sender, message.index()});
    // That of others changes nothing but by their separation, which is not looked at here.
    if (!std::holds_alternative<Telemetry>(message)) tell(message, sender);
  }
  std::vector<std::pair<Message, VehicleId>> air_;
};

void fly_mission(Team& team) {
  team.fly_until(at_seconds(5.0));
  team.tell(SiteReport{VehicleId{1}, test_site(1)}, kSensors);
  team.fly_until(at_seconds(20.0));
  team.tell(HazardReport{{HazardId{1}, {900.0, 500.0}, 60.0}}, kGroundStation);
  team.fly_until(at_seconds(45.0));
  team.tell(Command{VehicleId{4}, 10, CommandKind::hold}, kGroundStation);
  team.fly_until(at_seconds(60.0));
  team.tell(Command{VehicleId{4}, 20, CommandKind::resume}, kGroundStation);
  team.fly_until(at_seconds(240.0));
}

TEST(Quiet, WhoIsLeftToRestSaysAndFliesTheSame) {
  Team all{false};
  Team rests{true};
  fly_mission(all);
  fly_mission(rests);
  EXPECT_EQ(all.said, rests.said);
  for (std::size_t i = 0; i < kVehicles; ++i) {
    EXPECT_TRUE(std::ranges::equal(all.vehicles[i].events, rests.vehicles[i].events, same_event));
    EXPECT_TRUE(std::ranges::equal(all.vehicles[i].plans, rests.vehicles[i].plans, same_plan));
  }
  EXPECT_LT(2 * rests.steps(), all.steps());
  for (const EventKind kind :
       {EventKind::survey_done, EventKind::coalition_formed, EventKind::task_started,
        EventKind::site_done, EventKind::range_spent, EventKind::commanded}) {
    EXPECT_TRUE(all.saw(kind)) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace skein::mission
