// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "aircraft.hpp"
#include "ether.hpp"
#include "ground_station.hpp"
#include "multirotor_body.hpp"
#include "site_finder.hpp"
#include "skein/base/assert.hpp"
#include "skein/hil/fault_timeline.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

constexpr Duration kControlPeriod = InFlight::kStep;
constexpr Duration kNodePeriod = std::chrono::milliseconds{40};
constexpr Duration kFormationNodePeriod = std::chrono::milliseconds{20};
constexpr Duration kSensorPeriod = std::chrono::milliseconds{100};
constexpr Duration kTrackPeriod = std::chrono::milliseconds{100};
/// A receiver of ADS-B hears an aircraft so often.
constexpr Duration kAircraftPeriod = std::chrono::milliseconds{480};
constexpr Duration kAfterwards = std::chrono::seconds{5};
/// How long the track of a vehicle goes on that nobody hears of any more: what it has just done can
/// be judged.
constexpr Duration kSeenWhenGone = std::chrono::seconds{2};
/// A formation is at rest for so long once its script is done.
constexpr Duration kAtRest = std::chrono::seconds{2};
/// Or, where it is not: nothing comes any more. Longer than the ground station takes to know that a
/// vehicle is lost, and to give an order again.
constexpr Duration kIdle = std::chrono::seconds{30};
/// Slower, a reference stands still.
constexpr double kStill_mps = 1e-3;
constexpr std::uint64_t kGustStream = 0x666f726d67757301;

/// Of a copter on its way up.
const mission::FlightPlan kNoPlan;

bool due(Instant now, Duration period) {
  return now.time_since_epoch() % period == Duration::zero();
}

/// The ground station plans from what vehicles fly: planes in formation, and who is ordered home.
bool reads_plans(const TeamMission& mission) {
  const auto is_return = [](const Fault& fault) {
    const auto* order = std::get_if<Ordered>(&fault.what);
    return order != nullptr && order->kind == mission::CommandKind::return_home;
  };
  return (mission.formation && mission.formation->planes) || mission.ends_landed ||
         std::ranges::any_of(mission.faults, is_return);
}

/// Does he do it at the ground station?
bool is_operators(const Fault& fault) {
  return std::holds_alternative<SiteWithdrawal>(fault.what) ||
         std::holds_alternative<GrantTakenBack>(fault.what) ||
         std::holds_alternative<Ordered>(fault.what) ||
         std::holds_alternative<RoutesOrdered>(fault.what);
}

/// What no program of the team reads: people do, and nobody watches here.
bool is_for_watchers(const mission::Message& message, bool plans_are_read, bool health_is_read) {
  return (std::holds_alternative<mission::PlanReport>(message) && !plans_are_read) ||
         (std::holds_alternative<mission::Health>(message) && !health_is_read);
}

class Team {
 public:
  Team(const TeamMission& mission, const TeamObserver& observer)
      : mission_{mission},
        observer_{observer},
        plans_are_read_{reads_plans(mission)},
        ether_{mission},
        timeline_{mission.faults},
        healing_{healing_of(mission.faults)},
        awaits_routes_{std::ranges::any_of(
            mission.faults,
            [](const Fault& f) { return std::holds_alternative<RoutesOrdered>(f.what); })},
        finder_{mission} {
    const bool has_second = has_second_station(mission.faults);
    grounds_.emplace_back(mission, observer, has_second ? 1 : 0);
    if (has_second) grounds_.emplace_back(mission, unseen_, 2);
    Random gusts{mission.seed ^ kGustStream};
    for (const auto& v : mission.vehicles) vehicles_.emplace_back(mission, v, gusts.fork());
    const std::size_t programs = ether_.stations().size();
    restart_at_.resize(programs);
    gone_at_.resize(programs);
    stands_until_.resize(programs, Instant::min());
    give_back_at_.resize(vehicles_.size(), Instant::max());
    for (GroundStation& ground : grounds_) ground.start(Instant{});
    hazards_ = hazards_known_at(mission.hazards, Instant{});
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (start_of(mission.faults, vehicles_[i].spec().id) == Instant{}) take_off(i, Instant{});
    }
  }

  TeamResult run() {
    const Instant last = Instant{} + mission_.duration_max;
    std::optional<Instant> stop_at;
    for (Instant now{}; now <= stop_at.value_or(last); now += kControlPeriod) {
      if (!mission_.faults.empty()) play_faults(now);
      ether_.step(now);
      deliver(now);
      control(now);
      if (due(now, kSensorPeriod)) sense(now);
      if (due(now, kNodePeriod)) ether_.route(now);
      step_nodes(now);
      if (due(now, kNodePeriod)) step_ground(now);
      if (observer_.moment && due(now, kNodePeriod)) show_moment(now);
      if (mission_.formation) watch_formation(now);
      result_.ended_at = now;
      if (!stop_at && (work_over(now) ? landed_if_so(now) : nobody_flies())) {
        const Duration afterwards = mission_.sites.empty() ? Duration{} : kAfterwards;
        stop_at = std::min(last, std::max(now, healing_.value_or(Instant{})) + afterwards);
      }
    }
    result_.ground_gone = gone_at_[ether_.ground()].has_value();
    result_.sites_done = sites_done_.size();
    for (std::size_t i = 0; i < vehicles_.size(); ++i) sum_up(i);
    return result_;
  }

 private:
  [[nodiscard]] bool work_over(Instant now) const {
    return sites_over_.size() == mission_.sites.size() && formation_over(now) &&
           (!awaits_routes_ || std::ranges::any_of(grounds_, &GroundStation::routes_over));
  }

  /// The range of all that are left has ended, and nobody joins any more.
  [[nodiscard]] bool nobody_flies() const {
    if (mission_.formation) return false;
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      const Aircraft& v = vehicles_[i];
      if (!v.flying() || !(v.landed() || gone_at_[i])) return false;
    }
    return true;
  }

  /// Where the mission ends on the ground, the operator orders it once the work is done.
  bool landed_if_so(Instant now) {
    if (!mission_.ends_landed) return true;
    static constexpr std::array kOrders{mission::CommandKind::return_home,
                                        mission::CommandKind::land};
    if (orders_to_land_ < kOrders.size() &&
        commander().command(kGroundStation, kOrders.at(orders_to_land_), now)) {
      ++orders_to_land_;
    }
    return std::ranges::none_of(vehicles_,
                                [](const Aircraft& v) { return v.running() && !v.landed(); });
  }

  // --- faults ---

  void tell(Instant now, FaultEvent::Kind kind, VehicleId vehicle, std::string text = {},
            Duration lasts = {}) const {
    if (observer_.fault) observer_.fault({now, kind, vehicle, std::move(text), lasts});
  }

  void play_faults(Instant now) {
    timeline_.play(
        now, [this](Role role) { return having(role); },
        [&](const Fault& fault, const std::vector<VehicleId>& who) {
          return begin(fault, who, now);
        });
    give_back(now);
    if (timeline_.radio_changed()) ether_.interfere(timeline_.interference());
    for (std::size_t i = 0; i < restart_at_.size(); ++i) {
      if (!restart_at_[i] || now < *restart_at_[i]) continue;
      restart_at_[i].reset();
      if (i >= ether_.ground()) {
        grounds_[i - ether_.ground()].start(now);
        if (i == ether_.ground()) result_.ground_warning.reset();
      } else {
        vehicles_[i].start_program(hazards_, now);
      }
      ether_.turn(i, true);
      tell(now, FaultEvent::Kind::restarted, ether_.stations()[i].node.id);
    }
  }

  [[nodiscard]] std::vector<VehicleId> having(Role role) const {
    std::vector<VehicleId> some;
    for (const Aircraft& v : vehicles_) {
      if (v.in_coalitions() && has_role(v.activity(), role)) some.push_back(v.spec().id);
    }
    return some;
  }

  bool begin(const Fault& fault, const std::vector<VehicleId>& who, Instant now) {
    if (std::holds_alternative<ProgramsEnd>(fault.what)) return end_programs(fault, who, now);
    if (std::holds_alternative<ProgramsStall>(fault.what)) return stall_programs(fault, who, now);
    if (std::holds_alternative<PilotsTake>(fault.what)) return pilots_take(fault, who, now);
    if (std::holds_alternative<CommandTaken>(fault.what)) return take_command(now);
    if (const auto* late = std::get_if<LateStart>(&fault.what)) {
      take_off(ether_.index_of(late->vehicle), now);
      const auto number = vehicles_[ether_.index_of(late->vehicle)].what().flies_as;
      tell(now, FaultEvent::Kind::joined, late->vehicle,
           number ? "under the number of " + names_of({*number}) : "");
      return true;
    }
    if (const auto* falls = std::get_if<BatteryFalls>(&fault.what)) {
      vehicles_[ether_.index_of(falls->vehicle)].battery_falls(falls->percent);
      return true;
    }
    if (const auto* seen = std::get_if<PlaceSeen>(&fault.what)) {
      see(*seen, now);
      return true;
    }
    if (is_operators(fault)) return !stands_still(ether_.ground(), now) && operate(fault, now);
    const auto* worse = std::get_if<radio::Disturbance>(&fault.what);
    if (std::holds_alternative<radio::Cut>(fault.what) || (worse != nullptr && worse->loss > 0.0)) {
      tell(now, FaultEvent::Kind::radio, kGroundStation, describe(fault));
    }
    const bool heals = std::holds_alternative<Healing>(fault.what);
    if (heals) tell(now, FaultEvent::Kind::healed, kGroundStation);
    if (heals || std::holds_alternative<SitesReported>(fault.what)) {
      hand_over_sites(finder_.report_all(vehicles_), now, true);
    }
    return true;
  }

  bool operate(const Fault& fault, Instant now) {
    if (const auto* gone = std::get_if<SiteWithdrawal>(&fault.what)) {
      const bool done = commander().withdraw(gone->site, now);
      if (done) drain_grounds(now);
      return done;
    }
    if (const auto* back = std::get_if<GrantTakenBack>(&fault.what)) {
      const bool done = commander().take_back(*back, now);
      if (done) drain_grounds(now);
      return done;
    }
    if (const auto* order = std::get_if<Ordered>(&fault.what)) {
      order_so(*order, now);
      tell(now, FaultEvent::Kind::ordered, order->vehicle, describe(fault));
      return true;
    }
    if (!commander().give(std::get<RoutesOrdered>(fault.what), now)) return false;
    tell(now, FaultEvent::Kind::ordered, kGroundStation, describe(fault));
    return true;
  }

  /// Where the ground station refuses to order all, since a number is used twice, the operator
  /// orders the others one by one.
  void order_so(const Ordered& order, Instant now) {
    GroundStation& operators = commander();
    if (operators.command(order.vehicle, order.kind, now) || order.vehicle != kGroundStation)
      return;
    for (const Aircraft& v : vehicles_) {
      if (!v.what().flies_as) (void)operators.command(v.spec().id, order.kind, now);
    }
  }

  void see(const PlaceSeen& what, Instant now) {
    mission::Detection detection;
    detection.position = what.place;
    for (const VehicleId id : what.by) {
      hand_over(now, ether_.index_of(id),
                std::make_shared<const Content>(mission::Message{detection}));
      detection.position.x() += 8.0;
    }
  }

  /// Whose operators order what is ordered: the ground station that has the command.
  [[nodiscard]] GroundStation& commander() {
    const auto found = std::ranges::find_if(grounds_, &GroundStation::commands);
    return found == grounds_.end() ? grounds_.front() : *found;
  }

  bool take_command(Instant now) {
    const auto takes = [now](GroundStation& ground) {
      return !ground.commands() && ground.take_command(now);
    };
    if (std::ranges::none_of(grounds_, takes)) return false;
    tell(now, FaultEvent::Kind::ordered, kGroundStation, "the other takes the command");
    drain_grounds(now);
    return true;
  }

  bool end_programs(const Fault& fault, const std::vector<VehicleId>& who, Instant now) {
    const auto& what = std::get<ProgramsEnd>(fault.what);
    for (const VehicleId id : who) {
      const std::size_t i = ether_.index_of(id);
      // The flight controller knows of no hazards: where somebody is chosen, the orbit must happen
      // to keep its distance.
      const bool holds = fault.when.role && !what.with_airframe;
      if (holds && !vehicles_[i].can_hold(hazards_)) return false;
    }
    for (const VehicleId id : who) {
      end_program(ether_.index_of(id), fault.lasts, now, what.with_airframe);
      if (what.sinks_after) vehicles_[ether_.index_of(id)].sink(now + *what.sinks_after);
    }
    return true;
  }

  [[nodiscard]] bool stands_still(std::size_t i, Instant now) const {
    return now < stands_until_[i];
  }

  /// What comes to it waits for it; its aircraft flies on by the guidance that it has. One that has
  /// none yet would not be in the air by its program.
  bool stall_programs(const Fault& fault, const std::vector<VehicleId>& who, Instant now) {
    const Duration lasts = fault.lasts.value_or(Duration{});
    for (const VehicleId id : who) {
      const std::size_t i = ether_.index_of(id);
      const bool has_guidance = i >= ether_.ground() || vehicles_[i].is_led();
      if (!ether_.stations()[i].on || !has_guidance) continue;
      stands_until_[i] = std::max(stands_until_[i], now + lasts);
      tell(now, FaultEvent::Kind::stands_still, id, fmt::format("for {:.2f} s", to_seconds(lasts)),
           lasts);
    }
    return true;
  }

  /// Whoever it is must have an orbit that keeps its distance, as with end_programs().
  bool pilots_take(const Fault& fault, const std::vector<VehicleId>& who, Instant now) {
    const auto can = [this, now](VehicleId id) {
      const std::size_t i = ether_.index_of(id);
      const Aircraft& v = vehicles_[i];
      const bool has_word = v.running() && !v.piloted() && !stands_still(i, now);
      return has_word && v.flying() && v.can_hold(hazards_);
    };
    const Duration lasts = fault.lasts.value_or(Instant::max() - now);
    if (!std::ranges::all_of(who, can)) return false;
    for (const VehicleId id : who) {
      const std::size_t i = ether_.index_of(id);
      tell(now, FaultEvent::Kind::piloted, id, {}, lasts);
      vehicles_[i].taken_by_pilot(now, hazards_);
      tell_plan(vehicles_[i], now);
      drain(i, now);
      give_back_at_[i] = now + lasts;
    }
    return true;
  }

  void give_back(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (now < give_back_at_[i] || stands_still(i, now)) continue;
      give_back_at_[i] = Instant::max();
      if (!vehicles_[i].piloted()) continue;  // another program has it since
      tell(now, FaultEvent::Kind::given_back, vehicles_[i].spec().id);
      vehicles_[i].given_back(now);
      drain(i, now);
    }
  }

  /// What a program does first that stood still: it looks where its aircraft is.
  void wake(std::size_t i, Instant now) {
    if (stands_until_[i] == Instant::min()) return;
    stands_until_[i] = Instant::min();
    (void)vehicles_[i].tell_state(now);
  }

  void end_program(std::size_t i, const std::optional<Duration>& down_for, Instant now,
                   bool with_airframe) {
    const bool runs = ether_.stations()[i].on;
    // Who was to start anew may be lost meanwhile.
    if (!runs && (down_for || !restart_at_[i])) return;
    restart_at_[i].reset();
    if (runs) stop_program(i, now, with_airframe);
    if (down_for) {
      restart_at_[i] = now + *down_for;
    } else {
      gone_at_[i] = now;
    }
    tell(now, down_for ? FaultEvent::Kind::ended : FaultEvent::Kind::gone,
         ether_.stations()[i].node.id, with_airframe ? "with its airframe" : "");
  }

  void stop_program(std::size_t i, Instant now, bool with_airframe) {
    stands_until_[i] = Instant::min();
    if (i >= ether_.ground()) {
      grounds_[i - ether_.ground()].end();
    } else {
      count_errors(i);
      finder_.on_agent_end(i);
      if (with_airframe) {
        vehicles_[i].end_with_program();
      } else {
        vehicles_[i].end_program(now, hazards_);
        tell_plan(vehicles_[i], now);
      }
    }
    ether_.turn(i, false);
  }

  void tell_plan(const Aircraft& v, Instant now) {
    if (observer_.plan && v.plan() != nullptr) observer_.plan(v.spec().id, *v.plan(), now);
  }

  void take_off(std::size_t i, Instant now) {
    vehicles_[i].take_off(now);
    ether_.turn(i, true);
    see_position(i);
  }

  void see_position(std::size_t i) {
    ether_.place(i, vehicles_[i].state().position().horizontal());
  }

  // --- the radio ---

  void broadcast(std::size_t from, mission::Message message, Instant now) {
    if (observer_.message) observer_.message(message);
    ether_.broadcast(from, std::move(message), now,
                     [this](std::size_t to, const mission::Telemetry& told) {
                       return vehicles_[to].watches(told);
                     });
  }

  // --- the mission ---

  void deliver(Instant now) {
    while (auto parcel = ether_.in_flight().pop_due(now)) {
      if (stands_still(parcel->to, now)) {
        parcel->at = stands_until_[parcel->to];
        ether_.in_flight().post(std::move(*parcel));
        continue;
      }
      if (parcel->to >= ether_.ground()) {
        const std::size_t i = parcel->to - ether_.ground();
        if (!grounds_[i].running()) continue;
        grounds_[i].on_message(std::get<mission::Message>(*parcel->what), parcel->from,
                               parcel->start, now);
        drain_ground(i, now);
        continue;
      }
      Aircraft& v = vehicles_[parcel->to];
      if (!v.running()) continue;
      wake(parcel->to, now);
      if (parcel->only_wakes && ether_.wakes_say_nothing() && v.is_quiet(now)) continue;
      if (const auto* planned = std::get_if<mission::PlanningResult>(parcel->what.get())) {
        if (parcel->life == v.life()) v.node().on_planning_result(*planned, v.local(now));
      } else {
        const auto& message = std::get<mission::Message>(*parcel->what);
        if (!v.heeds(message, parcel->from, parcel->start, now)) continue;
        if (observer_.heard) observer_.heard(v.spec().id, message, now);
        v.node().on_message(message, parcel->from, v.local(now));
      }
      if (drain(parcel->to, now)) ether_.in_flight().on_moved(*parcel);
    }
  }

  void control(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      Aircraft& v = vehicles_[i];
      const bool unseen = gone_at_[i] && now > *gone_at_[i] + kSeenWhenGone;
      if (!v.flying() || (unseen && !v.what().flies_formation)) continue;
      const bool follows = v.control(now);
      see_position(i);
      if (follows && due(now, kTrackPeriod) && observer_.track && !v.what().flies_formation) {
        observer_.track(v.spec().id, v.state(), v.plan() != nullptr ? *v.plan() : kNoPlan);
      }
    }
  }

  void sense(Instant now) {
    hand_over_sites(finder_.look(vehicles_), now, false);
    hand_over_sites(finder_.report_due(vehicles_, now), now, true);
    for (const auto& h : mission_.hazards) {
      if (h.known_before() || h.known_from > now || !told_.insert(h.hazard.id).second) continue;
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

  void step_nodes(Instant now) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      Aircraft& v = vehicles_[i];
      const Duration period = v.what().flies_formation ? kFormationNodePeriod : kNodePeriod;
      if (!v.running() || !due(now, period) || stands_still(i, now)) continue;
      if (v.tell_state(now)) drain(i, now);
    }
  }

  void step_ground(Instant now) {
    for (std::size_t i = 0; i < grounds_.size(); ++i) {
      GroundStation& ground = grounds_[i];
      if (!ground.running() || stands_still(ether_.ground() + i, now)) continue;
      if (!mission_.aircraft.empty() && due(now, kAircraftPeriod)) {
        for (const auto& one : mission_.aircraft) {
          if (const auto there = place_of(one, now)) ground.on_aircraft(*there, now);
        }
      }
      ground.on_timeout(now);
      drain_ground(i, now);
    }
  }

  void show_moment(Instant now) const {
    if (!grounds_.front().running() || stands_still(ether_.ground(), now)) return;
    std::vector<OwnWord> words;
    for (const Aircraft& v : vehicles_) {
      words.push_back({v.spec().id, v.running() ? std::optional{v.telemetry()} : std::nullopt});
    }
    observer_.moment(now, grounds_.front().node(), words);
  }

  /// True where there was anything.
  bool drain(std::size_t i, Instant now) {
    Aircraft& v = vehicles_[i];
    bool any = false;
    while (auto message = v.node().poll_message()) {
      any = true;
      if (is_for_watchers(*message, plans_are_read_, grounds_.size() > 1)) continue;
      if (!std::holds_alternative<mission::Telemetry>(*message)) ++result_.messages;
      broadcast(i, std::move(*message), now);
    }
    while (const auto event = v.node().poll_event()) {
      any = true;
      on_event(v, *event);
    }
    while (const auto guidance = v.node().poll_guidance()) {
      any = true;
      v.follow(*guidance);
      if (!v.piloted() && std::holds_alternative<mission::FlightPlan>(*guidance)) tell_plan(v, now);
    }
    while (const auto request = v.node().poll_planning_request()) {
      any = true;
      const mission::PlanningResult planned{request->round,
                                            planning::allocate(request->params, request->problem),
                                            mission_.allocation_takes};
      ether_.in_flight().post({now + mission_.allocation_takes, 0, i, v.spec().id, v.life(),
                               std::make_shared<const Content>(planned)});
    }
    v.on_polled(now);
    return any;
  }

  void on_event(Aircraft& v, const mission::MissionEvent& told) {
    using mission::EventKind;
    const mission::MissionEvent event = v.seen(told);
    const bool took_part = v.takes_part();
    const bool shared_number = v.shares_number();
    v.on_event(event);
    finder_.on_event(event);
    // What it knows of, the operator tells another.
    const bool is_double = v.shares_number() && !shared_number;
    const bool leaves = took_part || is_double || event.kind() == EventKind::setup_differs;
    if (leaves && !v.takes_part() && ether_.healed()) {
      hand_over_sites(finder_.report_all(vehicles_), event.time, true);
    }
    if (event.kind() == EventKind::site_done && is_of_mission(event.task.site))
      sites_done_.insert(event.task.site);
    if (event.kind() == EventKind::site_done || event.kind() == EventKind::authorisation_refused)
      over(event.task.site);
    if (observer_.event) observer_.event(event);
  }

  /// Not one that detectors have seen: nobody waits for the end of those.
  [[nodiscard]] bool is_of_mission(SiteId site) const {
    return std::any_of(mission_.sites.begin(), mission_.sites.end(),
                       [site](const Site& s) { return s.id == site; });
  }
  void over(SiteId site) {
    if (is_of_mission(site)) sites_over_.insert(site);
  }

  void drain_grounds(Instant now) {
    for (std::size_t i = 0; i < grounds_.size(); ++i) drain_ground(i, now);
  }

  /// What one that watches is told of was told already.
  void drain_ground(std::size_t i, Instant now) {
    GroundStation& ground = grounds_[i];
    if (ground.running()) ether_.start(ether_.ground() + i, ground.start_number());
    while (auto message = ground.poll_message(now)) {
      broadcast(ether_.ground() + i, std::move(*message), now);
    }
    while (const auto event = ground.poll_event()) {
      if (!ground.commands()) continue;
      if (observer_.event) observer_.event(*event);
      const auto kind = event->kind();
      if (kind == mission::EventKind::site_withdrawn ||
          kind == mission::EventKind::authorisation_withdrawn ||
          kind == mission::EventKind::authorisation_refused) {
        over(event->task.site);
      } else if (kind == mission::EventKind::authorised) {
        sites_over_.erase(event->task.site);  // the operator of another station
      }
      if (mission_.formation) on_formation_event(*event, now);
    }
  }

  // --- the formation ---

  void on_formation_event(const mission::MissionEvent& event, Instant now) {
    using mission::EventKind;
    moved_at_ = now;
    if (event.kind() == EventKind::change_begun) {
      timeline_.on_change_begun(now);
      result_.ground_warning.reset();
    }
    if (mission::is_warning(event.kind())) result_.ground_warning = event;
    script_done_ = script_done_ || event.kind() == EventKind::script_done;
  }

  void watch_formation(Instant now) {
    std::vector<SeenBody> bodies;
    for (const Aircraft& v : vehicles_) {
      if (!v.what().flies_formation) continue;
      const Vec3 position = v.position();
      const auto reference = v.reference(now);
      if (reference && reference->velocity_mps.norm() > kStill_mps) moved_at_ = now;
      // Planes always move; they are done when none is on its way or on the track.
      if (mission_.formation->planes && v.running() && v.activity() == mission::Activity::forming) {
        moved_at_ = now;
      }
      bodies.push_back({v.spec().id, position, position.z() > MultirotorBody::kAirborne_m,
                        v.off_m(now), !v.running() || v.piloted(), !v.running() && !reference});
    }
    if (observer_.bodies) observer_.bodies(now, bodies);
  }

  [[nodiscard]] bool formation_over(Instant now) const {
    if (!mission_.formation) return true;
    if (script_done_) return now - moved_at_ > kAtRest;
    return now - std::max(moved_at_, timeline_.quiet_from()) > kIdle;
  }

  /// From a sensor on board: no radio lies between.
  void hand_over(Instant now, std::size_t to, const std::shared_ptr<const Content>& what) {
    ether_.in_flight().post({now, 0, to, mission::kSensors, 0, what});
  }

  void count_errors(std::size_t i) {
    const auto counters = vehicles_[i].node().counters();
    result_.protocol_errors += counters.protocol_errors;
    result_.dropped += counters.messages_dropped + counters.events_dropped;
  }

  void sum_up(std::size_t i) {
    const Aircraft& v = vehicles_[i];
    if (v.running()) count_errors(i);
    VehicleEnd end;
    end.vehicle = v.spec().id;
    end.gone = gone_at_[i].has_value();
    end.spent = v.battery_fell();
    end.barred = v.in_coalitions() && !v.takes_part();
    end.loads = v.loads_left();
    end.in_place = v.in_place();
    end.landed = v.landed();
    if (v.flying()) {
      end.range_left_m = v.spec().range_m - v.state().distance_flown_m;
      end.position = v.state().position().horizontal();
    }
    result_.vehicles.push_back(end);
  }

  const TeamMission& mission_;
  const TeamObserver& observer_;
  const TeamObserver unseen_;  ///< a second ground station
  bool plans_are_read_;
  Ether ether_;
  FaultTimeline timeline_;
  std::optional<Instant> healing_;
  bool awaits_routes_;
  SiteFinder finder_;
  std::deque<GroundStation> grounds_;
  std::vector<Aircraft> vehicles_;
  std::vector<Hazard> hazards_;  ///< that exist by now
  std::set<HazardId> told_;
  std::set<SiteId> sites_done_;
  std::set<SiteId> sites_over_;                     ///< done, or refused by the operator
  std::vector<std::optional<Instant>> restart_at_;  ///< of each program, as stations are
  std::vector<std::optional<Instant>> gone_at_;
  std::vector<Instant> give_back_at_;  ///< each vehicle, by its pilot
  std::vector<Instant> stands_until_;  ///< each program
  bool script_done_ = false;           ///< of the formation
  std::size_t orders_to_land_ = 0;     ///< that were given
  Instant moved_at_{};                 ///< it did, or was given an order
  TeamResult result_;
};

}  // namespace

std::optional<mission::Aircraft> place_of(const configuration::PassingAircraft& aircraft,
                                          Instant now) {
  const Vec2 way = aircraft.to_m - aircraft.from_m;
  const double flown_s = to_seconds(now - aircraft.at);
  if (flown_s < 0.0 || flown_s * aircraft.speed_mps > way.norm()) return std::nullopt;
  const Vec2 velocity = aircraft.speed_mps * way.normalized();
  return mission::Aircraft{.address = aircraft.address,
                           .position = aircraft.from_m + flown_s * velocity,
                           .height_m = aircraft.height_m + flown_s * aircraft.climb_mps,
                           .east_mps = velocity.x(),
                           .north_mps = velocity.y(),
                           .climb_mps = aircraft.climb_mps,
                           .time = now};
}

TeamResult simulate_team(const TeamMission& mission, const TeamObserver& observer) {
  return Team{mission, observer}.run();
}

std::string trace_line(const mission::MissionEvent& event) {
  std::array<char, 160> head{};
  std::snprintf(head.data(), head.size(), "%12.6f  %3u  %-23.*s  %u.%u/%u  ",
                to_seconds(event.time), static_cast<unsigned>(event.vehicle.value),
                static_cast<int>(to_string(event.kind()).size()), to_string(event.kind()).data(),
                static_cast<unsigned>(event.round.coalition.leader.value),
                event.round.coalition.number, event.round.number);
  return head.data() + to_string(event.task) + "  " + wording::news_of(event);
}

std::string text_of(const FaultEvent& event) {
  static constexpr std::array<const char*, 12> kNames{"its program ends",
                                                      "its program ends for good",
                                                      "starts anew",
                                                      "joins",
                                                      "is told of",
                                                      "appears",
                                                      "the radio heals",
                                                      "the radio,",
                                                      "is ordered,",
                                                      "stands still",
                                                      "is taken by its pilot",
                                                      "is given back"};
  return kNames.at(static_cast<std::size_t>(event.kind)) +
         (event.text.empty() ? "" : " " + event.text);
}

std::string trace_line(const FaultEvent& event) {
  std::array<char, 48> line{};
  std::snprintf(line.data(), line.size(), "%12.6f  %3u  FAULT: ", to_seconds(event.time),
                static_cast<unsigned>(event.vehicle.value));
  return line.data() + text_of(event);
}

std::string describe(const TeamMission& mission) {
  std::string text;
  for (const Fault& fault : mission.faults) text += "fault: " + describe(fault) + "\n";
  for (const auto& v : mission.vehicles) {
    if (v.flies_as) text += names_of({v.spec.id}) + " flies as " + names_of({*v.flies_as}) + "\n";
  }
  if (!healing_of(mission.faults)) return text;
  if (mission.radio.bytes_per_s) {
    text += fmt::format("the air carries {:.1f} kB/s\n", 1e-3 * *mission.radio.bytes_per_s);
  }
  if (const Vec2& wind = mission.wind.steady_mps; wind.norm() > 0.0) {
    text += fmt::format("wind to ({:.1f}, {:.1f}) m/s, gusts of {:.1f} m/s\n", wind.x(), wind.y(),
                        mission.wind.gust_mps);
  }
  text +=
      fmt::format("the mission ends at {:.2f} s at the latest\n", to_seconds(mission.duration_max));
  for (const auto& h : mission.hazards) {
    if (h.known_before()) continue;
    text += fmt::format("hazard {} at ({:.1f}, {:.1f}), radius {:.1f} m, appears at {:.2f} s\n",
                        h.hazard.id.value, h.hazard.centre.x(), h.hazard.centre.y(),
                        h.hazard.radius_m, to_seconds(h.known_from));
  }
  for (const auto& d : mission.decisions) {
    text += fmt::format("operator, site {}: {}, {:.2f} s after the request, not before {:.2f} s\n",
                        d.site.value, d.grant ? "grants" : "refuses", to_seconds(d.reaction),
                        to_seconds(d.not_before));
  }
  return text;
}

}  // namespace skein::hil
