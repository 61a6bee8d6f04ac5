// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "skein/mission/messages.hpp"

namespace skein::mission {

/// The operator's orders that stand: for each vehicle the newest, which a program that starts anew
/// has to be told again.
class OrderBook {
 public:
  static constexpr std::size_t kVehiclesMax = 1024;

  /// Of the ground station, not passed on.
  void note(const Command& command) {
    if (command.kind == CommandKind::give_back) return;  // an act, which stands for nothing
    if (command.vehicle == kGroundStation) {
      if (number_of(command) <= number_of(to_all_)) return;
      to_all_ = command;
      std::erase_if(to_one_,
                    [&](const auto& one) { return number_of(one.second) < number_of(command); });
    } else if (to_one_.contains(command.vehicle) || to_one_.size() < kVehiclesMax) {
      Command& newest = to_one_[command.vehicle];
      if (number_of(command) > number_of(newest)) newest = command;
    }
  }

  /// The order that stands for it, as it is passed on by `teller`; number 0 and `resume` for none.
  [[nodiscard]] Command standing(VehicleId vehicle, VehicleId teller) const {
    Command command = to_all_;
    const auto own = to_one_.find(vehicle);
    if (own != to_one_.end() && number_of(own->second) > number_of(command)) command = own->second;
    command.vehicle = vehicle;
    command.told_by = teller;
    return command;
  }

 private:
  Command to_all_{.kind = CommandKind::resume};
  std::map<VehicleId, Command> to_one_;
};

}  // namespace skein::mission
