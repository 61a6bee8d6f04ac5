// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/several.hpp"

#include <fmt/format.h>

namespace skein::groundstation {

Answer tell_each(const OrderToSeveral& order, const std::function<Result<void>(VehicleId)>& tell) {
  std::vector<VehicleId> told;
  std::string not_told;
  for (const VehicleId vehicle : order.vehicles) {
    if (const auto given = tell(vehicle); given) {
      told.push_back(vehicle);
    } else {
      not_told += fmt::format("not to {}: {}\n", vehicle.value, given.error().message);
    }
  }
  return {
      .done = not_told.empty(),
      .text = fmt::format("told to {}\n{}", told.empty() ? "nobody" : typed_ids(told), not_told),
      .in_part = !told.empty() && !not_told.empty()};
}

Answer told_all(const Result<void>& outcome, const mission::Fleet& fleet,
                const std::function<std::optional<std::string>(VehicleId)>& why_not) {
  if (!outcome) return {false, outcome.error().message + "\n"};
  std::string not_told;
  std::vector<VehicleId> not_heard;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.expected) continue;
    if (const auto why = why_not(id)) {
      not_told += fmt::format("not to {}: {}\n", id.value, *why);
    } else if (!entry.telemetry || entry.silent) {
      not_heard.push_back(id);
    }
  }
  std::string text = not_told.empty() ? "told to all\n" : "told to all others\n" + not_told;
  if (!not_heard.empty()) {
    text += fmt::format("not heard now, and may not hear it: {}\n", typed_ids(not_heard));
  }
  return {true, std::move(text)};
}

}  // namespace skein::groundstation
