// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/telemetry_pace.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "skein/base/assert.hpp"

namespace skein::mission {
namespace {

/// Of the distance, that may change between two times.
constexpr double kPart = 0.1;

}  // namespace

TelemetryPace::TelemetryPace(TelemetryPeriods periods) : periods_{periods} {
  SKEIN_ASSERT(periods.shortest > Duration{} && periods.shortest <= periods.longest);
}

void TelemetryPace::hear(VehicleId of, const VehicleState& state, Instant now) {
  if (periods_.shortest == periods_.longest) return;  // whoever is near
  const auto known = heard_.find(of);
  if (known != heard_.end()) {
    known->second = {state, now};
  } else if (heard_.size() < kVehiclesMax) {
    heard_.emplace(of, Heard{state, now});
  }
}

Duration TelemetryPace::period(const VehicleState& own, Instant now) {
  std::erase_if(heard_, [now](const auto& entry) { return now - entry.second.at > kHeardFor; });
  double period_s = to_seconds(periods_.longest);
  for (const auto& [id, other] : heard_) {
    const double distance_m =
        std::hypot(own.x_m - other.state.x_m, own.y_m - other.state.y_m, own.z_m - other.state.z_m);
    const double closing_mps = own.velocity_mps().norm() + other.state.velocity_mps().norm();
    if (kPart * distance_m < period_s * closing_mps) period_s = kPart * distance_m / closing_mps;
  }
  const auto parts = std::max(1.0, std::ceil(to_seconds(periods_.longest) / period_s - 1e-9));
  if (parts >=
      static_cast<double>(periods_.longest / periods_.shortest)) {  // infinite, where both meet
    return periods_.shortest;
  }
  return periods_.longest / static_cast<std::int64_t>(parts);
}

}  // namespace skein::mission
