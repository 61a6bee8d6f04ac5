// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/run_record.hpp"

#include <algorithm>

namespace skein::checks {

const recording::Recording* recording_of(const RunRecord& record, VehicleId vehicle) {
  const auto found =
      std::find_if(record.recordings.begin(), record.recordings.end(),
                   [&](const recording::Recording& r) { return r.vehicle == vehicle; });
  return found == record.recordings.end() ? nullptr : &*found;
}

}  // namespace skein::checks
