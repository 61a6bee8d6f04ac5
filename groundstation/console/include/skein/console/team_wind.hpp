// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::console {

/// The wind as one or more vehicles have it: mission frame, m/s, as a velocity (where it blows to).
struct WindEstimate {
  Vec2 mean_mps{0.0, 0.0};
  double gust_mps = 0.0;  ///< the most that three seconds in a row had, as a speed
  Instant newest{};       ///< of what it is made of
  /// From where it blows, as people say it; of no meaning in a calm.
  [[nodiscard]] double from_deg() const;
};

struct TeamWindEstimate {
  WindEstimate wind;        ///< all vehicles count alike; its gust is the strongest of any
  double spread_mps = 0.0;  ///< root mean square of what vehicles tell from the mean
  std::map<VehicleId, WindEstimate> vehicles;  ///< those that it is made of
};

/// The wind that planes fly in: over the ground less through the air, averaged as vectors over 20 s
/// of each, and over the team. Of every second one figure is kept. Copyable; `now` never decreases.
class TeamWind {
 public:
  static constexpr Duration kWindow = std::chrono::seconds{20};
  /// Less is no flight of a plane.
  static constexpr double kAirspeedMin_mps = 5.0;
  static constexpr std::size_t kVehiclesMax = 1000;

  void on_telemetry(const mission::Telemetry& told, Instant now);

  /// Without the vehicles of `not_counted`; none where nobody tells.
  [[nodiscard]] std::optional<TeamWindEstimate> estimate(const std::set<VehicleId>& not_counted,
                                                         Instant now) const;

 private:
  static constexpr std::int64_t kSlots = kWindow / std::chrono::seconds{1};
  struct Slot {
    std::int64_t second = -1;
    Vec2 sum_mps{0.0, 0.0};
    double count = 0.0;
  };
  struct Vehicle {
    std::array<Slot, kSlots> slots;
    Instant newest{};
  };
  [[nodiscard]] static std::optional<WindEstimate> estimate_of(const Vehicle& vehicle, Instant now);

  std::map<VehicleId, Vehicle> vehicles_;
};

/// Those that tell no airspeed of their own: copters, by what their checks say, and who is silent.
[[nodiscard]] std::set<VehicleId> without_airspeed(const mission::Fleet& fleet);

/// "from 240 deg at 4.0 m/s, gusts 6.1 m/s"
[[nodiscard]] std::string words_of(const WindEstimate& wind);
/// The section `wind`: JSON, null where nobody tells.
[[nodiscard]] std::string wind_json(const std::optional<TeamWindEstimate>& estimate, Instant now);
/// The same for the prompt.
[[nodiscard]] std::string wind_text(const std::optional<TeamWindEstimate>& estimate, Instant now);

}  // namespace skein::console
