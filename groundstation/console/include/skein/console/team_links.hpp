// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::console {

/// What the ground station's own network has counted of one vehicle, over 10 s.
struct GroundReception {
  VehicleId vehicle;
  std::uint16_t datagrams = 0;
  std::uint8_t lost_percent = 255;  ///< above 100: not known
  double bytes_per_s = 0.0;
};

/// One node hears another, or has lately.
struct LinkFigures {
  VehicleId whom;                            ///< 0: the ground station
  Duration age{};                            ///< since its newest message, however it came
  std::optional<double> per_s;               ///< datagrams that come of it itself
  std::optional<std::uint8_t> lost_percent;  ///< of those that it sends; none: not told
  std::optional<double> bytes_per_s;         ///< as the ground station hears it
  /// Nothing comes of it itself, and what it says is heard all the same: others pass it on.
  bool through_others = false;
};

struct LinkRow {
  VehicleId who;
  /// Since it told; none: it has not, so nothing is known of whom it hears.
  std::optional<Duration> told_age = {};
  bool tells_loss = false;              ///< an older release does not
  std::vector<LinkFigures> hears = {};  ///< ascending by whom
};

/// Who hears whom, as each has told last: the ground station first, then vehicles, ascending.
/// `own`: what the ground station's network knows; none of a recording, which has no such count.
[[nodiscard]] std::vector<LinkRow> team_links(const mission::Fleet& fleet,
                                              const std::vector<GroundReception>& own, Instant now);

/// The section `links`: JSON.
[[nodiscard]] std::string links_json(const std::vector<LinkRow>& rows);
/// The same for the prompt: a line a node.
[[nodiscard]] std::string links_text(const std::vector<LinkRow>& rows);

}  // namespace skein::console
