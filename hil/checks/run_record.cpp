// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/run_record.hpp"

#include <algorithm>

namespace skein::checks {

const recording::Recording* recording_of(const std::vector<recording::Recording>& recordings,
                                         VehicleId vehicle) {
  const auto found = std::ranges::find(recordings, vehicle, &recording::Recording::vehicle);
  return found == recordings.end() ? nullptr : &*found;
}

bool was_left_alone(const RunRecord& record, VehicleId vehicle, Instant from, Instant until) {
  return std::ranges::any_of(record.left_alone, [&](const LeftAlone& alone) {
    return alone.vehicle == vehicle && alone.from <= until && from <= alone.until;
  });
}

}  // namespace skein::checks
