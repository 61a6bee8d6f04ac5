// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/ground_traffic.hpp"

namespace skein::agencies {

inline constexpr std::size_t kSbsLineMax = 512;             ///< bytes
inline constexpr std::size_t kAircraftJsonMax = 2'000'000;  ///< bytes
inline constexpr double kAircraftPlaceMax_m = 150'000.0;    ///< from the origin, east and north

/// What heights from pressure are corrected by: they are told as of a standard atmosphere.
struct PressureHeight {
  double qnh_hpa = 1013.25;     ///< at the place, reduced to the sea's level
  double geoid_height_m = 0.0;  ///< above the ellipsoid, at the mission's origin
};

/// What dump1090 tells of aircraft: as SBS-1 text ("BaseStation", TCP port 30003), of which each
/// line has a part, or as its file aircraft.json. Feet, knots and feet a minute become metres and
/// seconds; heights are above the mission's origin: from an aircraft's own satellites where they
/// are told, or else from pressure. What cannot be read is counted, and never thrown. Pure; `now`
/// never decreases.
class AdsbIntake {
 public:
  static constexpr std::size_t kKnownMax = 500;  ///< whose parts are put together
  static constexpr Duration kForgotten = std::chrono::seconds{60};
  /// A place that is older is not told: whoever is there by now is elsewhere.
  static constexpr Duration kPlaceAgeMax = std::chrono::seconds{30};

  AdsbIntake(const MissionOrigin& origin, const PressureHeight& pressure);

  /// One line, without its end. Nothing while place and height of its aircraft are not known.
  [[nodiscard]] std::optional<mission::SeenAircraft> take_sbs(std::string_view line, Instant now);
  /// A whole file; `unix_s`: the system's time at `now`. Those without a place are left out.
  [[nodiscard]] std::vector<mission::SeenAircraft> take_json(std::string_view text, double unix_s,
                                                             Instant now);

  /// The newest file was written so long ago that nothing is taken of it.
  [[nodiscard]] bool is_old() const { return is_old_; }
  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }
  /// Of those that are not in the mission's area.
  [[nodiscard]] std::uint64_t far_away() const { return far_away_; }

 private:
  struct Known {
    mission::SeenAircraft seen;
    bool has_place = false;
    bool has_height = false;
    Instant heard_at{};
  };
  Known* known_of(std::uint32_t address, Instant now);
  [[nodiscard]] double from_pressure_m(double altitude_ft) const;
  [[nodiscard]] double above_origin_m(double above_ellipsoid_m) const;
  [[nodiscard]] std::optional<Vec2> place_of(double latitude_deg, double longitude_deg) const;

  MissionOrigin origin_;
  double sea_level_m_;  ///< of the standard atmosphere's zero, above the sea
  double geoid_height_m_;
  std::map<std::uint32_t, Known> known_;
  bool is_old_ = false;
  std::uint64_t unreadable_ = 0;
  std::uint64_t far_away_ = 0;
};

}  // namespace skein::agencies
