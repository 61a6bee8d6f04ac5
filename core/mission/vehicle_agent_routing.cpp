// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/planning/path_follower.hpp"
#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {
/// A task counts as flown when the vehicle is this close to where its plan has it.
constexpr double kOnTrackM = 30.0;

/// Paths keep this far from hazards where there is room: in long turns with the wind, which leave
/// no rate to spare, a vehicle gets up to 11 m off.
constexpr double kHazardMarginM = 12.0;

VehicleAgentConfig with_margin(VehicleAgentConfig config) {
  double& margin_m = config.planning.avoidance.margin_m;
  margin_m = std::max(margin_m, kHazardMarginM);
  return config;
}

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;
}  // namespace

VehicleAgent::Impl::Impl(const VehicleAgentConfig& config, Instant /*now*/)
    : config_{with_margin(config)},
      loads_{config.vehicle.loads},
      take_off_{config.vehicle},
      flight_{config.vehicle, config_.planning.avoidance, config.search},
      hazards_{config.hazards},
      participant_{config.protocol, config.vehicle.id, config.instance} {}

/// Where a route begins, or goes on for who starts anew in the middle.
bool VehicleAgent::Impl::is_there(const TimedPath& route, const VehicleState& state) {
  constexpr double kNear_m = 50.0;
  const Pose2 pose = route.pose_at(state.time);
  return (Vec2{state.x_m, state.y_m} - pose.position()).norm() <= kNear_m &&
         std::abs(wrap_pi(state.heading_rad - pose.heading_rad)) <= kPi / 4.0;
}

void VehicleAgent::Impl::on_state(const VehicleState& state, Instant now) {
  state_ = state;
  if (!flight_.started()) {
    if (!take_off_.done(state, now)) return;
    if (config_.route && is_there(*config_.route, state)) {
      flight_.start_route(*config_.route);
    } else {
      flight_.start(state.pose(), hazards_, range_to_spend(now), now);
      if (config_.route) {
        report(event::VehicleTrouble{event::Trouble::route_not_flown}, {}, {}, now);
      }
    }
  }
  step(now);
}

std::optional<Guidance> VehicleAgent::Impl::poll_guidance() {
  if (!flight_.started()) return take_off_.poll_track();
  return flight_.poll_plan();
}

void VehicleAgent::Impl::on_timeout(Instant now) { step(now); }

void VehicleAgent::Impl::on_message(const Message& message, VehicleId /*sender*/, Instant now) {
  std::visit(Overloaded{[&](const coalition::Message& m) { receive(m, now); },
                        [&](const Authorisation& m) { on_authorisation(m, now); },
                        [&](const Command& m) { on_command(m, now); },
                        [&](const SiteReport& m) { on_site_report(m, now); },
                        [&](const HazardReport& m) { on_hazard(m.hazard, now); },
                        [&](const Telemetry& m) {
                          if (m.vehicle != config_.vehicle.id || m.instance == config_.instance ||
                              facts_.id_in_use) {
                            return;
                          }
                          note(&Failsafe::Facts::id_in_use, true);
                          report(event::VehicleTrouble{event::Trouble::id_in_use}, {}, {}, now);
                        },
                        [](const AuthorisationRequest&) {}, [](const MissionEvent&) {},
                        [](const formation::Change&) {}, [](const FormationStatus&) {},
                        [](const PlanReport&) {}, [](const Health&) {}},
             message);
  step(now);
}

void VehicleAgent::Impl::step(Instant now) {
  if (!flight_.started()) return;
  if (initiator_) {
    initiator_->set_leader_at_formation(
        flight_.pose_at(now + config_.protocol.formation_time()).position());
    initiator_->on_timeout(now);
  }
  if (task_ && task_->in(TaskFlight::State::begun))
    fly_task(now);  // what is done was done under the lease that ends now
  participant_.set_may_lead(!initiator_ && !survey_ && failsafe_.in(Failsafe::Action::none));
  participant_.on_timeout(now);
  pump(now);
  say_farewell(now);
  watch_authorisation(now);
  if (task_) fly_task(now);
  if (survey_) fly_survey(now);
  pump(now);
  watch_range(now);
  idle(now);
  pump(now);
}

void VehicleAgent::Impl::pump(Instant now) {
  // Each pass hands on what the last one brought forth; what a vehicle leads it also takes part in.
  for (bool busy = true; busy;) {
    busy = false;
    if (initiator_) {
      if (const auto message = initiator_->poll_message()) {
        send(*message, now);
        busy = true;
        continue;
      }
      if (const auto output = initiator_->poll_output()) {
        answer(*output, now);
        busy = true;
        continue;
      }
    }
    if (const auto message = participant_.poll_message()) {
      send(*message, now);
      busy = true;
    } else if (const auto wanted = participant_.poll_output()) {
      answer(*wanted, now);
      busy = true;
    }
  }
}

void VehicleAgent::Impl::send(const coalition::Message& message, Instant now) {
  messages.push(Message{message});
  receive(message, now);  // its own leader, or its own member
}

void VehicleAgent::Impl::receive(const coalition::Message& message, Instant now) {
  if (!flight_.started()) return;
  std::visit(Overloaded{[&](const coalition::Announcement& m) {
                          known_.insert(m.site.id);
                          for (auto& farewell : farewells_) {
                            if (farewell.last.site == m.site.id) farewell.times = 1;
                          }
                          sites_.on_leader(m.site, m.announced_at);
                          meet_rival(m.site.id, m.round, false, now);
                          yield_to(m, now);
                          participant_.on_announcement(m, now);
                        },
                        [&](const coalition::Bid& m) {
                          if (initiator_) initiator_->on_bid(m, now);
                        },
                        [&](const coalition::Award& m) {
                          sites_.on_leader(m.site, m.awarded_at);
                          meet_rival(m.site.id, m.round, true, now);
                          participant_.on_award(m, now);
                        },
                        [&](const coalition::Confirmation& m) {
                          if (initiator_) initiator_->on_confirmation(m, now);
                        },
                        [&](const coalition::Cancel& m) { participant_.on_cancel(m, now); },
                        [&](const coalition::LeaseRenewal& m) {
                          sites_.on_renewal(m, now);
                          if (m.closed) end_closed_site(m, now);
                          meet_rival(m.site, m.round, stands(m), now);
                          participant_.on_lease_renewal(m, now);
                        },
                        [&](const coalition::MemberStatus& m) {
                          if (initiator_) initiator_->on_status(m, now);
                          participant_.on_status(m);
                          sites_.on_status(m);
                        },
                        [&](const coalition::LeadershipClaim& m) { participant_.on_claim(m, now); },
                        [&](const coalition::Allegiance& m) {
                          if (initiator_) initiator_->on_allegiance(m, now);
                          participant_.on_allegiance(m, now);
                        }},
             message);
}

void VehicleAgent::Impl::report(EventBody body, const coalition::Round& round, const TaskId& task,
                                Instant time) {
  const MissionEvent event{config_.vehicle.id, time, round, task, std::move(body)};
  const EventKind kind = event.kind();
  events.push(event);
  // Renewals and refusals to bid are many and of interest to the recording only.
  if (kind != EventKind::lease_granted && kind != EventKind::bid_declined) messages.push(event);
}

bool VehicleAgent::Impl::on_track(const TimedPath& timed) const {
  const auto error = planning::follow_error(timed, state_, state_.time);
  return std::abs(error.along_m) < kOnTrackM && std::abs(error.cross_m) < kOnTrackM;
}

double VehicleAgent::Impl::range_left(Instant at) const {
  const double until_then =
      std::max(0.0, to_seconds(at - state_.time)) * config_.vehicle.cruise_speed_mps;
  return config_.vehicle.range_m - state_.distance_flown_m - until_then;
}

/// Without what is kept for an orbit at home, for whoever lands it.
double VehicleAgent::Impl::range_to_spend(Instant at) const {
  return range_left(at) - kTwoPi * config_.vehicle.planning_radius_m();
}

/// What it could still spend before it must turn for home.
double VehicleAgent::Impl::spare_range(Instant now) const {
  return range_to_spend(now) - flight_.way_home_m(flight_.pose_at(now), hazards_);
}

Instant VehicleAgent::Impl::next_timeout() const {
  Instant next = participant_.next_timeout();
  if (initiator_) next = std::min(next, initiator_->next_timeout());
  for (const auto& farewell : farewells_) {
    if (farewell.times > 0) next = std::min(next, farewell.next);
  }
  if (request_) next = std::min({next, request_again_, request_->decide_by});
  if (task_) {
    const bool begun = task_->in(TaskFlight::State::begun);
    next = std::min(next, begun ? task_->end_time() : task_->begin_time());
  }
  if (survey_) next = std::min(next, survey_->begun ? survey_->end_time() : survey_->begin_time());
  return next;
}

Activity VehicleAgent::Impl::activity() const {
  if (failsafe_.in(Failsafe::Action::obey)) return Activity::holding;
  const bool done_for = failsafe_.in(Failsafe::Action::come_home);
  if (done_for && !task_ && !initiator_) return Activity::holding;
  if (task_) return Activity::executing;
  if (initiator_) {
    return initiator_->state() == coalition::Initiator::State::monitoring ? Activity::monitoring
                                                                          : Activity::leading;
  }
  if (survey_) return Activity::surveying;
  if (!participant_.free()) return Activity::bidding;
  return flight_.en_route(state_.time) ? Activity::en_route : Activity::searching;
}

Telemetry VehicleAgent::Impl::telemetry() const {
  Telemetry t;
  t.vehicle = config_.vehicle.id;
  t.instance = config_.instance;
  t.state = state_;
  t.activity = activity();
  t.range_left_m = config_.vehicle.range_m - state_.distance_flown_m;
  t.loads = loads_;
  t.plan_number = flight_.plan().number;
  return t;
}

Counters VehicleAgent::Impl::counters() const {
  Counters all;
  all.protocol_errors = participant_.protocol_errors() + protocol_errors_led_ +
                        (initiator_ ? initiator_->protocol_errors() : 0);
  all.messages_dropped = messages.dropped();
  all.events_dropped = events.dropped();
  return all;
}

}  // namespace skein::mission
