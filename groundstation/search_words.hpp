// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/console/alarms.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

/// How far the search of an area is, and what ends it, in words.
namespace skein::groundstation {

/// "3 min 20 s", as on the page.
[[nodiscard]] std::string duration_text(double seconds);
/// "31.2 of 65.0 ha searched (48 %)"
[[nodiscard]] std::string searched_text(const mission::GroundSearch& search);
/// How far the newest area is, who has what left, and when it will be done. Empty without one.
[[nodiscard]] std::string progress_text(const mission::GroundSearch& search,
                                        std::int64_t epoch_unix_ns, Instant now);

/// Whose part in a search ends if these obey an order that has nothing to do with it; a line, empty
/// where nobody's does.
[[nodiscard]] std::string ends_search_text(const mission::GroundSearch& search,
                                           const std::vector<VehicleId>& vehicles);
/// The same of all that an order asks something of: to hold, come home or land.
[[nodiscard]] std::string ends_search_text(const mission::GroundSearch& search, const Input& order);

/// For the alarms; none while all fly their shares, or have.
[[nodiscard]] std::optional<console::EndedSearch> ended_search(const mission::GroundSearch& search);

}  // namespace skein::groundstation
