// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/run_record.hpp"

#include <algorithm>

namespace skein::checks {

const recording::Recording* recording_of(const std::vector<recording::Recording>& recordings,
                                         VehicleId vehicle) {
  const auto found = std::ranges::find(recordings, vehicle, &recording::Recording::vehicle);
  return found == recordings.end() ? nullptr : &*found;
}

}  // namespace skein::checks
