// SPDX-License-Identifier: Apache-2.0
// News for the failsafe, and what the vehicle does because of it.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {

/// Within that it has heard those below, and waits for them no longer than to that.
constexpr Duration kHearsOthers = std::chrono::seconds{2};
/// The longer it has waited, and the fewer laps are left of its range, the less it looks for.
struct Choice {
  SeparationWatch::Turns turns;
  Duration until;    ///< since it could come down
  double laps_left;  ///< more than these
};
constexpr std::array kChoices{
    Choice{SeparationWatch::Turns::whatever, std::chrono::seconds{40}, 0.7},
    Choice{SeparationWatch::Turns::as_now, std::chrono::seconds{55}, 0.4},
    Choice{SeparationWatch::Turns::soon, std::chrono::seconds{65}, 0.1},
};

}  // namespace

void VehicleAgent::Impl::on_command(const Command& message, Instant now) {
  if (!commands_.take(message, ownship_.spec().id)) return;
  if (!ownship_.flight().started()) {
    order_at_start_ = message.kind;
    return;
  }
  obey(message.kind, now);
}

void VehicleAgent::Impl::obey(CommandKind order, Instant now) {
  outbox.report(event::Commanded{order}, {}, {}, now);
  // It stands on the ground: nothing is flown before it is in the air again.
  if (ownship_.landing() && ownship_.state().on_ground()) return;
  // It has no range to climb again for, and comes home by what it does.
  const bool to_the_end = ownship_.landing() && failsafe_.facts().range_spent;
  const bool goes_on =
      to_the_end && (order == CommandKind::return_home || order == CommandKind::resume);
  lands_ = order == CommandKind::land;
  told_barred_ = false;
  const auto* response = failsafe_.update(now, {.order = order});
  if (goes_on) {
    outbox.report(event::VehicleTrouble{event::Trouble::lands_by_itself}, {}, {}, now);
  } else if (response != nullptr) {
    respond(*response, now);
  }
}

/// In its orbit at home, or in the one where its range has ended and it was not told to stay.
bool VehicleAgent::Impl::flight_ends(Instant now) const {
  if (ownship_.at_home(now)) return true;
  const bool stays = failsafe_.in(Failsafe::Action::obey) && !lands_;
  return ends_anywhere() && !stays && ownship_.in_orbit(now);
}

/// By order, or since its range is spent. It hears those below, and waits until the air there is
/// free, and by itself until it leads nobody; though not for ever, nor beyond its range: who is
/// below one that lands gives way.
void VehicleAgent::Impl::come_down(Instant now) {
  const Failsafe::Facts& facts = failsafe_.facts();
  const bool by_itself = facts.range_spent && !facts.piloted && !facts.started_anew &&
                         ownship_.config().lands_by_itself;
  const bool waits = !ownship_.landing() && (lands_ || by_itself);
  separation_.look_below(waits);
  if (!waits) {
    hears_below_at_.reset();
    may_land_at_.reset();
    return;
  }
  if (!hears_below_at_) hears_below_at_ = now + kHearsOthers;
  if (!flight_ends(now)) {
    may_land_at_.reset();
    return;
  }
  if (!may_land_at_) may_land_at_ = std::max(now, *hears_below_at_);
  if (now < *may_land_at_) return;
  const double laps_left = ownship_.range_left(now) / ownship_.lap_m();
  const auto* const choice = std::ranges::find_if(kChoices, [&](const Choice& c) {
    return now < *may_land_at_ + c.until && laps_left > c.laps_left;
  });
  const bool waits_for_all = !lands_ && leader_.leading();
  if (choice != kChoices.end() &&
      (waits_for_all || !separation_.is_free_below(ownship_.state(), choice->turns, now)))
    return;
  std::optional<event::Trouble> trouble;
  if (!ownship_.land(now)) {
    may_land_at_.reset();
    if (!std::exchange(told_barred_, true)) trouble = event::Trouble::landing_barred;
  } else if (!lands_) {
    trouble = event::Trouble::lands_by_itself;
  }
  if (trouble) outbox.report(event::VehicleTrouble{*trouble}, {}, {}, now);
}

/// With the others, and only while the operator's order to come home is what it obeys.
void VehicleAgent::Impl::on_return_flight(const ReturnFlight& message, Instant now) {
  const bool ours = message.vehicle == ownship_.spec().id && message.plan > return_plan_;
  if (!ours || !failsafe_.facts().ordered || ownship_.landing()) return;
  if (ownship_.return_along(message.timed, now)) return_plan_ = message.plan;
}

void VehicleAgent::Impl::on_bar(Bar bar, Instant now) {
  const auto* response = failsafe_.update(now, {.bar = bar});
  if (response != nullptr && ownship_.flight().started()) respond(*response, now);
}

void VehicleAgent::Impl::on_telemetry(const Telemetry& message, Instant now) {
  const bool other =
      message.vehicle == ownship_.spec().id && message.instance != ownship_.config().instance;
  if (ownship_.flight().started()) separation_.on_telemetry(message, ownship_.state(), now);
  if (!other) return;
  const auto* response = failsafe_.update(now, {.id_in_use = true});
  if (response == nullptr) return;
  outbox.report(event::VehicleTrouble{event::Trouble::id_in_use}, {}, {}, now);
  respond(*response, now);
}

/// What was flown before is nowhere near: who is given back goes on from where it is.
void VehicleAgent::Impl::on_piloted(bool piloted, Instant now) {
  const bool is_given_back = failsafe_.facts().piloted && !piloted;
  const auto* response = failsafe_.update(now, {.piloted = piloted});
  const bool stands = ownship_.landing() && ownship_.state().on_ground();
  if (!ownship_.flight().started() || stands) return;
  if (is_given_back) {
    const bool homes = ownship_.flight().homing() || ownship_.landing();
    ownship_.begin_here(now);
    failsafe_.look_again(now);
    if (response == nullptr) homes ? ownship_.fly_home(now) : ownship_.hold(now);
  }
  if (response != nullptr) respond(*response, now);
  step(now);
}

/// Who stands, takes off, comes down or is flown by a pilot is only warned.
bool VehicleAgent::Impl::may_leave_layer() const {
  if (!ownship_.flight().started() || ownship_.landing()) return false;
  if (failsafe_.facts().piloted) return false;
  const VehicleState& state = ownship_.state();
  const bool high = state.z_m > 0.5 * ownship_.spec().height_m;
  return !state.on_ground() && (high || traffic_.gives_way() || separation_.off_layer());
}

void VehicleAgent::Impl::watch_traffic(Instant now) {
  if (!traffic_.watches()) return;
  const Flight& flight = ownship_.flight();
  const Fence& fence = ownship_.config().fence;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  traffic_.step({.state = ownship_.state(),
                 .plan = flight.started() ? &flight.plan() : nullptr,
                 .layer_m = ownship_.spec().height_m,
                 .ceiling_m = fence.exists() ? fence.height_max_m : kNone,
                 .may_give_way = may_leave_layer()},
                now);
  while (auto news = traffic_.poll_event()) outbox.report(*std::move(news), {}, {}, now);
}

/// By its height alone: what it flies, and when, stays. Where it flies for the sake of aircraft, it
/// keeps separate there.
void VehicleAgent::Impl::watch_separation(Instant now) {
  const bool landed_before = std::exchange(was_landing_, ownship_.landing());
  const bool goes_around = landed_before && !ownship_.landing() && !ownship_.state().on_ground();
  if (goes_around && separation_.climb_back(ownship_.state(), ownship_.approach_m(), now)) {
    ownship_.flight().climb_from(separation_.offset_m());
  }
  if (!separation_.watches() && !traffic_.gives_way()) return;
  const Flight& flight = ownship_.flight();
  const bool by_plan = flight.started() && !ownship_.landing() && !failsafe_.facts().piloted;
  separation_.step({.state = ownship_.state(),
                    .activity = activity(),
                    .height_m = traffic_.height_m(),
                    .room = traffic_.room(),
                    .piloted = failsafe_.facts().piloted,
                    .way = by_plan ? &flight.plan().timed : nullptr},
                   now);
  while (auto news = separation_.poll_event()) outbox.report(*std::move(news), {}, {}, now);
  ownship_.flight().change_height(separation_.offset_m(), now);
}

void VehicleAgent::Impl::on_hazard(const HazardReport& told, Instant now) {
  if (!ownship_.on_hazard(told)) return;
  const Hazard& hazard = told.hazard;
  if (told.withdrawn) {  // what is flown keeps clear of more than it must; the next plan need not
    outbox.report(event::HazardWithdrawn{hazard.id}, {}, {}, now);
    return;
  }
  failsafe_.look_again(now);
  outbox.report(event::HazardKnown{hazard.id, hazard.radius_m}, {}, {}, now);
  if (!ownship_.flight().started()) return;
  const bool keeps_clear = ownship_.keeps_clear(now);
  if (keeps_clear && flyer_.run_is_open()) return;
  // Its way is barred. Another way to the same time disturbs nobody; without one the task goes back
  // to the leader, who times the coalition anew.
  if (flyer_.detour(hazard.id, now)) return;
  // A task, a survey or a route is flown on where the hazard is near but does not bar the way.
  const bool bound = flyer_.flying() || scout_.flying() || ownship_.flight().en_route(now);
  if (bound && ownship_.way_is_open(now, hazard.id) && flyer_.run_is_open()) {
    ownship_.flight().set_orbit_barred();
    return;
  }
  respond(*failsafe_.update(now, {.path_barred = true}), now);
}

/// A hazard near its way, which it flew on, bars the orbit in which it waits by now.
void VehicleAgent::Impl::watch_orbit(Instant now) {
  if (!flyer_.late() || !ownship_.flight().poll_orbit_barred()) return;
  if (ownship_.keeps_clear(now)) return;
  respond(*failsafe_.update(now, {.path_barred = true}), now);
}

/// While it still can it turns for home (or holds, to be recovered), whatever it was about. Only a
/// run that has begun is flown to its end: that was planned with the way home.
void VehicleAgent::Impl::watch_range(Instant now) {
  // Who is on the way home, or piloted, leads as long as others fly what it awarded.
  const Failsafe::Facts& facts = failsafe_.facts();
  if (facts.range_spent) leader_.hand_on(coalition::Reason::out_of_range, now);
  if (facts.left_fence) leader_.hand_on(coalition::Reason::outside_fence, now);
  if (facts.piloted) leader_.hand_on(coalition::Reason::piloted, now);
  say_last_words(now);
  if (!failsafe_.wants_range(now) || flyer_.in_run()) return;
  const double spare_m = ownship_.spare_m(now);
  const auto* response =
      failsafe_.update(now, {.spare = Failsafe::Spare{spare_m <= 0.0, ownship_.lasts_s(spare_m)}});
  if (response == nullptr) return;
  outbox.report(ownship_.range_spent(now), {}, {}, now);
  respond(*response, now);
}

/// What leads out of the new one is not flown on.
std::string VehicleAgent::Impl::keep_fence(const Fence& fence, Instant now) {
  if (ownship_.spec().height_m >= fence.height_max_m) return "its layer of height is above it";
  if (!ownship_.keep_fence(fence)) return "its home is outside of it";
  if (!ownship_.flight().started() || ownship_.landing()) return {};
  const bool keeps_in = ownship_.keeps_in(now);
  if (keeps_in && flyer_.run_is_open()) return {};
  if (const auto* response = failsafe_.update(now, {.path_barred = true})) respond(*response, now);
  step(now);
  return {};
}

void VehicleAgent::Impl::watch_fence(Instant now) {
  const bool known = failsafe_.facts().left_fence || ownship_.landing();
  if (known || !ownship_.leaves_fence(now)) return;
  const auto* response = failsafe_.update(now, {.left_fence = true});
  outbox.report(event::VehicleTrouble{event::Trouble::left_fence}, {}, {}, now);
  if (response != nullptr) respond(*response, now);
}

void VehicleAgent::Impl::respond(const Failsafe::Response& response, Instant now) {
  if (response.withdraws != coalition::Reason::none) flyer_.withdraw(response.withdraws, now);
  if (response.lead == Failsafe::Lead::put_off) {
    if (auto site = leader_.put_off(coalition::Reason::held_by_operator, now))
      scout_.put_off(*std::move(site));
  }
  if (response.ends_scouting) scout_.call_off();
  pump(now);
  if (response.lead == Failsafe::Lead::handed_on) {  // what it gave back itself is known by now
    leader_.hand_on(response.withdraws, now);
    say_last_words(now);
  }
  switch (response.manoeuvre) {
    case Failsafe::Manoeuvre::hold:
      return ownship_.hold(now);
    case Failsafe::Manoeuvre::fly_home:
      return ownship_.fly_home(now);
    case Failsafe::Manoeuvre::come_home:
      return ownship_.come_home(now);
    case Failsafe::Manoeuvre::land:
      if (!ownship_.flight().homing() && !ends_anywhere()) ownship_.fly_home(now);
      return come_down(now);
    case Failsafe::Manoeuvre::search:
      if (flyer_.flying() || scout_.flying()) return;
      return failsafe_.facts().range_spent ? ownship_.come_home(now) : ownship_.search(now);
    case Failsafe::Manoeuvre::none:
    case Failsafe::Manoeuvre::count:
      return;
  }
}

}  // namespace skein::mission
