// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/hil/radio/link_table.hpp"

namespace skein::hil::radio {

struct RadioParams {
  double range_m = 1500.0;  ///< vehicle to vehicle (Wang 2022: r_n)
  double ground_range_m =
      20000.0;  ///< vehicle to ground station, which stands at the mission origin
  Duration delay{};
  Duration jitter{};
  double loss = 0.0;  ///< probability, of each message
};

/// The link from `from` to `to`, given where the vehicles are (mission frame) and the groups that
/// the network is cut into (each hears itself only; a node in no group hears the nodes in none).
/// A vehicle whose position is not known yet is not in range of other vehicles.
[[nodiscard]] Link link_between(const RadioParams& params, VehicleId from, VehicleId to,
                                const std::map<VehicleId, Vec2>& positions,
                                const std::vector<std::vector<VehicleId>>& groups);

}  // namespace skein::hil::radio
