// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "outbox.hpp"
#include "ownship.hpp"
#include "skein/base/angles.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::mission {

inline constexpr double kTestSpeed_mps = 25.0;
inline constexpr double kFlownStep_s = 0.5;

/// A plane that can do everything, near the origin, with much room and range.
[[nodiscard]] inline VehicleAgentConfig plane_config() {
  VehicleAgentConfig config;
  config.instance = {9};
  config.search = {{2000.0, 0.0}};
  config.protocol.radio_range_m = 5000.0;
  VehicleSpec& vehicle = config.vehicle;
  vehicle.id = {4};
  vehicle.cruise_speed_mps = kTestSpeed_mps;
  vehicle.speed_min_mps = 20.0;
  vehicle.speed_max_mps = 30.0;
  vehicle.turn_radius_m = 60.0;
  vehicle.range_m = 50'000.0;
  vehicle.sensor_radius_m = vehicle.assess_radius_m = vehicle.final_approach_m = 100.0;
  vehicle.loads = 1;
  vehicle.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
  return config;
}

/// With one delivery, to the north.
[[nodiscard]] inline Site test_site(std::uint16_t id) {
  Site site;
  site.id = {id};
  site.position = {600.0, 300.0};
  site.survey.dwell = std::chrono::seconds{4};
  site.deliveries.push_back({kPi / 2.0, {}});
  return site;
}

/// How often that was told.
[[nodiscard]] inline std::ptrdiff_t count_trouble(const std::vector<MissionEvent>& events,
                                                  event::Trouble trouble) {
  return std::ranges::count_if(events, [trouble](const MissionEvent& e) {
    const auto* body = std::get_if<event::VehicleTrouble>(&e.body);
    return body != nullptr && body->trouble == trouble;
  });
}

/// An agent, what it flies, and what it has reported.
struct HeardAgent {
  HeardAgent(const VehicleAgentConfig& config, Instant now) : agent{config, now} {}

  void see(const VehicleState& state) {
    agent.on_state(state, state.time);
    collect();
  }
  void tell(const Message& message, Instant now) {
    agent.on_message(message, kGroundStation, now);
    collect();
  }

  VehicleAgent agent;
  FlightPlan plan;
  std::vector<MissionEvent> events;

 private:
  void collect() {
    while (auto next = agent.poll_guidance()) plan = std::get<FlightPlan>(*next);
    while (auto event = agent.poll_event()) events.push_back(*event);
    while (agent.poll_message()) {
    }
  }
};

/// At kTestSpeed_mps over the ground.
inline void move_in_wind(VehicleState& state, double course_rad, const Vec2& wind_mps) {
  const Vec2 through_air = kTestSpeed_mps * unit_vector(course_rad) - wind_mps;
  state.course_rad = course_rad;
  state.heading_rad = std::atan2(through_air.y(), through_air.x());
  state.groundspeed_mps = kTestSpeed_mps;
  state.airspeed_mps = through_air.norm();
}

/// A plane that is exactly where its plan has it, or so far beside.
class FlownAgent : public HeardAgent {
 public:
  explicit FlownAgent(const VehicleAgentConfig& config)
      : HeardAgent{config, Instant{}}, height_m_{config.vehicle.height_m} {
    fly(0.0);
  }
  void fly(double seconds) {
    for (const double end = now_s_ + seconds; now_s_ <= end; now_s_ += kFlownStep_s) {
      const Instant now = at_seconds(now_s_);
      const Pose2 pose = plan.number > 0 ? plan.timed.pose_at(now) : Pose2{0.0, 0.0, 0.3};
      state.time = now;
      state.x_m = pose.x_m + beside_m.x();
      state.y_m = pose.y_m + beside_m.y();
      state.z_m = height_m_;
      move_in_wind(state, pose.heading_rad, wind_mps);
      state.distance_flown_m += kTestSpeed_mps * kFlownStep_s;
      see(state);
    }
  }
  void order(CommandKind kind) {
    Command command{.vehicle = {4}, .kind = kind};
    set_number(command, ++orders_);
    HeardAgent::tell(command, at_seconds(now_s_));
  }

  void be_piloted(bool piloted) { agent.on_piloted(piloted, at_seconds(now_s_)); }

  void tell(const Message& message) { HeardAgent::tell(message, at_seconds(now_s_)); }
  /// Why it does not; what it flies from then on is known with its next state.
  std::string keep(const Fence& fence) { return agent.keep_fence(fence, at_seconds(now_s_)); }

  VehicleState state;
  Vec2 beside_m{0.0, 0.0};
  Vec2 wind_mps{0.0, 0.0};

 private:
  double height_m_;
  double now_s_ = 0.0;
  std::uint64_t orders_ = 0;
};

/// What a part of an agent needs around it: a vehicle that is exactly where its plan has it, or so
/// far beside.
struct PartsBench {
  explicit PartsBench(const VehicleAgentConfig& config = plane_config())
      : ownship{config}, outbox{config.vehicle.id} {
    be_at(0.0);
  }

  void be_at(double seconds) {
    now = at_seconds(seconds);
    VehicleState state;
    state.time = now;
    const Pose2 pose = ownship.flight().started() ? ownship.flight().pose_at(now) : Pose2{};
    state.x_m = pose.x_m + beside_m.x();
    state.y_m = pose.y_m + beside_m.y();
    move_in_wind(state, pose.heading_rad, wind_mps);
    state.distance_flown_m = seconds * kTestSpeed_mps;
    (void)ownship.measures_wind(state);
    ownship.on_state(state, now);
  }

  /// How often that was reported since the last call of it.
  [[nodiscard]] int reported(EventKind kind) {
    while (auto event = outbox.events.pop()) kinds.push_back(event->kind());
    return static_cast<int>(std::erase(kinds, kind));
  }
  /// The first message of that type that was sent since the last call; older ones are dropped.
  template <class T>
  [[nodiscard]] std::optional<T> sent() {
    std::optional<T> found;
    while (auto message = outbox.messages.pop()) {
      if (const auto* wanted = std::get_if<T>(&*message); wanted != nullptr && !found) {
        found = *wanted;
      }
    }
    return found;
  }

  Vec2 wind_mps{0.0, 0.0};
  Vec2 beside_m{0.0, 0.0};  ///< of where its plan has it
  Instant now{};
  Ownship ownship;
  Outbox outbox;
  std::vector<EventKind> kinds;
};

}  // namespace skein::mission
