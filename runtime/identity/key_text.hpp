// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "skein/base/result.hpp"
#include "skein/identity/folder_lock.hpp"
#include "skein/identity/node_key.hpp"

namespace skein::identity {

/// "SKEIN-NODE-KEY-1:...": the private keys.
[[nodiscard]] std::string to_text(const NodeKey& key);
/// With a count of starts, where there is none.
[[nodiscard]] Result<void> keep_node_key(const std::filesystem::path& folder, const NodeKey& key,
                                         Durable durable);

}  // namespace skein::identity
