// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/domain/autopilot_notice.hpp"
#include "skein/domain/task.hpp"
#include "skein/formation/change_planner.hpp"
#include "skein/formation/shapes.hpp"
#include "skein/planning/allocation.hpp"

/// What a node tells of itself, or the ground station of others: a closed set of structs with their
/// own fields (idl/events.idl). Nobody decides on a sentence: those are made at the edge
/// (runtime/wording). A `detail` is a planner's or an autopilot's own words: shown, never compared.
namespace skein::mission {

enum class CommandKind : std::uint8_t {
  hold,
  resume,  ///< go on with the mission
  return_home,
  give_back,  ///< of an aircraft that others fly: the companion takes it. To one vehicle, never all
  count
};
[[nodiscard]] std::string_view to_string(CommandKind kind);

/// What an operator can ask of a formation. Every order moves all vehicles that are heard.
enum class OrderKind : std::uint8_t {
  take_off,  ///< from the ground straight up to the rally's height
  rally,     ///< to the rally
  form,      ///< a shape; low ids take the places where they are few, the others wait at the rally
  land,      ///< straight down
  count
};
[[nodiscard]] std::string_view to_string(OrderKind kind);

namespace event {

/// Why a task does not begin at its time.
enum class Lateness : std::uint8_t {
  no_decision,      ///< of the operator: the plan is timed anew
  not_authorised,   ///< it holds at the gate
  lease_too_short,  ///< it does not reach over the delivery
  not_certain,      ///< the lease of an assessment, or that its deliveries are over
  count
};
enum class TaskFailure : std::uint8_t {
  no_plan,          ///< `detail` has the planner's words
  out_of_range,     ///< not enough range is left
  path_too_long,    ///< it has too many pieces
  off_path,         ///< off the planned path
  released_within,  ///< the lease ended within it; the load counts as used
  count
};
/// Of a vehicle, about itself.
enum class Trouble : std::uint8_t {
  untimely,         ///< neither its speed nor another path keeps its time in this wind
  route_not_flown,  ///< it is not where its route has it at this time
  id_in_use,        ///< by another vehicle; this one bids and leads no more
  count
};
/// Of the ground station, about one vehicle.
enum class FleetNews : std::uint8_t {
  stranger,   ///< it speaks, but is not in the fleet
  duplicate,  ///< two vehicles answer to its id; nothing is commanded to it meanwhile
  unique,     ///< its id is so again
  restarted,  ///< it has started anew
  silent,
  heard_again,  ///< after `silence`
  count
};
enum class ChangeRefusal : std::uint8_t {
  another_is_flown,  ///< the one before
  too_fast,          ///< for this vehicle
  begins_elsewhere,
  count
};
enum class WaitsFor : std::uint8_t {
  order,      ///< it is told to hold
  beginning,  ///< `vehicle` has not begun
  passing,    ///< `vehicle` has yet to pass
  count
};
/// Of the ground station, about the vehicles of a formation.
enum class FormationNews : std::uint8_t {
  lost,             ///< silent: its way is kept clear
  lost_on_its_way,  ///< the same, and the order is given again to the others once they rest
  back,             ///< heard again: the next order takes it along
  not_begun,        ///< the change: the order is given again
  drift_corrected,
  awaited,  ///< by the script: not heard yet
  count
};
[[nodiscard]] std::string_view to_string(Lateness why);
[[nodiscard]] std::string_view to_string(TaskFailure why);
[[nodiscard]] std::string_view to_string(Trouble trouble);
[[nodiscard]] std::string_view to_string(FleetNews news);
[[nodiscard]] std::string_view to_string(ChangeRefusal why);
[[nodiscard]] std::string_view to_string(WaitsFor what);
[[nodiscard]] std::string_view to_string(FormationNews news);

struct SiteDetected {
  double range_m = 0.0;  ///< from the finder
  friend auto operator<=>(const SiteDetected&, const SiteDetected&) = default;
};
struct SurveyStarted {
  Instant begun{};
  friend auto operator<=>(const SurveyStarted&, const SurveyStarted&) = default;
};
struct SurveyDone {
  Instant begun{};
  friend auto operator<=>(const SurveyDone&, const SurveyDone&) = default;
};
struct Announced {
  std::uint8_t tasks = 0;
  coalition::Why why{};  ///< another round; none: the first
  friend auto operator<=>(const Announced&, const Announced&) = default;
};
struct BidSent {
  Instant eta{};  ///< at the site
  friend auto operator<=>(const BidSent&, const BidSent&) = default;
};
struct BidDeclined {
  coalition::Why why{};
  friend auto operator<=>(const BidDeclined&, const BidDeclined&) = default;
};
struct AllocationDone {
  Duration took{};
  std::uint8_t bids = 0;
  planning::AllocationMethod method = planning::AllocationMethod::best;
  double objective = 0.0;
  bool proven = false;
  double gap = 0.0;  ///< to the optimum, at most
  friend auto operator<=>(const AllocationDone&, const AllocationDone&) = default;
};
struct AllocationFailed {
  std::uint8_t bids = 0;
  std::string detail{};
  friend auto operator<=>(const AllocationFailed&, const AllocationFailed&) = default;
};
struct Awarded {
  std::uint8_t tasks = 0;
  friend auto operator<=>(const Awarded&, const Awarded&) = default;
};
struct Confirmed {
  Instant planned{};  ///< TaskAssignment::time
  friend auto operator<=>(const Confirmed&, const Confirmed&) = default;
};
struct Refused {
  coalition::Why why{};
  friend auto operator<=>(const Refused&, const Refused&) = default;
};
struct CoalitionFormed {
  std::uint8_t vehicles = 0;  ///< its leader among them
  friend auto operator<=>(const CoalitionFormed&, const CoalitionFormed&) = default;
};
struct Cancelled {
  coalition::Why why{};
  friend auto operator<=>(const Cancelled&, const Cancelled&) = default;
};
struct Released {
  coalition::Why why{};
  friend auto operator<=>(const Released&, const Released&) = default;
};
struct LeaseGranted {
  Instant until{};
  friend auto operator<=>(const LeaseGranted&, const LeaseGranted&) = default;
};
struct LeaseEnded {
  coalition::Why why{};
  bool held = false;  ///< the plan is held for a successor of the leader: the lease may come back
  friend auto operator<=>(const LeaseEnded&, const LeaseEnded&) = default;
};
struct AuthorisationRequested {
  Instant decide_by{};
  friend auto operator<=>(const AuthorisationRequested&, const AuthorisationRequested&) = default;
};
struct Authorised {
  std::string by{};
  friend auto operator<=>(const Authorised&, const Authorised&) = default;
};
struct AuthorisationRefused {
  std::string by{};
  friend auto operator<=>(const AuthorisationRefused&, const AuthorisationRefused&) = default;
};
struct AuthorisationLate {
  Lateness why = Lateness::no_decision;
  friend auto operator<=>(const AuthorisationLate&, const AuthorisationLate&) = default;
};
struct TaskStarted {
  Instant begun{};
  friend auto operator<=>(const TaskStarted&, const TaskStarted&) = default;
};
struct TaskDone {
  Instant planned{};  ///< TaskAssignment::time
  friend auto operator<=>(const TaskDone&, const TaskDone&) = default;
};
struct TaskFailed {
  TaskFailure why = TaskFailure::no_plan;
  Instant planned{};
  std::string detail{};
  friend auto operator<=>(const TaskFailed&, const TaskFailed&) = default;
};
struct Commanded {
  CommandKind command = CommandKind::hold;
  friend auto operator<=>(const Commanded&, const Commanded&) = default;
};
struct PlanRetimed {  ///< to the same time in this wind
  double speed_mps = 0.0;
  friend auto operator<=>(const PlanRetimed&, const PlanRetimed&) = default;
};
struct PlanDetoured {  ///< around a hazard, to the same time
  HazardId hazard{};
  friend auto operator<=>(const PlanDetoured&, const PlanDetoured&) = default;
};
struct RangeSpent {  ///< but for the way home
  double range_left_m = 0.0;
  bool comes_home = false;  ///< otherwise it holds, to be recovered
  friend auto operator<=>(const RangeSpent&, const RangeSpent&) = default;
};
struct ReliefBegun {  ///< the site's leader is lost: it goes there to lead
  Instant heard{};    ///< its leader last
  friend auto operator<=>(const ReliefBegun&, const ReliefBegun&) = default;
};
struct HazardKnown {
  HazardId hazard{};
  double radius_m = 0.0;
  friend auto operator<=>(const HazardKnown&, const HazardKnown&) = default;
};
struct ConflictYielded {
  VehicleId to{};
  double reward = 0.0;  ///< its own
  bool leads = false;   ///< the other leads this very site
  friend auto operator<=>(const ConflictYielded&, const ConflictYielded&) = default;
};
struct Monitoring {
  std::uint8_t tasks = 0;
  coalition::Why why{};
  friend auto operator<=>(const Monitoring&, const Monitoring&) = default;
};
struct LeaderReplaced {
  VehicleId lost{};
  std::uint8_t supporters = 0;
  friend auto operator<=>(const LeaderReplaced&, const LeaderReplaced&) = default;
};
struct SiteDone {
  std::uint8_t tasks = 0;
  friend auto operator<=>(const SiteDone&, const SiteDone&) = default;
};
struct ChangeBegun {  ///< of a formation, by the ground station
  std::uint32_t number = 0;
  OrderKind order = OrderKind::rally;
  formation::ShapeKind shape = formation::ShapeKind::line_abreast;  ///< of `form`
  bool correction = false;                                          ///< of drift; the order stays
  formation::Way way = formation::Way::straight;
  std::uint8_t vehicles = 0;
  Duration takes{};
  double separation_m = 0.0;  ///< of any two, at least
  friend auto operator<=>(const ChangeBegun&, const ChangeBegun&) = default;
};
struct ChangeTakenUp {
  std::uint32_t number = 0;
  friend auto operator<=>(const ChangeTakenUp&, const ChangeTakenUp&) = default;
};
struct PlaceReached {
  std::uint32_t number = 0;
  friend auto operator<=>(const PlaceReached&, const PlaceReached&) = default;
};
struct FormationHeld {
  Duration spread{};  ///< from the first in its place to the last
  friend auto operator<=>(const FormationHeld&, const FormationHeld&) = default;
};
struct ScriptDone {
  std::uint32_t orders = 0;
  friend auto operator<=>(const ScriptDone&, const ScriptDone&) = default;
};

// Those that come from here on are warnings.
struct TaskLost {
  coalition::Why why{};  ///< its owner: Why::vehicle
  friend auto operator<=>(const TaskLost&, const TaskLost&) = default;
};
/// A delivery that may have been flown by who fell silent: the operator must look.
struct TaskUnknown {
  VehicleId owner{};
  friend auto operator<=>(const TaskUnknown&, const TaskUnknown&) = default;
};
struct VehicleTrouble {
  Trouble trouble = Trouble::untimely;
  friend auto operator<=>(const VehicleTrouble&, const VehicleTrouble&) = default;
};
struct FleetWarning {
  FleetNews news = FleetNews::silent;
  VehicleId vehicle{};
  Duration silence{};
  friend auto operator<=>(const FleetWarning&, const FleetWarning&) = default;
};
struct ChangeRefused {
  std::uint32_t number = 0;
  ChangeRefusal why = ChangeRefusal::another_is_flown;
  friend auto operator<=>(const ChangeRefused&, const ChangeRefused&) = default;
};
struct Waiting {  ///< in a change, for long
  std::uint32_t number = 0;
  WaitsFor what = WaitsFor::order;
  VehicleId vehicle{};
  friend auto operator<=>(const Waiting&, const Waiting&) = default;
};
struct FormationWarning {
  FormationNews news = FormationNews::lost;
  std::vector<VehicleId> vehicles{};
  friend auto operator<=>(const FormationWarning&, const FormationWarning&) = default;
};
/// An order could not be given, or not again; `line` is of the script, from 1, and 0 without one.
struct OrderWaits {
  std::uint32_t line = 0;
  std::string order{};
  std::string detail{};
  friend auto operator<=>(const OrderWaits&, const OrderWaits&) = default;
};
struct FlightWarning {
  AutopilotNotice notice{};
  friend auto operator<=>(const FlightWarning&, const FlightWarning&) = default;
};

}  // namespace event

/// In the order of EventBody.
enum class EventKind : std::uint8_t {
  site_detected,
  survey_started,
  survey_done,
  announced,
  bid_sent,
  bid_declined,
  allocation_done,
  allocation_failed,
  awarded,
  confirmed,
  refused,
  coalition_formed,
  cancelled,
  released,
  lease_granted,
  lease_ended,
  authorisation_requested,
  authorised,
  authorisation_refused,
  authorisation_late,
  task_started,
  task_done,
  task_failed,
  commanded,
  plan_retimed,
  plan_detoured,
  range_spent,
  relief_begun,
  hazard_known,
  conflict_yielded,
  monitoring,
  leader_replaced,
  site_done,
  change_begun,
  change_taken_up,
  place_reached,
  formation_held,
  script_done,
  task_lost,
  task_unknown,
  vehicle_trouble,
  fleet_warning,
  change_refused,
  waiting,
  formation_warning,
  order_waits,
  flight_warning,
  count
};
[[nodiscard]] std::string_view to_string(EventKind kind);
/// To be looked at by a person.
[[nodiscard]] constexpr bool is_warning(EventKind kind) { return kind >= EventKind::task_lost; }

using EventBody = std::variant<
    event::SiteDetected, event::SurveyStarted, event::SurveyDone, event::Announced, event::BidSent,
    event::BidDeclined, event::AllocationDone, event::AllocationFailed, event::Awarded,
    event::Confirmed, event::Refused, event::CoalitionFormed, event::Cancelled, event::Released,
    event::LeaseGranted, event::LeaseEnded, event::AuthorisationRequested, event::Authorised,
    event::AuthorisationRefused, event::AuthorisationLate, event::TaskStarted, event::TaskDone,
    event::TaskFailed, event::Commanded, event::PlanRetimed, event::PlanDetoured, event::RangeSpent,
    event::ReliefBegun, event::HazardKnown, event::ConflictYielded, event::Monitoring,
    event::LeaderReplaced, event::SiteDone, event::ChangeBegun, event::ChangeTakenUp,
    event::PlaceReached, event::FormationHeld, event::ScriptDone, event::TaskLost,
    event::TaskUnknown, event::VehicleTrouble, event::FleetWarning, event::ChangeRefused,
    event::Waiting, event::FormationWarning, event::OrderWaits, event::FlightWarning>;
static_assert(std::variant_size_v<EventBody> == static_cast<std::size_t>(EventKind::count));
/// That alternative, with its defaults.
[[nodiscard]] EventBody body_of(EventKind kind);

/// Something worth a line in the log and a mark on the time line.
struct MissionEvent {
  VehicleId vehicle{};
  Instant time{};
  coalition::Round round;  ///< where it applies
  TaskId task;             ///< where it applies; task.site for events of a site
  EventBody body;

  [[nodiscard]] EventKind kind() const { return static_cast<EventKind>(body.index()); }
};

}  // namespace skein::mission
