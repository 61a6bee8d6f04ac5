// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_simulator.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

#include "skein/base/random.hpp"
#include "skein/hil/survey_sensors.hpp"
#include "skein/models/heading_dynamics.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::hil {
namespace {

constexpr Duration kControlPeriod = std::chrono::milliseconds{20};
constexpr Duration kAgentPeriod = std::chrono::milliseconds{40};
constexpr Duration kSensorPeriod = std::chrono::milliseconds{100};
constexpr Duration kTelemetryPeriod = std::chrono::milliseconds{200};
constexpr Duration kTrackPeriod = std::chrono::milliseconds{100};
constexpr Duration kAfterwards = std::chrono::seconds{5};

/// A moment's work on its way: earlier first, and in the order of making at one moment.
struct Delivery {
  Instant at{};
  std::uint64_t order = 0;
  std::size_t to = 0;  ///< index of the vehicle; vehicles.size() is the ground station
  VehicleId from;
  std::variant<mission::Message, mission::PlanningResult> what;
  friend bool operator>(const Delivery& a, const Delivery& b) {
    return std::tie(a.at, a.order) > std::tie(b.at, b.order);
  }
};

struct Vehicle {
  VehicleSpec spec;
  std::unique_ptr<mission::VehicleAgent> agent;
  models::HeadingDynamics dynamics;
  mission::FlightPlan plan;
};

class Team {
 public:
  Team(const TeamMission& mission, const TeamObserver& observer)
      : mission_{mission},
        observer_{observer},
        random_{mission.seed},
        sensors_{mission.sites, specs(mission)},
        ground_{ground_config(mission), Instant{}} {
    const models::Wind wind{mission.wind};
    for (const auto& v : mission.vehicles) {
      mission::VehicleAgentConfig config;
      config.vehicle = v.spec;
      config.instance = InstanceId{v.spec.id.value};
      config.protocol = mission.protocol;
      config.planning = mission.planning;
      config.search = v.search;
      for (const auto& h : mission.hazards) {
        if (h.known_from <= Instant{}) config.hazards.push_back(h.hazard);
      }
      auto agent = std::make_unique<mission::VehicleAgent>(config, Instant{});
      models::HeadingDynamics dynamics{v.spec, wind, v.start, Instant{}};
      vehicles_.push_back(Vehicle{v.spec, std::move(agent), dynamics, {}});
    }
  }

  TeamResult run() {
    const Instant last = Instant{} + mission_.duration_max;
    std::optional<Instant> stop_at;
    for (Instant now{}; now <= stop_at.value_or(last); now += kControlPeriod) {
      deliver(now);
      control(now);
      if (due(now, kSensorPeriod)) sense(now);
      if (due(now, kAgentPeriod)) step_agents(now);
      result_.ended_at = now;
      if (!stop_at && result_.sites_done == mission_.sites.size())
        stop_at = std::min(last, now + kAfterwards);
    }
    for (const auto& v : vehicles_)
      result_.protocol_errors += v.agent->counters().at("protocol_errors");
    return result_;
  }

 private:
  static std::vector<VehicleSpec> specs(const TeamMission& mission) {
    std::vector<VehicleSpec> all;
    for (const auto& v : mission.vehicles) all.push_back(v.spec);
    return all;
  }
  static mission::GroundAgentConfig ground_config(const TeamMission& mission) {
    mission::GroundAgentConfig config;
    for (const auto& v : mission.vehicles) config.expected.push_back(v.spec.id);
    config.decisions = mission.decisions;
    return config;
  }
  static bool due(Instant now, Duration period) {
    return now.time_since_epoch() % period == Duration::zero();
  }
  [[nodiscard]] std::size_t ground_index() const { return vehicles_.size(); }

  void deliver(Instant now) {
    while (!queue_.empty() && queue_.top().at <= now) {
      const Delivery d = queue_.top();
      queue_.pop();
      if (d.to == ground_index()) {
        ground_.on_message(std::get<mission::Message>(d.what), d.from, now);
        drain_ground(now);
        continue;
      }
      auto& vehicle = vehicles_[d.to];
      if (const auto* planned = std::get_if<mission::PlanningResult>(&d.what)) {
        vehicle.agent->on_planning_result(*planned, now);
      } else {
        vehicle.agent->on_message(std::get<mission::Message>(d.what), d.from, now);
      }
      drain(d.to, now);
    }
  }

  void control(Instant now) {
    for (auto& v : vehicles_) {
      v.dynamics.advance_to(now);
      if (v.plan.number > 0) {
        v.dynamics.command(
            planning::follow_path({}, v.spec, v.plan.timed, v.dynamics.state(), now));
        if (due(now, kTrackPeriod) && observer_.track) {
          observer_.track(v.spec.id, v.dynamics.state(), v.plan);
        }
      }
    }
  }

  void sense(Instant now) {
    std::map<VehicleId, Vec2> positions;
    for (const auto& v : vehicles_)
      positions[v.spec.id] = v.dynamics.state().position().horizontal();
    for (const auto& report : sensors_.update(positions)) {
      for (std::size_t i = 0; i < vehicles_.size(); ++i) {
        if (vehicles_[i].spec.id == report.finder) hand_over(now, i, mission::Message{report});
      }
    }
    for (const auto& h : mission_.hazards) {
      if (h.known_from <= Instant{} || h.known_from > now || !told_.insert(h.hazard.id).second)
        continue;
      for (std::size_t i = 0; i < vehicles_.size(); ++i) {
        hand_over(now, i, mission::Message{mission::HazardReport{h.hazard}});
      }
    }
  }

  void step_agents(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      vehicles_[i].agent->on_state(vehicles_[i].dynamics.state(), now);
      drain(i, now);
      if (due(now, kTelemetryPeriod))
        broadcast(i, mission::Message{vehicles_[i].agent->telemetry()}, now);
    }
    ground_.on_timeout(now);
    drain_ground(now);
  }

  void drain(std::size_t i, Instant now) {
    auto& v = vehicles_[i];
    while (const auto message = v.agent->poll_message()) {
      ++result_.messages;
      broadcast(i, *message, now);
    }
    while (const auto event = v.agent->poll_event()) {
      if (event->kind == mission::EventKind::site_done) ++result_.sites_done;
      if (observer_.event) observer_.event(*event);
    }
    while (const auto plan = v.agent->poll_plan()) {
      v.plan = *plan;
      if (observer_.plan) observer_.plan(v.spec.id, *plan, now);
    }
    while (const auto request = v.agent->poll_planning_request()) {
      const mission::PlanningResult planned{request->round,
                                            planning::allocate(request->params, request->problem),
                                            mission_.allocation_takes};
      queue_.push({now + mission_.allocation_takes, order_++, i, v.spec.id, planned});
    }
  }

  void drain_ground(Instant now) {
    while (const auto message = ground_.poll_message()) {
      for (std::size_t i = 0; i < vehicles_.size(); ++i) post(now, i, kGroundStation, *message);
    }
    while (const auto event = ground_.poll_event()) {
      // Those of the vehicles have been seen at their source.
      if (event->vehicle == kGroundStation && observer_.event) observer_.event(*event);
    }
  }

  void broadcast(std::size_t from, const mission::Message& message, Instant now) {
    const auto& sender = vehicles_[from];
    post(now, ground_index(), sender.spec.id, message);
    const Vec2 here = sender.dynamics.state().position().horizontal();
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (i == from) continue;
      const Vec2 there = vehicles_[i].dynamics.state().position().horizontal();
      if ((there - here).norm() <= mission_.radio.range_m) post(now, i, sender.spec.id, message);
    }
  }

  /// From a sensor on board: no radio lies between.
  void hand_over(Instant now, std::size_t to, const mission::Message& message) {
    queue_.push({now, order_++, to, vehicles_[to].spec.id, message});
  }

  void post(Instant now, std::size_t to, VehicleId from, const mission::Message& message) {
    if (random_.chance(mission_.radio.loss)) return;
    const double jitter = random_.uniform(-1.0, 1.0) * to_seconds(mission_.radio.jitter);
    const Duration delay = std::max(Duration{}, mission_.radio.delay + from_seconds(jitter));
    queue_.push({now + delay, order_++, to, from, message});
  }

  const TeamMission& mission_;
  const TeamObserver& observer_;
  Random random_;
  SurveySensors sensors_;
  mission::GroundAgent ground_;
  std::vector<Vehicle> vehicles_;
  std::priority_queue<Delivery, std::vector<Delivery>, std::greater<>> queue_;
  std::uint64_t order_ = 0;
  std::set<HazardId> told_;
  TeamResult result_;
};

}  // namespace

TeamResult simulate_team(const TeamMission& mission, const TeamObserver& observer) {
  return Team{mission, observer}.run();
}

std::string trace_line(const mission::MissionEvent& event) {
  std::array<char, 160> head{};
  std::snprintf(head.data(), head.size(), "%12.6f  %3u  %-23.*s  %u.%u/%u  ",
                to_seconds(event.time), static_cast<unsigned>(event.vehicle.value),
                static_cast<int>(to_string(event.kind).size()), to_string(event.kind).data(),
                static_cast<unsigned>(event.round.coalition.leader.value),
                event.round.coalition.number, event.round.number);
  std::array<char, 48> value{};
  std::snprintf(value.data(), value.size(), "  %.6f  ", event.value);
  return head.data() + to_string(event.task) + value.data() + event.text;
}

}  // namespace skein::hil
