// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/groundstation/orders.hpp"

/// The orders of sites as they are typed.
namespace skein::groundstation {

/// "site EAST NORTH ..." or "change site N ...".
[[nodiscard]] Result<Input> site_order(const std::vector<std::string_view>& words, bool preview);
/// "withdraw site N", "withdraw hazard N".
[[nodiscard]] Result<Input> withdrawal(const std::vector<std::string_view>& words);
/// "accept N", "dismiss N".
[[nodiscard]] Result<Input> proposal_answer(bool accept,
                                            const std::vector<std::string_view>& words);
/// What site_order() reads back as the same.
[[nodiscard]] std::string site_line(const NewSite& order);

}  // namespace skein::groundstation
