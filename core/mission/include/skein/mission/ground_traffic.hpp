// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// An aircraft that is not of the team, as a receiver has it.
struct SeenAircraft {
  Aircraft aircraft;        ///< where it was, at its time
  std::string callsign{};   ///< empty: not told
  bool barometric = false;  ///< its height is from pressure
  bool on_ground = false;
};

/// Where it is at that time, if it flies straight on.
[[nodiscard]] Aircraft carried_to(Aircraft aircraft, Instant now);

/// The member of the team that an aircraft is nearest to.
struct NearestMember {
  VehicleId vehicle;
  double distance_m = 0.0;  ///< to the side, now
  double above_m = 0.0;     ///< the aircraft over it; negative: below
  double closest_m = 0.0;   ///< to the side, if both fly straight on
  double closest_in_s = 0.0;
};
/// None while no vehicle has been heard.
[[nodiscard]] std::optional<NearestMember> nearest_member(const Aircraft& aircraft,
                                                          const Fleet& fleet, Instant now);

/// Keeps the aircraft that receivers hear, and tells the team of those that may come near: once in
/// kTellPeriod while there are any, and once more with none. Pure; `now` never decreases.
class GroundTraffic {
 public:
  static constexpr Duration kForgotten = std::chrono::seconds{30};  ///< since its last word
  static constexpr Duration kTellPeriod = std::chrono::seconds{1};
  static constexpr std::size_t kKnownMax = 64;  ///< the nearest of more
  /// Who is nearer than that to a member of the team, or will be beside one within so long, is told
  /// of; not who is so much higher or lower all that time.
  static constexpr double kNear_m = 10'000.0;
  static constexpr Duration kAhead = std::chrono::seconds{90};
  static constexpr double kApart_m = 1500.0;

  /// A newer word of an aircraft.
  void on_aircraft(SeenAircraft seen, const Fleet& fleet, Instant now);
  void on_timeout(const Fleet& fleet, Instant now);
  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] Instant next_timeout() const;
  /// By their addresses, as they were heard last.
  [[nodiscard]] const std::map<std::uint32_t, SeenAircraft>& all() const { return known_; }

 private:
  void forget_farthest(const Fleet& fleet, Instant now);

  std::map<std::uint32_t, SeenAircraft> known_;
  Instant next_tell_ = Instant::min();
  bool told_ = false;  ///< of some
  std::optional<Message> message_;
};

}  // namespace skein::mission
