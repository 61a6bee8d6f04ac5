// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::agencies {

inline constexpr std::size_t kMarkerTextMax = 8192;
inline constexpr double kMarkerPlaceMax_m = 100'000.0;  ///< from the origin, east and north

/// What a Cursor on Target event of others tells of.
struct Marker {
  std::string uid;
  mission::Detection detection;  ///< of nobody's vehicle; named after the marker
};

/// The marker in one XML document: a point on the map (types b-m-p-*), or a thing on the ground
/// that is nobody's (a-u-G*, a-n-G*). Its kind is the incident that its callsign or remarks name
/// first, or else damage. Nothing for events of other types and for those that are ended. Fails
/// where it is no event, or lies farther off than kMarkerPlaceMax_m.
[[nodiscard]] Result<std::optional<Marker>> read_marker(std::string_view text,
                                                        const MissionOrigin& origin);

/// What of others' datagrams is worth to be proposed to the operator; the rest is counted. Pure;
/// `now` never decreases.
class MarkerIntake {
 public:
  static constexpr int kBurst = 20;           ///< markers at once
  static constexpr double kRate_per_s = 0.5;  ///< and then

  /// Events whose UID begins with `own_prefix` are the team's own.
  MarkerIntake(const MissionOrigin& origin, std::string own_prefix);

  [[nodiscard]] std::optional<mission::Detection> take(std::string_view datagram, Instant now);

  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }
  [[nodiscard]] std::uint64_t too_many() const { return too_many_; }
  /// Why the last one could not be read.
  [[nodiscard]] std::optional<std::string> poll_trouble();

 private:
  [[nodiscard]] bool has_room(Instant now);

  MissionOrigin origin_;
  std::string own_prefix_;
  double room_ = kBurst;
  Instant room_at_{};
  std::uint64_t unreadable_ = 0;
  std::uint64_t too_many_ = 0;
  std::optional<std::string> trouble_;
};

}  // namespace skein::agencies
