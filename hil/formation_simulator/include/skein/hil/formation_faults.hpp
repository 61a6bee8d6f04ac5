// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"

/// What goes wrong while a formation flies, and when: always in the middle of a change.
namespace skein::hil {

struct FormationFault {
  enum class Kind : std::uint8_t {
    lost,       ///< vehicles: the agent ends, the body brakes, and stays or sinks
    restarted,  ///< vehicles: as lost, and then with an agent without memory
    ground,     ///< the ground station ends; its successor knows nothing
    silent,     ///< vehicles are not heard and do not hear
    apart,      ///< vehicles hear themselves only, and the others themselves
    unheard,    ///< vehicles are not heard, and hear
    radio,      ///< messages are lost, late, doubled and out of order
    count
  };
  Kind kind = Kind::radio;
  std::size_t change = 0;      ///< that the ground stations begin, counted from 0
  Duration after{};            ///< from then on
  Duration lasts{};            ///< of no meaning where it is for good
  bool for_good = false;       ///< vehicles lost, and the ground station
  std::vector<VehicleId> who;  ///< 0 is the ground station, which can be silent or unheard
  bool sinks = false;          ///< who is lost comes down where it is, `sinks_after` it was lost
  Duration sinks_after{};
  double loss = 0.0;  ///< of radio
  double duplicates = 0.0;
  double held_back = 0.0;  ///< share that arrives up to 1 s later than what is sent after it
};

struct FormationFaults {
  std::vector<FormationFault> faults;
  std::map<VehicleId, Duration> clocks;  ///< less the true time; 20 ms apart at most
};

/// none, vehicle, leader, ground, loss, silence, partition, restart, clocks, mixed.
[[nodiscard]] std::vector<std::string_view> formation_fault_profiles();

/// Drawn from the seed, for changes 0 to `changes` - 1. Fails with the names that there are.
[[nodiscard]] Result<FormationFaults> draw_formation_faults(const std::string& profile,
                                                            const std::vector<VehicleId>& vehicles,
                                                            std::size_t changes,
                                                            std::uint64_t seed);

[[nodiscard]] std::string describe(const FormationFault& fault);

}  // namespace skein::hil
