// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "skein/base/ids.hpp"

namespace skein::mission {

/// Vehicles of a formation that are not to be led, and why.
class BarredVehicles {
 public:
  /// None: it may be led.
  void set(VehicleId vehicle, std::optional<std::string> why) {
    if (why) {
      why_[vehicle] = *std::move(why);
    } else {
      why_.erase(vehicle);
    }
  }
  /// Of the first; none where all may be led.
  [[nodiscard]] std::optional<std::string> why() const {
    if (why_.empty()) return std::nullopt;
    return why_.begin()->second;
  }

 private:
  std::map<VehicleId, std::string> why_;
};

}  // namespace skein::mission
