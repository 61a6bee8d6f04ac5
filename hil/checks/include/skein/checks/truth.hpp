// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "skein/checks/flown.hpp"
#include "skein/checks/run_record.hpp"

/// What was planned, what the vehicles believed, and what their aircraft really did, as their
/// simulators say.
namespace skein::checks {

/// Root mean square and largest magnitude.
struct Spread {
  double rms = 0.0;
  double most = 0.0;
};

/// Of a track from its plans, from when it has first come within kJoined_m of them.
struct PlanErrors {
  std::size_t points = 0;
  Spread cross_m;
  Spread along_m;
  Spread height_m;
};
inline constexpr double kJoined_m = 10.0;

/// How far a copter in formation was from where control wanted it at that moment, in space, as it
/// believed; none of what it did not do. Where it is to be is in no plan, so what it did is told by
/// what it flew.
struct OffPlace {
  std::optional<Spread> in_place;  ///< while the formation holds, or it stands
  std::optional<Spread> level;     ///< while it moves and keeps its height
  std::optional<Spread> climbing;  ///< or sinking: take-off, landing, another height

  [[nodiscard]] bool known() const { return in_place || level || climbing; }
};

/// One aircraft.
struct FlownTruly {
  VehicleId vehicle;
  PlanErrors believed;
  PlanErrors truly;
  OffPlace off_place_m;
  Spread apart_m;  ///< what was believed from what was true at the same time, in space
};
/// Of those whose truth is known.
[[nodiscard]] std::vector<FlownTruly> flown_truly(const RunRecord& record, const Limits& limits);

/// The same delivery as it was believed and as it was; only what both tracks show.
struct DeliveryTruly {
  DeliveryFlown believed;
  DeliveryFlown truly;
};
[[nodiscard]] std::vector<DeliveryTruly> deliveries_truly(const RunRecord& record,
                                                          const Limits& limits);

}  // namespace skein::checks
