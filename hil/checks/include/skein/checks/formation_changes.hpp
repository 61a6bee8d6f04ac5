// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/checks/run_record.hpp"

namespace skein::checks {

/// A change of formation, as the ground station's events tell it.
struct FormationChange {
  std::uint32_t number = 0;
  std::string order;  ///< for people: "form wedge, straight"
  Instant begun{};
  std::optional<Instant> held;     ///< from then on all are in place
  Instant until = Instant::max();  ///< when the next one begins
  bool correction = false;         ///< of drift; it never holds anew
  /// Where the vehicles belong, mission frame; of a correction, as before it.
  std::map<VehicleId, Vec3> places;
};
/// In the order of time.
[[nodiscard]] std::vector<FormationChange> formation_changes(const RunRecord& record);

}  // namespace skein::checks
