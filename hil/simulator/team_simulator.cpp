// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_simulator.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "flying_vehicle.hpp"
#include "in_flight.hpp"
#include "radio_channel.hpp"
#include "site_finder.hpp"

namespace skein::hil {
namespace {

constexpr Duration kControlPeriod = std::chrono::milliseconds{20};
constexpr Duration kAgentPeriod = std::chrono::milliseconds{40};
constexpr Duration kSensorPeriod = std::chrono::milliseconds{100};
constexpr Duration kTelemetryPeriod = std::chrono::milliseconds{200};
constexpr Duration kTrackPeriod = std::chrono::milliseconds{100};
constexpr Duration kAfterwards = std::chrono::seconds{5};
/// How long the track of a vehicle goes on that nobody hears of any more: what it has just done can
/// be judged.
constexpr Duration kSeenWhenGone = std::chrono::seconds{2};

bool due(Instant now, Duration period) {
  return now.time_since_epoch() % period == Duration::zero();
}

mission::GroundAgentConfig ground_config(const TeamMission& mission) {
  mission::GroundAgentConfig config;
  for (const auto& v : mission.vehicles) config.expected.push_back(v.spec.id);
  config.decisions = mission.decisions;
  return config;
}

bool has_role(const mission::VehicleAgent& agent, Crash::Role role) {
  using mission::Activity;
  const Activity activity = agent.activity();
  switch (role) {
    case Crash::Role::any:
      return true;
    case Crash::Role::leader:
      return activity == Activity::leading || activity == Activity::monitoring;
    case Crash::Role::member:
      return activity == Activity::executing || activity == Activity::bidding;
  }
  return false;
}

/// A crash of the schedule on its way.
struct ComingCrash {
  Crash crash;
  std::optional<std::size_t> victim;
  Instant at{};
  bool over = false;
};

class Team {
 public:
  Team(const TeamMission& mission, const TeamObserver& observer)
      : mission_{mission},
        observer_{observer},
        air_{kControlPeriod},
        radio_{mission, air_},
        finder_{mission},
        ground_{ground_config(mission), Instant{}} {
    const models::Wind wind{mission.wind};
    for (const auto& v : mission.vehicles) {
      vehicles_.emplace_back(mission, v, wind);
      nodes_.push_back({v.spec.id, Vec2{0.0, 0.0}, false});
    }
    nodes_.push_back({kGroundStation, Vec2{0.0, 0.0}, true});
    restart_at_.resize(vehicles_.size());
    gone_at_.resize(vehicles_.size());
    for (const Crash& crash : mission.faults.crashes) crashes_.push_back({crash, {}, {}, false});
    for (const auto& h : mission.hazards) {
      if (h.known_from <= Instant{}) hazards_.push_back(h.hazard);
    }
    take_off(Instant{});
  }

  TeamResult run() {
    const Instant last = Instant{} + mission_.duration_max;
    std::optional<Instant> stop_at;
    for (Instant now{}; now <= stop_at.value_or(last); now += kControlPeriod) {
      if (mission_.faults.any()) play_faults(now);
      deliver(now);
      control(now);
      if (due(now, kSensorPeriod)) sense(now);
      if (due(now, kAgentPeriod)) step_agents(now);
      result_.ended_at = now;
      if (!stop_at && sites_over_.size() == mission_.sites.size()) {
        stop_at = std::min(last, std::max(now, mission_.faults.healed_at) + kAfterwards);
      }
    }
    result_.sites_done = sites_done_.size();
    for (std::size_t i = 0; i < vehicles_.size(); ++i) sum_up(i);
    return result_;
  }

 private:
  [[nodiscard]] std::size_t ground_index() const { return vehicles_.size(); }

  // --- faults ---

  void tell(Instant now, FaultEvent::Kind kind, VehicleId vehicle, std::string text = {}) const {
    if (observer_.fault) observer_.fault({now, kind, vehicle, std::move(text)});
  }

  void play_faults(Instant now) {
    const FaultSchedule& faults = mission_.faults;
    take_off(now);
    if (now < faults.healed_at) {
      for (auto& coming : crashes_) play_crash(coming, now);
      std::erase_if(crashes_, [](const ComingCrash& c) { return c.over; });
    }
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (!restart_at_[i] || now < *restart_at_[i]) continue;
      restart_at_[i].reset();
      vehicles_[i].start_agent(hazards_);
      nodes_[i].on = true;
      tell(now, FaultEvent::Kind::restarted, vehicles_[i].spec().id);
    }
    const bool heals = now >= faults.healed_at && !std::exchange(healed_, true);
    if (heals) tell(now, FaultEvent::Kind::healed, kGroundStation);
    const bool reports = faults.sites_reported_at && now >= *faults.sites_reported_at &&
                         !std::exchange(sites_reported_, true);
    if (heals || reports) hand_over_sites(finder_.report_all(vehicles_), now, true);
  }

  void take_off(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (vehicles_[i].flying()) continue;
      const auto joins = mission_.faults.joining.find(vehicles_[i].spec().id);
      const bool late = joins != mission_.faults.joining.end();
      if (late && now < joins->second) continue;
      vehicles_[i].take_off(now);
      nodes_[i].on = true;
      nodes_[i].position = vehicles_[i].state().position().horizontal();
      if (late) tell(now, FaultEvent::Kind::joined, vehicles_[i].spec().id);
    }
  }

  void play_crash(ComingCrash& coming, Instant now) {
    if (now < coming.crash.not_before) return;
    if (!coming.victim) {
      std::vector<std::size_t> candidates;
      for (std::size_t i = 0; i < vehicles_.size(); ++i) {
        const auto* agent = vehicles_[i].agent();
        if (agent != nullptr && has_role(*agent, coming.crash.role)) candidates.push_back(i);
      }
      if (candidates.empty()) return;
      coming.victim = candidates[coming.crash.pick % candidates.size()];
      coming.at = now + coming.crash.after;
    }
    const std::size_t i = *coming.victim;
    if (now < coming.at) return;
    // The flight controller knows of no hazards: its orbit must happen to keep its distance.
    if (!vehicles_[i].can_hold(hazards_)) return;
    coming.over = true;
    if (vehicles_[i].agent() == nullptr) return;  // down already
    count_errors(i);
    vehicles_[i].end_agent(now, hazards_);
    nodes_[i].on = false;
    finder_.on_agent_end(i);
    if (observer_.plan) observer_.plan(vehicles_[i].spec().id, vehicles_[i].plan(), now);
    if (coming.crash.down_for) {
      restart_at_[i] = now + *coming.crash.down_for;
      tell(now, FaultEvent::Kind::ended, vehicles_[i].spec().id);
    } else {
      gone_at_[i] = now;
      tell(now, FaultEvent::Kind::gone, vehicles_[i].spec().id);
    }
  }

  // --- the mission ---

  void deliver(Instant now) {
    while (const auto parcel = air_.pop_due(now)) {
      if (parcel->to == ground_index()) {
        ground_.on_message(std::get<mission::Message>(*parcel->what), parcel->from, now);
        drain_ground(now);
        continue;
      }
      const FlyingVehicle& v = vehicles_[parcel->to];
      if (v.agent() == nullptr) continue;
      if (const auto* planned = std::get_if<mission::PlanningResult>(parcel->what.get())) {
        if (parcel->life == v.life()) v.agent()->on_planning_result(*planned, v.local(now));
      } else {
        v.agent()->on_message(std::get<mission::Message>(*parcel->what), parcel->from,
                              v.local(now));
      }
      drain(parcel->to, now);
    }
  }

  void control(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      FlyingVehicle& v = vehicles_[i];
      if (!v.flying() || (gone_at_[i] && now > *gone_at_[i] + kSeenWhenGone)) continue;
      const bool follows = v.control(now);
      nodes_[i].position = v.state().position().horizontal();
      if (follows && due(now, kTrackPeriod) && observer_.track) {
        observer_.track(v.spec().id, v.state(), v.plan());
      }
    }
  }

  void sense(Instant now) {
    hand_over_sites(finder_.look(vehicles_), now, false);
    hand_over_sites(finder_.report_due(vehicles_, now), now, true);
    for (const auto& h : mission_.hazards) {
      if (h.known_from <= Instant{} || h.known_from > now || !told_.insert(h.hazard.id).second)
        continue;
      hazards_.push_back(h.hazard);
      tell(now, FaultEvent::Kind::appeared, kGroundStation,
           "hazard " + std::to_string(h.hazard.id.value));
      const auto what =
          std::make_shared<const Content>(mission::Message{mission::HazardReport{h.hazard}});
      for (std::size_t i = 0; i < vehicles_.size(); ++i) hand_over(now, i, what);
    }
  }

  void hand_over_sites(const std::vector<SiteFinder::Found>& found, Instant now, bool told) {
    for (const auto& f : found) {
      hand_over(now, f.vehicle, std::make_shared<const Content>(mission::Message{f.report}));
      if (!told) continue;
      tell(now, FaultEvent::Kind::reported, f.report.finder,
           "site " + std::to_string(f.report.site.id.value));
    }
  }

  void step_agents(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      const FlyingVehicle& v = vehicles_[i];
      if (v.agent() == nullptr) continue;
      v.agent()->on_state(v.local_state(), v.local(now));
      drain(i, now);
      if (due(now, kTelemetryPeriod))
        radio_.broadcast(nodes_, i, mission::Message{v.agent()->telemetry()}, now);
    }
    ground_.on_timeout(now);
    drain_ground(now);
  }

  void drain(std::size_t i, Instant now) {
    FlyingVehicle& v = vehicles_[i];
    while (const auto message = v.agent()->poll_message()) {
      ++result_.messages;
      radio_.broadcast(nodes_, i, *message, now);
    }
    while (const auto event = v.agent()->poll_event()) on_event(v, *event);
    while (const auto plan = v.agent()->poll_plan()) {
      v.follow(*plan);
      if (observer_.plan) observer_.plan(v.spec().id, v.plan(), now);
    }
    while (const auto request = v.agent()->poll_planning_request()) {
      const mission::PlanningResult planned{request->round,
                                            planning::allocate(request->params, request->problem),
                                            mission_.allocation_takes};
      air_.post({now + mission_.allocation_takes, 0, i, v.spec().id, v.life(),
                 std::make_shared<const Content>(planned)});
    }
  }

  void on_event(FlyingVehicle& v, const mission::MissionEvent& event) {
    using mission::EventKind;
    finder_.on_event(event);
    if (event.kind == EventKind::site_done) sites_done_.insert(event.task.site);
    if (event.kind == EventKind::site_done || event.kind == EventKind::authorisation_refused)
      sites_over_.insert(event.task.site);
    if (event.kind == EventKind::task_started && event.task.kind == TaskKind::deliver)
      v.began_delivery();
    if (observer_.event) observer_.event(v.in_true_time(event));
  }

  void drain_ground(Instant now) {
    while (const auto message = ground_.poll_message()) {
      radio_.broadcast(nodes_, ground_index(), *message, now);
    }
    while (const auto event = ground_.poll_event()) {
      // Those of the vehicles have been seen at their source.
      if (event->vehicle == kGroundStation && observer_.event) observer_.event(*event);
    }
  }

  /// From a sensor on board: no radio lies between.
  void hand_over(Instant now, std::size_t to, const std::shared_ptr<const Content>& what) {
    air_.post({now, 0, to, vehicles_[to].spec().id, 0, what});
  }

  void count_errors(std::size_t i) {
    const auto counters = vehicles_[i].agent()->counters();
    result_.protocol_errors += counters.at("protocol_errors");
    result_.dropped += counters.at("messages_dropped") + counters.at("events_dropped");
  }

  void sum_up(std::size_t i) {
    const FlyingVehicle& v = vehicles_[i];
    if (v.agent() != nullptr) count_errors(i);
    VehicleEnd end;
    end.vehicle = v.spec().id;
    end.gone = gone_at_[i].has_value();
    end.loads = v.loads_left();
    if (v.flying()) {
      end.range_left_m = v.spec().range_m - v.state().distance_flown_m;
      end.position = v.state().position().horizontal();
    }
    result_.vehicles.push_back(end);
  }

  const TeamMission& mission_;
  const TeamObserver& observer_;
  InFlight air_;
  RadioChannel radio_;
  SiteFinder finder_;
  mission::GroundAgent ground_;
  std::vector<FlyingVehicle> vehicles_;
  std::vector<RadioNode> nodes_;  ///< the vehicles, then the ground station
  std::vector<Hazard> hazards_;   ///< that exist by now
  std::set<HazardId> told_;
  std::set<SiteId> sites_done_;
  std::set<SiteId> sites_over_;  ///< done, or refused by the operator
  std::vector<ComingCrash> crashes_;
  std::vector<std::optional<Instant>> restart_at_;  ///< of each vehicle
  std::vector<std::optional<Instant>> gone_at_;
  bool healed_ = false;
  bool sites_reported_ = false;
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

std::string trace_line(const FaultEvent& event) {
  static constexpr std::array<const char*, 7> kNames{
      "its program ends", "its program ends for good",
      "starts anew",      "joins",
      "is told of",       "appears",
      "the radio heals"};
  std::array<char, 96> line{};
  std::snprintf(line.data(), line.size(), "%12.6f  %3u  FAULT: %s", to_seconds(event.time),
                static_cast<unsigned>(event.vehicle.value),
                kNames.at(static_cast<std::size_t>(event.kind)));
  return line.data() + (event.text.empty() ? "" : " " + event.text);
}

}  // namespace skein::hil
