// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_landing.hpp"

#include "names.hpp"

namespace skein::mission {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{500};

const FleetEntry* heard(const Fleet& fleet, VehicleId vehicle) {
  const auto known = fleet.vehicles().find(vehicle);
  if (known == fleet.vehicles().end() || !known->second.telemetry) return nullptr;
  return known->second.silent || known->second.revoked ? nullptr : &known->second;
}

}  // namespace

std::optional<std::string> GroundLanding::why_not(VehicleId vehicle, CommandKind standing,
                                                  const Fleet& fleet) {
  const FleetEntry* const known = heard(fleet, vehicle);
  if (known == nullptr) return name_of(vehicle) + " is not heard: where it is, is not known";
  const Activity activity = known->telemetry->activity;
  if (activity == Activity::landed) return name_of(vehicle) + " has landed";
  if (activity == Activity::landing || standing == CommandKind::land) return std::nullopt;
  // Who comes home since its range is spent has no order to, and holds.
  const bool comes_home =
      standing == CommandKind::return_home ||
      (standing == CommandKind::resume && activity == Activity::holding && !known->differs);
  if (comes_home) return std::nullopt;
  return name_of(vehicle) + " is neither at home nor on its way there: order 'return " +
         std::to_string(vehicle.value) + "' first, then 'land " + std::to_string(vehicle.value) +
         "'";
}

void GroundLanding::drop(VehicleId vehicle) {
  waiting_.erase(vehicle);
  if (turn_ && turn_->vehicle == vehicle) turn_.reset();
}

bool GroundLanding::turn_ends(const Fleet& fleet, Instant now) {
  const FleetEntry* const known = heard(fleet, turn_->vehicle);
  if (known != nullptr && known->telemetry->activity == Activity::landed) return true;
  if (now - turn_->since < kSlot) return false;
  event::FleetWarning late;
  late.news = event::FleetNews::not_landed;
  late.vehicle = turn_->vehicle;
  late.silence = now - turn_->since;
  events_.push({kGroundStation, now, {}, {}, late});
  return true;
}

std::optional<VehicleId> GroundLanding::next(const Fleet& fleet, Instant now) {
  if (turn_ && turn_ends(fleet, now)) turn_.reset();
  next_ = turn_ || !waiting_.empty() ? now + kPeriod : Instant::max();
  if (turn_) return std::nullopt;
  std::optional<VehicleId> lowest;
  double lowest_m = 0.0;
  for (const VehicleId vehicle : waiting_) {
    const FleetEntry* const known = heard(fleet, vehicle);
    if (known == nullptr) continue;
    const double height_m = known->telemetry->state.z_m;
    if (lowest && height_m >= lowest_m) continue;
    lowest = vehicle;
    lowest_m = height_m;
  }
  if (!lowest) return std::nullopt;
  waiting_.erase(*lowest);
  turn_ = {*lowest, now};
  return lowest;
}

}  // namespace skein::mission
