// SPDX-License-Identifier: Apache-2.0
#include "formation_radio.hpp"

#include <algorithm>

namespace skein::hil {
namespace {

constexpr std::uint64_t kRadioStream = 0x666f726d72616401;

}  // namespace

FormationRadio::FormationRadio(const FormationMission& mission)
    : radio_{mission.radio, mission.seed ^ kRadioStream} {
  for (const FormationVehicle& vehicle : mission.vehicles) {
    nodes_.push_back({vehicle.id, vehicle.start.head<2>()});
  }
  nodes_.push_back({kGroundStation, std::nullopt});
}

void FormationRadio::move(VehicleId node, const Vec3& position_m) {
  for (radio::Node& known : nodes_) {
    if (known.id == node) known.position = position_m.head<2>();
  }
}

void FormationRadio::broadcast(VehicleId from, const mission::Message& message, Instant now) {
  ++messages_;
  const auto what = std::make_shared<const mission::Message>(message);
  const auto sender = std::find_if(nodes_.begin(), nodes_.end(),
                                   [from](const radio::Node& node) { return node.id == from; });
  for (const radio::Node& to : nodes_) {
    if (to.id == from) continue;
    for (const Duration delay : radio_.carry(*sender, to)) {
      air_.push({now + delay, order_++, {from, to.id, what}});
    }
  }
}

std::optional<FormationRadio::Delivery> FormationRadio::pop_due(Instant now) {
  if (air_.empty() || air_.top().at > now) return std::nullopt;
  Delivery first = air_.top().delivery;
  air_.pop();
  return first;
}

}  // namespace skein::hil
