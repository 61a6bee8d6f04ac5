// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/hil/fault.hpp"

/// Faults that are drawn from a seed. A mission with sites has all of them in a phase at its start;
/// then the radio heals, and what remains of the team must finish its work. In a formation each
/// lies in the middle of a change.
namespace skein::hil {

struct TeamMission;

enum class MissionKind : std::uint8_t { sites, formation };

/// The names of the profiles that can be drawn for such a mission, in the order of the
/// documentation.
[[nodiscard]] std::vector<std::string_view> fault_profiles(MissionKind kind);

/// The names in a list with commas. Fails with `why_not` of the first that is not known, and those
/// that are.
[[nodiscard]] Result<std::vector<std::string>> fault_names(
    const std::string& list, const std::vector<std::string_view>& known,
    const std::function<std::string(const std::string& name)>& why_not);

/// After the radio has healed: what can be done at all.
inline constexpr Duration kDoneWithin = std::chrono::seconds{300};

/// How much may go wrong in a mission with sites; counts and figures are the most that is drawn.
/// Members of several profiles can be set together.
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
  std::size_t crashes = 0;    ///< silent for good
  std::size_t restarts = 0;   ///< silent for some seconds, then with an agent without memory
  std::size_t joiners = 0;    ///< take off only during the phase
  Duration clock_offset{};    ///< of each vehicle's clock, to either side
  std::size_t airframes = 0;  ///< lost with the program
  std::size_t doubles = 0;    ///< vehicles of others that fly under a number of the team
  std::size_t pilots = 0;     ///< times that one takes an aircraft, for up to a minute and a half
  std::size_t stalls = 0;     ///< times that a program stands still for seconds
  std::size_t taken_over =
      0;                      ///< times that the other one of two ground stations takes the command
  std::size_t ground = 0;     ///< times that the ground station's program ends and starts anew
  Duration planning{};        ///< a plan takes up to so long, in every vehicle
  std::size_t orders = 0;     ///< of the operator: to hold, to come home, to go on
  bool wrong_clock = false;   ///< one vehicle's, by seconds
  std::size_t batteries = 0;  ///< a cell of them fails: whose it is must come home
  bool narrow = false;        ///< the air carries some ten kilobytes a second, of all together
  // World:
  double wind_mps = 0.0;        ///< from anywhere, all the mission long
  double gust_mps = 0.0;        ///< in it: standard deviation at most
  std::size_t hazards = 0;      ///< appear in flight
  std::size_t covered = 0;      ///< sites over which one appears in flight
  std::size_t seen = 0;         ///< places that detectors tell of: false, doubled
  std::size_t withdrawn = 0;    ///< sites of the mission that the operator withdraws
  std::size_t taken_back = 0;   ///< sites whose grant the operator takes back
  bool slow_operator = false;   ///< decisions late, refused, or only after a fixed moment
  bool sites_together = false;  ///< all sites are reported at one moment: several leaders
};

/// "lossy", "lossy,crash", ...: the profiles together. `mixed` draws several with the seed. Fails
/// with the names that there are, also for a profile of formations.
[[nodiscard]] Result<FaultParams> fault_params(const std::string& profiles, std::uint64_t seed);

/// A program that stands still in the phase, anybody's: for shorter than lease and silence allow
/// for, about as long, or longer.
[[nodiscard]] Fault draw_stall(Random& random, Duration phase);

/// Draws faults from the mission's seed and puts them into the mission: its faults, later hazards,
/// the operator's decisions and the duration.
void add_faults(TeamMission& mission, const FaultParams& params);

/// Faults of a formation, for changes 0 to `changes` - 1. Fails with the names that there are, also
/// for a profile of missions with sites.
[[nodiscard]] Result<std::vector<Fault>> formation_faults(const std::string& profiles,
                                                          const std::vector<VehicleId>& vehicles,
                                                          std::size_t changes, std::uint64_t seed);

}  // namespace skein::hil
