// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/hil/formation_simulator.hpp"

namespace skein::hil {

/// From every node to all others, with the mission's delay, jitter and loss, and the faults that
/// are active. Times are true.
class FormationRadio {
 public:
  explicit FormationRadio(const FormationMission& mission);

  /// From now on until the fault ends.
  void begin(const FormationFault& fault, Instant now);
  void broadcast(VehicleId from, const mission::Message& message, Instant now);

  struct Delivery {
    VehicleId from;
    VehicleId to;
    std::shared_ptr<const mission::Message> message;
  };
  [[nodiscard]] std::optional<Delivery> pop_due(Instant now);
  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  struct Active {
    FormationFault fault;
    Instant until{};
  };
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
  [[nodiscard]] bool lets_through(VehicleId from, VehicleId to) const;

  const FormationMission& mission_;
  std::vector<VehicleId> nodes_;
  std::vector<Active> active_;
  std::priority_queue<Parcel, std::vector<Parcel>, Later> air_;
  std::uint64_t order_ = 0;
  std::uint64_t messages_ = 0;
  Random random_;
};

}  // namespace skein::hil
