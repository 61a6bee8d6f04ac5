// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/mission/fleet.hpp"

/// What the checks of all vehicles of a fleet find, for the page and the prompt: who is ready.
namespace skein::console {

inline constexpr std::size_t kCheckGroups = static_cast<std::size_t>(mission::CheckGroup::count);
/// For people: "GNSS".
[[nodiscard]] std::string_view name_of(mission::CheckGroup group);

/// Told each 30 s; what is older than two of them and a half does not count any more.
inline constexpr Duration kPreflightCounts = std::chrono::seconds{75};

enum class Readiness : std::uint8_t {
  ready,
  not_ready,
  in_flight,  ///< armed or in the air: it is not before a flight
  not_known,  ///< it has not told all yet
  count
};
[[nodiscard]] std::string_view to_string(Readiness readiness);

/// Of one group: nothing is good that was not heard.
enum class CheckMark : std::uint8_t { not_known, not_looked_at, ok, warn, fail, count };
[[nodiscard]] std::string_view to_string(CheckMark mark);

struct PreflightRow {
  VehicleId vehicle;
  Readiness readiness = Readiness::not_known;
  std::string why;  ///< where it is not ready: "parameters, GNSS"
  /// What it has told is of its present start, and not old, and the vehicle is heard.
  bool counts = false;
  const mission::Preflight* told = nullptr;  ///< the newest, of the fleet; null: none
  Instant told_at{};
  std::array<CheckMark, kCheckGroups> marks{};  ///< as it was told, whether it counts or not
  /// Others of the team have another one, and are more; or as many. Of firmware and parameters
  /// those of its airframe are compared.
  struct Odd {
    bool release = false;
    bool firmware = false;
    bool parameters = false;
    bool configuration = false;
  } odd;
};

struct TeamPreflight {
  std::vector<PreflightRow> rows;  ///< by number
  std::string summary;             ///< "12 of 14 ready, 2 not: 3 (parameters), 7 (silent)"
};
/// The fleet must outlive it.
[[nodiscard]] TeamPreflight team_preflight(const mission::Fleet& fleet, Instant now);

/// "9f3a0c11"; empty where it is not known.
[[nodiscard]] std::string digest_text(std::uint32_t digest);

/// At the prompt: the team, with what fails.
[[nodiscard]] std::string preflight_text(const TeamPreflight& team, Instant now);
/// One vehicle with all that is not ok; nothing where it is not of the fleet.
[[nodiscard]] std::optional<std::string> preflight_text(const TeamPreflight& team,
                                                        VehicleId vehicle, Instant now);

/// The section `preflight` of docs/console-socket.md.
[[nodiscard]] std::string preflight_json(const TeamPreflight& team);

}  // namespace skein::console
