// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace skein {

/// "0.2.0+g3797e83c0ffe": the release that this is or becomes and the commit that was built, as
/// semantic versions write it; with ".dirty" behind it where the tree had changes. Only "0.2.0"
/// where the commit is not known.
[[nodiscard]] const std::string& version();

}  // namespace skein
