// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <vector>

#include "skein/hil/formation_simulator.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil {

/// From every node to all others, through the simulated radio. Times are true.
class FormationRadio {
 public:
  explicit FormationRadio(const FormationMission& mission);

  void interfere(const radio::Interference& interference) { radio_.interfere(interference); }
  /// Where a node is now.
  void move(VehicleId node, const Vec3& position_m);
  void broadcast(VehicleId from, const mission::Message& message, Instant now);

  struct Delivery {
    VehicleId from;
    VehicleId to;
    std::shared_ptr<const mission::Message> message;
  };
  [[nodiscard]] std::optional<Delivery> pop_due(Instant now);
  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  struct Parcel {
    Instant at{};
    std::uint64_t order = 0;
    Delivery delivery;
  };
  struct Later {
    bool operator()(const Parcel& a, const Parcel& b) const {
      return a.at != b.at ? a.at > b.at : a.order > b.order;
    }
  };

  radio::SimulatedRadio radio_;
  std::vector<radio::Node> nodes_;
  std::priority_queue<Parcel, std::vector<Parcel>, Later> air_;
  std::uint64_t order_ = 0;
  std::uint64_t messages_ = 0;
};

}  // namespace skein::hil
