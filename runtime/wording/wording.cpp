// SPDX-License-Identifier: Apache-2.0
#include "skein/wording/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

#include "skein/base/angles.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::wording {
namespace {

using coalition::Reason;
namespace event = mission::event;

std::string words_of(std::string_view name) {
  std::string words{name};
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// `why` after `what`, where there is one.
std::string because(std::string what, const std::string& why) {
  if (why.empty()) return what;
  return what.empty() ? why : what + ": " + why;
}

std::string names_of(const std::vector<VehicleId>& vehicles) {
  std::string text;
  for (const VehicleId vehicle : vehicles) {
    text += (text.empty() ? "" : ", ") + std::to_string(vehicle.value);
  }
  return text;
}

/// "1,850 m".
std::string metres(double length_m) {
  std::string digits = fmt::format("{:.0f}", std::abs(length_m));
  for (std::size_t before = digits.size(); before > 3; before -= 3) digits.insert(before - 3, ",");
  const bool below = length_m < 0.0 && digits != "0";
  return (below ? "-" : "") + digits + " m";
}

std::string moment(Instant t) { return fmt::format("{:.1f} s", to_seconds(t)); }

/// In the order of Reason; empty for those that speak of a vehicle.
constexpr std::array kReasons{
    std::string_view{""},
    std::string_view{"held by the operator"},
    std::string_view{"another vehicle uses this id"},
    std::string_view{"surveying"},
    std::string_view{"leading its own site"},
    std::string_view{"a task is in progress"},
    std::string_view{"not enough range left"},
    std::string_view{"no capability or load for these tasks"},
    std::string_view{"out of the leader's radio range before the coalition stands"},
    std::string_view{"it can fly one task at a time"},
    std::string_view{"its path has too many pieces"},
    std::string_view{"no path"},
    std::string_view{"the operator sends it home"},
    std::string_view{"a hazard bars its path"},
    std::string_view{"the leader opened another round"},
    std::string_view{"bid in a new round"},
    std::string_view{"not needed"},
    std::string_view{"the award came too late"},
    std::string_view{"no award came"},
    std::string_view{"no successor of the leader came"},
    std::string_view{"the lease ran out"},
    std::string_view{"done"},
    std::string_view{"failed"},
    std::string_view{"waiting for tasks whose owners are silent"},
    std::string_view{"too few of the coalition's electors are heard"},
    std::string_view{"no allocation"},
    std::string_view{"the allocation was not ready in time"},
    std::string_view{""},
    std::string_view{"not every member confirmed the award"},
    std::string_view{"tasks are open again"},
    std::string_view{"its owner reports that it failed"},
    std::string_view{"its owner fell silent"},
    std::string_view{""},
    std::string_view{"no decision of the operator in time"},
    std::string_view{"refused by the operator"},
    std::string_view{"yields to a larger reward"},
    std::string_view{"the site is done"},
    std::string_view{"its setup is not the ground station's"},
    std::string_view{"it has started anew and does not know which orders stand"},
    std::string_view{"the operator has withdrawn the site"},
    std::string_view{"the fence is in the way"},
    std::string_view{"the operator has taken the grant back"},
    std::string_view{"others fly the aircraft"},
};
static_assert(kReasons.size() == static_cast<std::size_t>(Reason::count));

/// In the order of an enumeration that ends with `count`.
template <class Enum>
using Sentences = std::array<std::string_view, static_cast<std::size_t>(Enum::count)>;

template <class Enum>
std::string_view sentence_in(const Sentences<Enum>& sentences, Enum value) {
  return value < Enum::count ? sentences.at(static_cast<std::size_t>(value)) : "";
}

std::string_view sentence_of(event::Lateness why) {
  static constexpr Sentences<event::Lateness> kSentences{
      "no decision: the plan is timed anew", "holding at the gate",
      "the lease does not reach over the delivery", "its deliveries or its lease are not certain"};
  return sentence_in(kSentences, why);
}

std::string_view sentence_of(event::TaskFailure why) {
  static constexpr Sentences<event::TaskFailure> kSentences{
      "", "not enough range left", "the path has too many pieces", "off the planned path",
      "released within it"};
  return sentence_in(kSentences, why);
}

std::string_view sentence_of(event::Trouble trouble) {
  static constexpr Sentences<event::Trouble> kSentences{
      "neither its speed nor another path keeps its time in this wind",
      "it is not where its route has it at this time: the route is not flown",
      "another vehicle uses this id; this one bids and leads no more",
      "it has started anew, and holds until it is told which orders stand",
      "a hazard or the fence bars its way down: it orbits at home, and is to be landed otherwise",
      "its circles would have to be wider in this wind than there is room for: it flies off their "
      "line; give it a greater sensor_radius_m and assess_radius_m, or wait for less wind",
      "it has left its fence, or would soon: it flies home; 'resume' when it may go on",
      "its range ends, and nobody has landed it: it lands by itself"};
  return sentence_in(kSentences, trouble);
}

std::string_view sentence_of(event::ChangeRefusal why) {
  static constexpr Sentences<event::ChangeRefusal> kSentences{
      "the one before is still flown", "it is faster than this vehicle", "it begins somewhere else",
      "it is told to hold or to come home, "
      "or its range is spent",
      "its setup is not the ground station's, or it does not know which orders stand"};
  return sentence_in(kSentences, why);
}

std::string_view sentence_of(mission::RouteObstacle why) {
  static constexpr Sentences<mission::RouteObstacle> kSentences{
      "",
      "its arcs are tighter than this vehicle's paths are planned",
      "its speed is none that this vehicle flies",
      "it leads into a hazard, or out of the fence",
      "not enough range for it",
      "it is not where the route has it, and cannot be there in time",
      "it is told to hold or to come home, or its range is spent",
      "its setup is not the ground station's",
      "it has a task",
      "it flies by orders to a formation",
      "it is no route",
      "it was not told to fly it before it began"};
  return sentence_in(kSentences, why);
}

std::string cause_of(const event::RoutesCalledOff& off) {
  const std::string who = skein::wording::text_of(off.vehicle);
  switch (off.end) {
    case mission::RoutesEnd::route_refused:
      return because(who + " does not fly its own", std::string{sentence_of(off.why)});
    case mission::RoutesEnd::not_answered:
      return who + " has not answered in time";
    case mission::RoutesEnd::not_begun:
      return who + " had not begun in time";
    case mission::RoutesEnd::by_operator:
    case mission::RoutesEnd::count:
      break;
  }
  return "by the operator";
}

std::string_view sentence_of(Given given) {
  switch (given) {
    case Given::taken_by_others:
      return "; others have the aircraft until the operator gives it back";
    case Given::launch_spent:
      return "; it is not launched unless the operator gives it back on the ground";
    case Given::yes:
    case Given::count:
      break;
  }
  return "";
}

std::string sentence_of(GiveBackRefusal why, const AutopilotNotice& notice) {
  switch (why) {
    case GiveBackRefusal::node_still_duplicate:
      return fmt::format("two nodes on the bus still have the id {}", notice.number);
    case GiveBackRefusal::wrong_state:
      return "the companion is in the state " + notice.detail;
    case GiveBackRefusal::taken_since:
      return "it was taken after the operator's word";
    case GiveBackRefusal::no_position:
      return "it does not know where it is";
    case GiveBackRefusal::not_flying:
      return "it is not armed and in the air";
    case GiveBackRefusal::hovers_low:
      return fmt::format("it hovers below {} m, too low to pass over to its wings: climb first",
                         notice.number);
    case GiveBackRefusal::none:
    case GiveBackRefusal::count:
      break;
  }
  return "";
}

constexpr std::string_view kPiloted = "; no setpoints until the operator gives it back";

/// In the order of AutopilotNews.
constexpr std::array kAutopilotNews{
    std::string_view{"the autopilot has rebooted"},
    std::string_view{"looking for the autopilot again"},
    std::string_view{"the autopilot has gone before it was prepared; looking for it again"},
    std::string_view{"found an autopilot, system {number}, in {detail}"},
    std::string_view{"the autopilot is ready{given}"},
    std::string_view{"the autopilot has disarmed"},
    std::string_view{"the autopilot does not arm{given}"},
    std::string_view{"the launch was broken off{given}"},
    std::string_view{"armed; taking off"},
    std::string_view{"landing at its place"},
    std::string_view{"flying the companion's setpoints"},
    std::string_view{"the mode was changed to {detail} by the pilot or a failsafe{piloted}"},
    std::string_view{"it was armed by others, in {detail}{piloted}"},
    std::string_view{"the autopilot does not obey{piloted}"},
    std::string_view{"it has not climbed to {number} m in time (TKOFF_ALT?){piloted}"},
    std::string_view{"no frame comes from the flight controller"},
    std::string_view{"the autopilot is silent, though its node is on the bus"},
    std::string_view{"two nodes on the bus have the id {number}: nothing is sent any more; give "
                     "each its own, then give the aircraft back"},
    std::string_view{"the aircraft cannot be given to the companion: {refusal}"},
    std::string_view{"given back on the ground"},
    std::string_view{"an autopilot of system {number} is on the line, and not heeded: the "
                     "configuration names {detail}; if it is this aircraft's, set "
                     "flight_controller.system_id to {number}, or SYSID_THISMAV"},
    std::string_view{"the autopilot is of make {number}, not an ArduPilot (3); choose another kind "
                     "of flight controller"},
    std::string_view{"the autopilot flies an aircraft of MAV_TYPE {number}, which is no {detail}; "
                     "mend the airframe in the configuration"},
    std::string_view{"the autopilot runs ArduPilot {detail}, older than 4.5; update its firmware"},
    std::string_view{"the autopilot runs ArduPilot {detail}"},
    std::string_view{"autopilot: {detail}"},
    std::string_view{"the autopilot refuses {detail}"},
    std::string_view{"the aircraft is not flown with the autopilot's parameters: {detail}"},
    std::string_view{"a parameter of the autopilot was changed: {detail}"},
    std::string_view{"not one frame comes from the bus {detail}: check the interface "
                     "(flight_controller.can), power, cable, terminators and bit rate "
                     "(CAN_P1_BITRATE)"},
    std::string_view{"no node {number} is on the bus; heard are: {detail}. Set "
                     "flight_controller.node_id, or the autopilot's CAN_D1_UC_NODE to {number}"},
    std::string_view{"node {number} has no serial port for this companion: set {detail} and reboot "
                     "it"},
    std::string_view{"the flight controller's serial port over CAN is for node {detail} and reboot "
                     "it"},
    std::string_view{"the serial port of node {number} answers, but no HEARTBEAT comes through it: "
                     "set CAN_D1_UC_S1_PRO 2 and reboot it; if it is, the autopilot does not "
                     "start"},
    std::string_view{"the autopilot has not told {detail}, and is not flown before: do its sensors "
                     "start, has it a GNSS fix?"},
    std::string_view{
        "the autopilot's GNSS or its filter is missing or not healthy: the aircraft is "
        "neither taken nor launched until it knows where it is"},
    std::string_view{"the autopilot would not arm: {detail}"},
    std::string_view{"the autopilot is heard again; the pilot or a failsafe has it still, in "
                     "{detail}"},
    std::string_view{"the landing is uploaded and read back: {detail}"},
    std::string_view{"it is not landed, and flies on: {detail}"},
    std::string_view{"the landing is called off; going around"},
    std::string_view{"it is below {number} m: it lands, whatever was ordered since"},
    std::string_view{"the autopilot has the fence: {number} corners, read back"},
    std::string_view{"nothing is flown, as the fence is not the autopilot's: {detail}"},
    std::string_view{
        "its packets are not signed with the key of flight_controller.signing_key, and "
        "are not heeded: give the autopilot that key (MAVLink signing, at a ground "
        "station over USB), or leave signing_key out"},
    std::string_view{"it hovers below {number} m, too low to pass over to its wings: its pilot has "
                     "to climb"},
    std::string_view{"it hovers on, {number} s after it was told to fly on its wings: its pilot "
                     "has to take it"},
};
static_assert(kAutopilotNews.size() == static_cast<std::size_t>(AutopilotNews::count));

/// What stays so of who comes too near to whom.
std::string how_near(const event::SeparationWarning& e) {
  const std::string who = e.gives_way == VehicleId{}
                              ? "neither has room to give way"
                              : text_of(e.gives_way) + " gives way by its height";
  return fmt::format("{} to the side, {} in height; {}", metres(e.horizontal_m),
                     metres(e.vertical_m), who);
}
std::string how_near(const event::TrafficWarning& e) {
  return fmt::format("{} to the side, {} in height; {}", metres(e.horizontal_m),
                     metres(e.vertical_m),
                     e.gives_way ? "gives way by its height"
                                 : "it does not give way (no room, no time, or it may not)");
}

/// One for each alternative of EventBody: one that is missing does not compile.
struct News {
  std::string operator()(const event::SiteDetected& e) const {
    return fmt::format("{:.0f} m away", e.range_m);
  }
  std::string operator()(const event::SurveyStarted& /*e*/) const { return ""; }
  std::string operator()(const event::SurveyDone& e) const { return "begun at " + moment(e.begun); }
  std::string operator()(const event::Announced& e) const {
    return because(fmt::format("{} tasks", e.tasks), text_of(e.why));
  }
  std::string operator()(const event::BidSent& e) const { return "there at " + moment(e.eta); }
  std::string operator()(const event::BidDeclined& e) const { return text_of(e.why); }
  std::string operator()(const event::AllocationDone& e) const {
    return fmt::format("{} bids; {}: J {:.4f}, {} (took {:.3f} s)", e.bids, to_string(e.method),
                       e.objective,
                       e.proven ? "proven" : fmt::format("at most {:.4f} below the optimum", e.gap),
                       to_seconds(e.took));
  }
  std::string operator()(const event::AllocationFailed& e) const {
    return fmt::format("{} bids; {}", e.bids, e.detail);
  }
  std::string operator()(const event::Awarded& e) const { return fmt::format("{} tasks", e.tasks); }
  std::string operator()(const event::Confirmed& e) const { return "for " + moment(e.planned); }
  std::string operator()(const event::Refused& e) const { return text_of(e.why); }
  std::string operator()(const event::CoalitionFormed& e) const {
    return fmt::format("{} vehicles", e.vehicles);
  }
  std::string operator()(const event::Cancelled& e) const { return text_of(e.why); }
  std::string operator()(const event::Released& e) const { return text_of(e.why); }
  std::string operator()(const event::LeaseGranted& e) const { return "until " + moment(e.until); }
  std::string operator()(const event::LeaseEnded& e) const {
    return e.held ? "the leader is silent: the plan is held" : text_of(e.why);
  }
  std::string operator()(const event::AuthorisationRequested& e) const {
    return "to be decided by " + moment(e.decide_by);
  }
  std::string operator()(const event::Authorised& e) const { return "by " + e.by; }
  std::string operator()(const event::AuthorisationRefused& e) const { return "by " + e.by; }
  std::string operator()(const event::AuthorisationLate& e) const {
    return std::string{sentence_of(e.why)};
  }
  std::string operator()(const event::TaskStarted& /*e*/) const { return ""; }
  std::string operator()(const event::TaskDone& e) const {
    return "planned for " + moment(e.planned);
  }
  std::string operator()(const event::TaskFailed& e) const {
    return because(std::string{sentence_of(e.why)}, e.detail);
  }
  std::string operator()(const event::Commanded& e) const {
    return "the operator commands: " + words_of(to_string(e.command));
  }
  std::string operator()(const event::PlanRetimed& e) const {
    return fmt::format("at {:.1f} m/s, to the same time in this wind", e.speed_mps);
  }
  std::string operator()(const event::PlanDetoured& /*e*/) const {
    return "around the hazard, to the same time";
  }
  std::string operator()(const event::RangeSpent& e) const {
    const char* const left = e.by_battery ? "its battery leaves" : "range left";
    if (!e.comes_home) {
      return fmt::format("holds, to be recovered: {} {}", left, metres(e.range_left_m));
    }
    return fmt::format("flies home: {} {}{}", left, metres(e.range_left_m),
                       e.home_m < 0.0 ? "" : ", home is " + metres(e.home_m) + " away");
  }
  std::string operator()(const event::ReliefBegun& /*e*/) const {
    return "the site's leader is lost: goes there to lead";
  }
  std::string operator()(const event::HazardKnown& e) const {
    return fmt::format("hazard {}, radius {:.0f} m", e.hazard.value, e.radius_m);
  }
  std::string operator()(const event::ConflictYielded& e) const {
    return e.leads ? text_of(e.to) + " leads the site" : "to " + text_of(e.to);
  }
  std::string operator()(const event::Monitoring& e) const {
    return because(fmt::format("{} tasks", e.tasks), text_of(e.why));
  }
  std::string operator()(const event::LeaderReplaced& e) const {
    return fmt::format("takes over from {}, followed by {}", text_of(e.lost), e.supporters);
  }
  std::string operator()(const event::SiteDone& /*e*/) const { return ""; }
  std::string operator()(const event::ChangeBegun& e) const {
    return fmt::format("change {}, {}: {} vehicles in {:.1f} s, separation {:.2f} m at least",
                       e.number, text_of(e), e.vehicles, to_seconds(e.takes), e.separation_m);
  }
  std::string operator()(const event::ChangeTakenUp& e) const {
    return fmt::format("change {}", e.number);
  }
  std::string operator()(const event::PlaceReached& e) const {
    return fmt::format("of change {}", e.number);
  }
  std::string operator()(const event::FormationHeld& e) const {
    return fmt::format("the last in its place {:.2f} s after the first", to_seconds(e.spread));
  }
  std::string operator()(const event::ScriptDone& /*e*/) const { return ""; }
  std::string operator()(const event::TaskLost& e) const {
    return text_of(coalition::Why{e.why.reason}) + ": " + text_of(e.why.vehicle);
  }
  std::string operator()(const event::TaskUnknown& e) const {
    return "may have been flown: " + text_of(e.owner) + " fell silent; the operator must look";
  }
  std::string operator()(const event::VehicleTrouble& e) const {
    return std::string{sentence_of(e.trouble)};
  }
  std::string operator()(const event::FleetWarning& e) const {
    std::string who = text_of(e.vehicle);
    switch (e.news) {
      case event::FleetNews::stranger:
        return who + " takes part, though no list of this ground station has it";
      case event::FleetNews::duplicate:
        return "two vehicles answer to the id of " + who +
               "; nothing is commanded to it until one of them is stopped or renumbered";
      case event::FleetNews::unique:
        return "the id of " + who + " is unique again";
      case event::FleetNews::restarted:
        return who + " has started anew";
      case event::FleetNews::silent:
        return who + " is silent";
      case event::FleetNews::heard_again:
        return fmt::format("{} is heard again after {} s", who,
                           std::chrono::round<std::chrono::seconds>(e.silence).count());
      case event::FleetNews::not_landed:
        return fmt::format("{} has not landed {} s after its turn began; the next one lands", who,
                           std::chrono::round<std::chrono::seconds>(e.silence).count());
      case event::FleetNews::count:
        break;
    }
    return who;
  }
  std::string operator()(const event::ChangeRefused& e) const {
    return fmt::format("change {} is not flown: {}", e.number, sentence_of(e.why));
  }
  std::string operator()(const event::Waiting& e) const {
    const std::string waits = fmt::format("waits in change {}: ", e.number);
    switch (e.what) {
      case event::WaitsFor::beginning:
        return waits + text_of(e.vehicle) + " has not begun";
      case event::WaitsFor::passing:
        return waits + text_of(e.vehicle) + " has yet to pass";
      case event::WaitsFor::order:
      case event::WaitsFor::count:
        break;
    }
    return waits + "it is told to hold";
  }
  std::string operator()(const event::FormationWarning& e) const {
    std::string names = names_of(e.vehicles);
    if (e.more > 0) names += fmt::format(" and {} more", e.more);
    std::string who = (e.vehicles.size() == 1 ? "vehicle " : "vehicles ") + names;
    switch (e.news) {
      case event::FormationNews::lost:
        return who + " is silent: its way is kept clear";
      case event::FormationNews::lost_on_its_way:
        return who +
               " is silent: its way is kept clear, and the order is given again to the others once "
               "they rest";
      case event::FormationNews::back:
        return who + " is back; the next order takes it along";
      case event::FormationNews::not_begun:
        return who + " has not begun the change: the order is given again";
      case event::FormationNews::drift_corrected:
        return "drift is corrected of " + who;
      case event::FormationNews::awaited:
        return "the script waits for vehicles not heard yet: " + names;
      case event::FormationNews::lost_on_track:
        return who + " is silent: its place stays empty, and the others keep to other heights";
      case event::FormationNews::astray:
        return who + " does not fly what it is told: the others keep clear of it until it is back";
      case event::FormationNews::off_place:
        return who + " came to rest beside " +
               (e.vehicles.size() == 1 ? "its place" : "their places") +
               ", by more than the tolerance";
      case event::FormationNews::count:
        break;
    }
    return who;
  }
  std::string operator()(const event::OrderWaits& e) const {
    if (e.line == 0) return "the order cannot be given again: " + e.detail;
    return fmt::format("the script waits at '{}': {}", e.order, e.detail);
  }
  std::string operator()(const event::FlightWarning& e) const { return text_of(e.notice); }
  std::string operator()(const event::SetupDiffers& e) const {
    return text_of(e.node) + " has " + mission::text_of({e.keys, e.clock_ahead_s}) +
           ": they do not work together";
  }
  std::string operator()(const event::SetupAgrees& e) const {
    return text_of(e.node) + " has the same setup again";
  }
  std::string operator()(const event::OrdersKnown& e) const {
    return "told by the " + text_of(e.told_by);
  }
  std::string operator()(const event::SiteTold& e) const {
    return text_of(e.surveyor) + " is to survey it";
  }
  std::string operator()(const event::SiteWithdrawn& e) const { return "by " + e.by; }
  std::string operator()(const event::HazardWithdrawn& e) const {
    return fmt::format("hazard {}", e.hazard.value);
  }
  std::string operator()(const event::SiteProposed& e) const {
    const std::string by = e.detector.empty() ? "a detector" : e.detector;
    return fmt::format("{} {} {}: proposal {} waits for the operator", by,
                       e.seen_by == kGroundStation ? "of another agency tells of"
                                                   : "of " + text_of(e.seen_by) + " has seen",
                       words_of(to_string(e.kind)), e.number);
  }
  std::string operator()(const event::ProposalAnswered& e) const {
    return fmt::format("proposal {} is {} by {}", e.number, e.accepted ? "taken" : "dismissed",
                       e.by);
  }
  std::string operator()(const event::RouteAnswered& e) const {
    return fmt::format("plan {}: {}", e.plan, text_of(e.state, e.why));
  }
  std::string operator()(const event::RoutesGiven& e) const {
    return fmt::format("plan {} of {} vehicles from {:.1f} s on{}", e.plan, e.vehicles,
                       to_seconds(e.begins), e.taken ? ": all have taken theirs" : "");
  }
  std::string operator()(const event::RoutesCalledOff& e) const {
    return fmt::format("the routes of plan {} are called off: {}", e.plan, cause_of(e));
  }
  std::string operator()(const event::ReturnPlanned& e) const {
    return fmt::format(
        "return {}: {} vehicles come home on ways clear of each other, the last in "
        "{:.0f} s",
        e.plan, e.vehicles, to_seconds(e.takes));
  }
  std::string operator()(const event::SeparationWarning& e) const {
    return fmt::format("{} in {:.0f} s: {}", text_of(e.other), to_seconds(e.in), how_near(e));
  }
  std::string operator()(const event::SeparationRestored& e) const {
    return "clear of " + text_of(e.other);
  }
  std::string operator()(const event::AuthorisationWithdrawn& e) const {
    return fmt::format("{} has taken the grant back", e.by);
  }
  std::string operator()(const event::FenceAnswered& e) const {
    return e.taken
               ? fmt::format("keeps the fence of order {}", e.number)
               : because(fmt::format("does not take the fence of order {}", e.number), e.detail);
  }
  std::string operator()(const event::TrafficWarning& e) const {
    return fmt::format("aircraft {:06x} in {:.0f} s: {}", e.address, to_seconds(e.in), how_near(e));
  }
  std::string operator()(const event::TrafficClear& e) const {
    return fmt::format("clear of aircraft {:06x}", e.address);
  }
  std::string operator()(const event::CommandHanded& e) const {
    return e.here ? "this ground station has the command: " + e.who
                  : e.who + " has the command: this ground station only watches";
  }
  std::string operator()(const event::ReturnAlone& e) const {
    return because(text_of(e.vehicle) + " comes home on its own way", e.detail);
  }
};

/// Does the event concern one task, rather than a site or nothing?
bool names_task(mission::EventKind kind) {
  using enum mission::EventKind;
  return kind == task_started || kind == task_done || kind == task_failed ||
         kind == lease_granted || kind == lease_ended || kind == task_lost || kind == task_unknown;
}

}  // namespace

std::string text_of(VehicleId vehicle) {
  return vehicle == kGroundStation ? "ground station" : fmt::format("vehicle {}", vehicle.value);
}

std::string text_of(mission::RouteState state, mission::RouteObstacle why) {
  return because(words_of(to_string(state)), std::string{sentence_of(why)});
}

std::string text_of(const coalition::Why& why) {
  std::string text{kReasons.at(static_cast<std::size_t>(why.reason))};
  if (why.reason == Reason::award_refused) text = text_of(why.vehicle) + " refused";
  if (why.reason == Reason::superseded) text = text_of(why.vehicle) + " leads the site";
  const bool only_detail =
      why.reason == Reason::no_path || why.reason == Reason::no_allocation;  // it says it better
  if (only_detail && !why.detail.empty()) return why.detail;
  return because(std::move(text), why.detail);
}

std::string text_of(const mission::event::ChangeBegun& change) {
  std::string text = change.correction ? "correction of " : "";
  text += to_string(change.order);
  if (change.order == mission::OrderKind::fly_along ||
      change.order == mission::OrderKind::reshape || change.order == mission::OrderKind::form) {
    text.append(" ").append(formation::to_string(change.shape));
  }
  return text.append(", ").append(formation::to_string(change.way));
}

std::string text_of(const AutopilotNotice& notice) {
  const auto pattern = kAutopilotNews.at(static_cast<std::size_t>(notice.news));
  return fmt::format(fmt::runtime(pattern), fmt::arg("number", notice.number),
                     fmt::arg("detail", notice.detail), fmt::arg("piloted", kPiloted),
                     fmt::arg("given", sentence_of(notice.given)),
                     fmt::arg("refusal", sentence_of(notice.refusal, notice)));
}

std::string news_of(const mission::MissionEvent& event) { return std::visit(News{}, event.body); }

std::string lasting_news_of(const mission::MissionEvent& event) {
  if (const auto* near = std::get_if<event::SeparationWarning>(&event.body)) {
    return text_of(near->other) + ": " + how_near(*near);
  }
  if (const auto* near = std::get_if<event::TrafficWarning>(&event.body)) {
    return fmt::format("aircraft {:06x}: {}", near->address, how_near(*near));
  }
  return news_of(event);
}

std::optional<Instant> closest_of(const mission::MissionEvent& event) {
  if (const auto* near = std::get_if<event::SeparationWarning>(&event.body)) {
    return event.time + near->in;
  }
  if (const auto* near = std::get_if<event::TrafficWarning>(&event.body)) {
    return event.time + near->in;
  }
  return std::nullopt;
}

std::string closest_text(Instant closest, Instant now) {
  return now < closest ? fmt::format("closest in {:.0f} s", to_seconds(closest - now))
                       : fmt::format("was closest {:.0f} s ago", to_seconds(now - closest));
}

std::string text_of(const mission::MissionEvent& event) {
  const bool warning = mission::is_warning(event.kind());
  std::string line =
      text_of(event.vehicle) + ": " + (warning ? "warning" : words_of(to_string(event.kind())));
  if (names_task(event.kind())) {
    line += ", " + to_string(event.task);
  } else if (event.task.site != SiteId{}) {
    line += fmt::format(", site {}", event.task.site.value);
  }
  return because(std::move(line), news_of(event));
}

std::string bearing_text(double heading_rad) {
  const double degrees = std::round(compass_deg_from_heading(heading_rad));
  return fmt::format("{:03.0f} deg", std::fmod(degrees, 360.0));
}

std::string bearing_digits(double heading_rad) {
  std::string digits = fmt::format("{:.6g}", compass_deg_from_heading(heading_rad));
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole < 3) digits.insert(0, 3 - whole, '0');
  return digits == "360" ? "000" : digits;
}

std::string one_line(std::string lines) {
  while (lines.ends_with('\n')) lines.pop_back();
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos;) {
    lines.replace(at, 1, "; ");
  }
  return lines;
}

std::string place_text(const Vec2& position) {
  return fmt::format("{:.0f} m east, {:.0f} m north", position.x(), position.y());
}

std::string moment_text(Instant t, std::int64_t epoch_unix_ns) {
  const auto unix_time = std::chrono::floor<std::chrono::seconds>(
      std::chrono::nanoseconds{epoch_unix_ns} + t.time_since_epoch());
  const std::chrono::hh_mm_ss clock{unix_time - std::chrono::floor<std::chrono::days>(unix_time)};
  return fmt::format("{} ({:02}:{:02}:{:02} UTC)", moment(t), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count());
}

std::string check_line(mission::CheckVerdict verdict, std::string_view what, std::string_view found,
                       std::string_view remedy) {
  static constexpr std::array<std::string_view, 3> kVerdicts{"ok", "warn", "FAIL"};
  return fmt::format("{:<6}{}: {}{}{}", kVerdicts.at(static_cast<std::size_t>(verdict)), what,
                     found, remedy.empty() ? "" : "; ", remedy);
}

}  // namespace skein::wording
