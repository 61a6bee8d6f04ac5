// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::mission {

struct TelemetryPeriods {
  Duration shortest = std::chrono::milliseconds{100};
  Duration longest = std::chrono::milliseconds{500};  ///< of who has nobody near
};

/// How often a vehicle tells where it is: rarely where nobody is near, and often enough that the
/// distance to another changes by a tenth at most between two times, whichever way both turn, as
/// far as the shortest period allows and the others have been heard.
class TelemetryPace {
 public:
  /// Others beyond it are not looked at.
  static constexpr std::size_t kVehiclesMax = 1024;
  /// Who is silent for longer counts no more.
  static constexpr Duration kHeardFor = std::chrono::seconds{3};

  /// Precondition: 0 < shortest <= longest.
  explicit TelemetryPace(TelemetryPeriods periods);

  void hear(VehicleId of, const VehicleState& state, Instant now);
  /// From one telemetry of the vehicle, in this state, to its next: the shortest, or a whole part
  /// of the longest, whose multiples are then multiples of it, too (but for rounding to
  /// nanoseconds).
  [[nodiscard]] Duration period(const VehicleState& own, Instant now);

 private:
  struct Heard {
    VehicleState state;
    Instant at;
  };
  TelemetryPeriods periods_;
  std::map<VehicleId, Heard> heard_;
};

}  // namespace skein::mission
