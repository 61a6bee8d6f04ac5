// SPDX-License-Identifier: Apache-2.0
#include "formation_radio.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/contains.hpp"

namespace skein::hil {
namespace {

constexpr std::uint64_t kRadioStream = 0x666f726d72616401;
constexpr double kHeldBackMax_s = 1.0;

}  // namespace

FormationRadio::FormationRadio(const FormationMission& mission)
    : mission_{mission}, random_{mission.seed ^ kRadioStream} {
  for (const FormationVehicle& vehicle : mission.vehicles) nodes_.push_back(vehicle.id);
  nodes_.push_back(kGroundStation);
}

void FormationRadio::begin(const FormationFault& fault, Instant now) {
  active_.push_back({fault, now + fault.lasts});
}

bool FormationRadio::lets_through(VehicleId from, VehicleId to) const {
  return std::none_of(active_.begin(), active_.end(), [&](const Active& active) {
    const auto& who = active.fault.who;
    switch (active.fault.kind) {
      case FormationFault::Kind::silent:
        return contains(who, from) || contains(who, to);
      case FormationFault::Kind::apart:
        return contains(who, from) != contains(who, to);
      case FormationFault::Kind::unheard:
        return contains(who, from);
      default:
        return false;
    }
  });
}

void FormationRadio::broadcast(VehicleId from, const mission::Message& message, Instant now) {
  ++messages_;
  std::erase_if(active_, [now](const Active& active) { return active.until <= now; });
  double loss = mission_.loss;
  double duplicates = 0.0;
  double held_back = 0.0;
  for (const Active& active : active_) {
    loss = std::max(loss, active.fault.loss);
    duplicates = std::max(duplicates, active.fault.duplicates);
    held_back = std::max(held_back, active.fault.held_back);
  }
  const auto what = std::make_shared<const mission::Message>(message);
  const auto post = [&](VehicleId to) {
    const double jitter = to_seconds(mission_.jitter);
    Duration delay = mission_.delay + from_seconds(random_.uniform(-jitter, jitter));
    if (random_.chance(held_back)) delay += from_seconds(random_.uniform(0.0, kHeldBackMax_s));
    air_.push({now + std::max(Duration{}, delay), order_++, {from, to, what}});
  };
  for (const VehicleId to : nodes_) {
    if (to == from || !lets_through(from, to)) continue;
    if (random_.chance(loss)) continue;
    post(to);
    if (random_.chance(duplicates)) post(to);
  }
}

std::optional<FormationRadio::Delivery> FormationRadio::pop_due(Instant now) {
  if (air_.empty() || air_.top().at > now) return std::nullopt;
  Delivery first = air_.top().delivery;
  air_.pop();
  return first;
}

}  // namespace skein::hil
