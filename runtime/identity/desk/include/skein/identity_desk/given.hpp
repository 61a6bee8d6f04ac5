// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/identity/membership.hpp"

namespace skein::identity_desk {

/// The lines that an argument names: itself where it begins with `prefix`, standard input for "-",
/// else those of a file; without the empty ones. Fails where there are none, or more than 4 MB.
[[nodiscard]] Result<std::vector<std::string>> given_lines(const std::string& argument,
                                                           std::string_view prefix);

/// What such an argument is, for an error: the file's name, or what stands in its place.
[[nodiscard]] std::string name_of_given(const std::string& argument, std::string_view prefix);

/// The one membership that an argument names, as the authority answered to this node's request.
[[nodiscard]] Result<identity::Membership> given_membership(const std::string& argument);

/// By this machine's clock.
[[nodiscard]] std::int64_t now_unix_s();

}  // namespace skein::identity_desk
