// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"

/// The state of the team as a whole, in one word, with what it means and what there is to do.
namespace skein::console {

/// In order: the first that holds is the team's, the others that hold stand beside it.
enum class TeamState : std::uint8_t {
  no_command,   ///< no ground station is heard that commands
  lost_link,    ///< none of the vehicles that were heard is
  in_the_way,   ///< somebody comes too near to an aircraft and does not give way: named
  held,         ///< all who are heard hold by order
  recall,       ///< all who are heard come home, are there or land by order, and not all are down
  degraded,     ///< somebody is silent, was never heard, or cannot work: named
  part_held,    ///< some hold by order
  part_recall,  ///< some come home by order
  keeps_clear,  ///< some give way to an aircraft
  on_ground,    ///< all who are heard are on the ground
  normal,
  count
};
[[nodiscard]] std::string_view to_string(TeamState state);

struct TeamStateRow {
  TeamState state = TeamState::normal;
  std::string_view level;  ///< "alarm", "warning", "info"
  std::string_view title;
  std::string_view means;
  std::string_view to_do;           ///< empty: nothing
  std::vector<VehicleId> vehicles;  ///< whom it is of; none: of the team
};

/// What the fleet does not know.
struct TeamFacts {
  bool nobody_commands = false;
};
/// Never empty: the team's state first.
[[nodiscard]] std::vector<TeamStateRow> team_state(const mission::Fleet& fleet,
                                                   const TeamFacts& facts, Instant now);
/// "team: degraded: ...", a line each.
[[nodiscard]] std::string team_text(const std::vector<TeamStateRow>& rows);
/// The section `team` of docs/console-socket.md.
[[nodiscard]] std::string team_json(const std::vector<TeamStateRow>& rows);

}  // namespace skein::console
