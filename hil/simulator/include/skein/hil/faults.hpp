// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"

/// What goes wrong in a simulated mission, and when. All of it lies in a fault phase at the start;
/// then the radio heals, and what remains of the team must finish its work.
namespace skein::hil {

struct TeamMission;

/// How much may go wrong. A schedule is drawn from it with the run's seed; counts and figures are
/// the most that is drawn. Members of several profiles can be set together.
struct FaultParams {
  Duration phase{};  ///< from the start until the radio heals
  Duration bound{};  ///< after it all that is possible must be done
  // Radio, during the phase:
  double loss = 0.0;
  Duration delay{};  ///< besides the scenario's
  Duration jitter{};
  double duplicates = 0.0;
  double held_back = 0.0;  ///< share of messages that arrive up to 2 s later than those after them
  std::size_t partitions = 0;
  // Vehicles:
  std::size_t crashes = 0;   ///< silent for good
  std::size_t restarts = 0;  ///< silent for some seconds, then with an agent without memory
  std::size_t joiners = 0;   ///< take off only during the phase
  Duration clock_offset{};   ///< of each vehicle's clock, to either side
  // World:
  std::size_t hazards = 0;      ///< appear in flight
  bool slow_operator = false;   ///< decisions late, refused, or only after a fixed moment
  bool sites_together = false;  ///< all sites are reported at one moment: several leaders

  /// The larger of each.
  FaultParams& add(const FaultParams& other);
};

/// The names of the profiles, in the order of the documentation.
[[nodiscard]] std::vector<std::string_view> fault_profiles();

/// "lossy", "lossy,crash", ...: the profiles together. `mixed` draws several with the seed. Fails
/// with the names that there are.
[[nodiscard]] Result<FaultParams> fault_params(const std::string& profiles, std::uint64_t seed);

/// The radio's state during the phase, in place of or besides the scenario's.
struct RadioTrouble {
  double loss = 0.0;
  Duration delay{};
  Duration jitter{};
  double duplicates = 0.0;
  double held_back = 0.0;
};

/// Some vehicles (the ground station is 0) are apart from the others for a time.
struct Partition {
  enum class Kind : std::uint8_t {
    halves,   ///< neither hears the other
    one_way,  ///< those apart are not heard, and hear
    bridge    ///< one vehicle hears both halves, and both hear it
  };
  Kind kind = Kind::halves;
  Instant from{};
  Instant until{};
  std::vector<VehicleId> apart;
  VehicleId bridge;  ///< where the kind is bridge

  [[nodiscard]] bool lets_through(VehicleId sender, VehicleId receiver) const;
};

/// A vehicle's program ends. From `not_before` on, the first moment at which a vehicle has the role
/// decides who; it ends `after` that. Nobody who has the role before the phase is over: nothing.
/// The aircraft holds by its flight controller.
struct Crash {
  enum class Role : std::uint8_t { any, leader, member };
  Role role = Role::any;
  Instant not_before{};
  Duration after{};
  std::uint64_t pick = 0;            ///< chooses among those that have the role
  std::optional<Duration> down_for;  ///< then it starts anew; nothing: gone for good
};

struct FaultSchedule {
  /// Where no faults were drawn both are the epoch.
  Instant healed_at{};
  RadioTrouble radio;
  std::vector<Partition> partitions;
  std::vector<Crash> crashes;
  std::map<VehicleId, Duration> clocks;  ///< a vehicle's clock, less the true time
  std::map<VehicleId, Instant> joining;
  std::optional<Instant> sites_reported_at;

  [[nodiscard]] bool any() const { return healed_at > Instant{}; }
  [[nodiscard]] bool lets_through(VehicleId sender, VehicleId receiver, Instant now) const;
};

/// Draws a schedule from the mission's seed and puts it into the mission: its faults, later
/// hazards, the operator's decisions and the duration.
void add_faults(TeamMission& mission, const FaultParams& params);

/// The drawn schedule, a line each.
[[nodiscard]] std::string describe(const TeamMission& mission);

}  // namespace skein::hil
