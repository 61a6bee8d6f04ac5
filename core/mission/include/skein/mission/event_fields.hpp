// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include "skein/mission/events.hpp"

/// The fields of events by name, in the order of idl/events.idl: for whoever carries or shows them
/// all alike (codec, recordings, console).
namespace skein::mission {

template <class Struct, class Value>
struct Field {
  std::string_view name;
  Value Struct::*member;
};
template <class Struct, class Value>
constexpr auto field(std::string_view name, Value Struct::*member) {
  return Field<Struct, Value>{name, member};
}

template <class Struct>
inline constexpr auto kFields = nullptr;
template <>
inline constexpr auto kFields<coalition::Why> =
    std::tuple{field("reason", &coalition::Why::reason), field("vehicle", &coalition::Why::vehicle),
               field("detail", &coalition::Why::detail)};
template <>
inline constexpr auto kFields<AutopilotNotice> =
    std::tuple{field("news", &AutopilotNotice::news), field("number", &AutopilotNotice::number),
               field("given", &AutopilotNotice::given), field("refusal", &AutopilotNotice::refusal),
               field("detail", &AutopilotNotice::detail)};
template <>
inline constexpr auto kFields<event::SiteDetected> =
    std::tuple{field("range_m", &event::SiteDetected::range_m)};
template <>
inline constexpr auto kFields<event::SurveyStarted> =
    std::tuple{field("begun", &event::SurveyStarted::begun)};
template <>
inline constexpr auto kFields<event::SurveyDone> =
    std::tuple{field("begun", &event::SurveyDone::begun)};
template <>
inline constexpr auto kFields<event::Announced> =
    std::tuple{field("tasks", &event::Announced::tasks), field("why", &event::Announced::why)};
template <>
inline constexpr auto kFields<event::BidSent> = std::tuple{field("eta", &event::BidSent::eta)};
template <>
inline constexpr auto kFields<event::BidDeclined> =
    std::tuple{field("why", &event::BidDeclined::why)};
template <>
inline constexpr auto kFields<event::AllocationDone> =
    std::tuple{field("took", &event::AllocationDone::took),
               field("bids", &event::AllocationDone::bids),
               field("method", &event::AllocationDone::method),
               field("objective", &event::AllocationDone::objective),
               field("proven", &event::AllocationDone::proven),
               field("gap", &event::AllocationDone::gap)};
template <>
inline constexpr auto kFields<event::AllocationFailed> =
    std::tuple{field("bids", &event::AllocationFailed::bids),
               field("detail", &event::AllocationFailed::detail)};
template <>
inline constexpr auto kFields<event::Awarded> = std::tuple{field("tasks", &event::Awarded::tasks)};
template <>
inline constexpr auto kFields<event::Confirmed> =
    std::tuple{field("planned", &event::Confirmed::planned)};
template <>
inline constexpr auto kFields<event::Refused> = std::tuple{field("why", &event::Refused::why)};
template <>
inline constexpr auto kFields<event::CoalitionFormed> =
    std::tuple{field("vehicles", &event::CoalitionFormed::vehicles)};
template <>
inline constexpr auto kFields<event::Cancelled> = std::tuple{field("why", &event::Cancelled::why)};
template <>
inline constexpr auto kFields<event::Released> = std::tuple{field("why", &event::Released::why)};
template <>
inline constexpr auto kFields<event::LeaseGranted> =
    std::tuple{field("until", &event::LeaseGranted::until)};
template <>
inline constexpr auto kFields<event::LeaseEnded> =
    std::tuple{field("why", &event::LeaseEnded::why), field("held", &event::LeaseEnded::held)};
template <>
inline constexpr auto kFields<event::AuthorisationRequested> =
    std::tuple{field("decide_by", &event::AuthorisationRequested::decide_by)};
template <>
inline constexpr auto kFields<event::Authorised> = std::tuple{field("by", &event::Authorised::by)};
template <>
inline constexpr auto kFields<event::AuthorisationRefused> =
    std::tuple{field("by", &event::AuthorisationRefused::by)};
template <>
inline constexpr auto kFields<event::AuthorisationLate> =
    std::tuple{field("why", &event::AuthorisationLate::why)};
template <>
inline constexpr auto kFields<event::TaskStarted> =
    std::tuple{field("begun", &event::TaskStarted::begun)};
template <>
inline constexpr auto kFields<event::TaskDone> =
    std::tuple{field("planned", &event::TaskDone::planned)};
template <>
inline constexpr auto kFields<event::TaskFailed> =
    std::tuple{field("why", &event::TaskFailed::why), field("planned", &event::TaskFailed::planned),
               field("detail", &event::TaskFailed::detail)};
template <>
inline constexpr auto kFields<event::Commanded> =
    std::tuple{field("command", &event::Commanded::command)};
template <>
inline constexpr auto kFields<event::PlanRetimed> =
    std::tuple{field("speed_mps", &event::PlanRetimed::speed_mps)};
template <>
inline constexpr auto kFields<event::PlanDetoured> =
    std::tuple{field("hazard", &event::PlanDetoured::hazard)};
template <>
inline constexpr auto kFields<event::RangeSpent> =
    std::tuple{field("range_left_m", &event::RangeSpent::range_left_m),
               field("comes_home", &event::RangeSpent::comes_home)};
template <>
inline constexpr auto kFields<event::ReliefBegun> =
    std::tuple{field("heard", &event::ReliefBegun::heard)};
template <>
inline constexpr auto kFields<event::HazardKnown> = std::tuple{
    field("hazard", &event::HazardKnown::hazard), field("radius_m", &event::HazardKnown::radius_m)};
template <>
inline constexpr auto kFields<event::ConflictYielded> = std::tuple{
    field("to", &event::ConflictYielded::to), field("reward", &event::ConflictYielded::reward),
    field("leads", &event::ConflictYielded::leads)};
template <>
inline constexpr auto kFields<event::Monitoring> =
    std::tuple{field("tasks", &event::Monitoring::tasks), field("why", &event::Monitoring::why)};
template <>
inline constexpr auto kFields<event::LeaderReplaced> =
    std::tuple{field("lost", &event::LeaderReplaced::lost),
               field("supporters", &event::LeaderReplaced::supporters)};
template <>
inline constexpr auto kFields<event::SiteDone> =
    std::tuple{field("tasks", &event::SiteDone::tasks)};
template <>
inline constexpr auto kFields<event::ChangeBegun> =
    std::tuple{field("number", &event::ChangeBegun::number),
               field("order", &event::ChangeBegun::order),
               field("shape", &event::ChangeBegun::shape),
               field("correction", &event::ChangeBegun::correction),
               field("way", &event::ChangeBegun::way),
               field("vehicles", &event::ChangeBegun::vehicles),
               field("takes", &event::ChangeBegun::takes),
               field("separation_m", &event::ChangeBegun::separation_m)};
template <>
inline constexpr auto kFields<event::ChangeTakenUp> =
    std::tuple{field("number", &event::ChangeTakenUp::number)};
template <>
inline constexpr auto kFields<event::PlaceReached> =
    std::tuple{field("number", &event::PlaceReached::number)};
template <>
inline constexpr auto kFields<event::FormationHeld> =
    std::tuple{field("spread", &event::FormationHeld::spread)};
template <>
inline constexpr auto kFields<event::ScriptDone> =
    std::tuple{field("orders", &event::ScriptDone::orders)};
template <>
inline constexpr auto kFields<event::TaskLost> = std::tuple{field("why", &event::TaskLost::why)};
template <>
inline constexpr auto kFields<event::TaskUnknown> =
    std::tuple{field("owner", &event::TaskUnknown::owner)};
template <>
inline constexpr auto kFields<event::VehicleTrouble> =
    std::tuple{field("trouble", &event::VehicleTrouble::trouble)};
template <>
inline constexpr auto kFields<event::FleetWarning> = std::tuple{
    field("news", &event::FleetWarning::news), field("vehicle", &event::FleetWarning::vehicle),
    field("silence", &event::FleetWarning::silence)};
template <>
inline constexpr auto kFields<event::ChangeRefused> = std::tuple{
    field("number", &event::ChangeRefused::number), field("why", &event::ChangeRefused::why)};
template <>
inline constexpr auto kFields<event::Waiting> =
    std::tuple{field("number", &event::Waiting::number), field("what", &event::Waiting::what),
               field("vehicle", &event::Waiting::vehicle)};
template <>
inline constexpr auto kFields<event::FormationWarning> =
    std::tuple{field("news", &event::FormationWarning::news),
               field("vehicles", &event::FormationWarning::vehicles)};
template <>
inline constexpr auto kFields<event::OrderWaits> =
    std::tuple{field("line", &event::OrderWaits::line), field("order", &event::OrderWaits::order),
               field("detail", &event::OrderWaits::detail)};
template <>
inline constexpr auto kFields<event::FlightWarning> =
    std::tuple{field("notice", &event::FlightWarning::notice)};

/// Calls `f(name, value)` for each field of an event's struct, which may be const.
template <class Struct, class F>
void for_each_field(Struct& made, F&& f) {
  std::apply([&](const auto&... fields) { (f(fields.name, made.*(fields.member)), ...); },
             kFields<std::remove_const_t<Struct>>);
}

}  // namespace skein::mission
