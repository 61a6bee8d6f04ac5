// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace skein::configuration {

/// Of one of several ground stations of a mission, of which one has the command.
struct CommandConfig {
  std::uint16_t station = 0;  ///< its number; 0: there is no other
  std::string name;           ///< by which the others' operators know it
  bool watches = false;       ///< it never takes the command by itself
  friend bool operator==(const CommandConfig&, const CommandConfig&) = default;
};

}  // namespace skein::configuration
