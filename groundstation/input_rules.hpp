// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/groundstation/orders.hpp"

namespace skein::groundstation {

/// Nothing comes of it but an answer: whoever may look may ask it, and the audit has none of it.
[[nodiscard]] bool only_looks(const Input& input);

/// The console is on other machines: it opens no files here, and ends nothing that it cannot start.
/// Why, or null.
[[nodiscard]] const char* why_not_on_console(const Input& input);

}  // namespace skein::groundstation
