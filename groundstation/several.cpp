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
  return {not_told.empty(),
          fmt::format("told to {}\n{}", told.empty() ? "nobody" : typed_ids(told), not_told)};
}

}  // namespace skein::groundstation
