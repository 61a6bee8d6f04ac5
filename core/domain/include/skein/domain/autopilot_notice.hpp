// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace skein {

/// What an autopilot or the link to it does (docs/ardupilot.md).
enum class AutopilotNews : std::uint8_t {
  rebooted,
  looked_for,  ///< again, as the operator has asked
  gone,        ///< before it was prepared
  found,       ///< system `number`, in mode `detail`
  ready,       ///< see `given`
  disarmed,
  not_armed,          ///< it does not arm; see `given`
  launch_broken_off,  ///< see `given`
  taking_off,
  landing,
  flying,           ///< the companion's setpoints
  mode_changed,     ///< to `detail`, by the pilot or a failsafe: others fly
  armed_by_others,  ///< in mode `detail`: others fly
  not_obeying,      ///< others fly
  not_climbed,      ///< to `number` metres in time: others fly
  no_frames,        ///< come from the flight controller
  silent,           ///< though its node is on the bus
  duplicate_node,   ///< two nodes have the id `number`
  not_given_back,   ///< for the reason in `refusal`
  given_back_landed,
  other_system,     ///< `number` is on the line, and not heeded
  wrong_make,       ///< `number`
  wrong_airframe,   ///< of MAV_TYPE `number`
  old_firmware,     ///< `detail`
  firmware,         ///< `detail`
  text,             ///< `detail`, of the autopilot
  command_refused,  ///< `detail`
  count
};
/// Whether a vehicle on the ground may be launched.
enum class Given : std::uint8_t { yes, taken_by_others, launch_spent, count };
/// Why an aircraft is not taken over from its pilot.
enum class GiveBackRefusal : std::uint8_t {
  none,
  node_still_duplicate,  ///< `number`
  wrong_state,           ///< of the companion, named in `detail`
  taken_since,           ///< after the operator's word
  no_position,
  not_flying,  ///< it is not armed and in the air
  count
};
[[nodiscard]] std::string_view to_string(AutopilotNews news);
[[nodiscard]] std::string_view to_string(Given given);
[[nodiscard]] std::string_view to_string(GiveBackRefusal why);

/// What the companion of an autopilot tells; a field is of the news that name it.
struct AutopilotNotice {
  AutopilotNews news = AutopilotNews::text;
  std::uint16_t number = 0;
  Given given = Given::yes;
  GiveBackRefusal refusal = GiveBackRefusal::none;
  std::string detail{};  ///< for people
  friend auto operator<=>(const AutopilotNotice&, const AutopilotNotice&) = default;
};

}  // namespace skein
