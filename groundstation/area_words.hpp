// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/groundstation/orders.hpp"

/// The words of orders that draw: search areas and hazards.
namespace skein::groundstation {

using Words = std::vector<std::string_view>;

/// `hazard ...` or `change hazard N ...`.
[[nodiscard]] Result<Input> hazard_order(const Words& words, bool preview);
/// `search ...`; alone it looks.
[[nodiscard]] Result<Input> search_order(const Words& words, bool preview);

[[nodiscard]] std::string hazard_line(const NewHazard& hazard);
[[nodiscard]] std::string search_line(const SearchArea& search);

}  // namespace skein::groundstation
