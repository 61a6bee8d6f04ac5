// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace skein::console {

/// A file of the page, compressed with gzip. Compiled into the program.
struct Asset {
  std::string_view path;  ///< "/assets/index-1a2b.js"; "/" for the page itself
  std::string_view type;  ///< MIME
  std::string_view gzip;
};
[[nodiscard]] std::span<const Asset> assets();

}  // namespace skein::console
