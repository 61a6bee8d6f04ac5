// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/time.hpp"

namespace skein::autopilot {

/// The answer to a command; the numbers are MAVLink's MAV_RESULT.
enum class CommandResult : std::uint8_t {
  accepted = 0,
  temporarily_rejected = 1,
  denied = 2,
  unsupported = 3,
  failed = 4,
};

/// A line for people, as a flight controller sends with STATUSTEXT; the numbers are MAV_SEVERITY.
enum class Severity : std::uint8_t { critical = 2, warning = 4, info = 6 };
struct Notice {
  Severity severity = Severity::info;
  std::string text;
};

/// What the flight controller knows of its own parts.
struct Health {
  bool gyros = true;
  bool accelerometers = true;
  bool compass = true;
  bool barometer = true;
  bool satellites = true;  ///< a three-dimensional fix
  bool position = true;    ///< the navigation filter has converged
  bool battery = true;
};
/// Why arming is refused, in the autopilot's words, or nothing.
[[nodiscard]] std::optional<std::string_view> arming_refusal(const Health& health);
/// And of ArduPlane in these.
inline constexpr std::string_view kRtlNotArmable = "RTL mode not armable";
inline constexpr std::string_view kQrtlNotArmable = "QRTL mode not armable";
inline constexpr std::string_view kQlandNotArmable = "QLAND mode not armable";
/// A plane that has landed by its mission, until its mode changes.
inline constexpr std::string_view kLandingSequence = "In landing sequence";

/// Counts the silence of the companion (the ground-station failsafe of ArduPilot: on where it is
/// enabled and the companion has been heard once). Fires once for each silence.
class CompanionWatch {
 public:
  CompanionWatch(bool enabled, Duration timeout) : enabled_{enabled}, timeout_{timeout} {}
  void heard(Instant now);
  /// True at the moment at which the companion counts as lost.
  [[nodiscard]] bool lost_now(Instant now);
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  bool enabled_;
  Duration timeout_;
  std::optional<Instant> last_;
  bool lost_ = false;
};

}  // namespace skein::autopilot
