// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "skein/identity/node_key.hpp"

namespace skein::identity_desk {

/// What is in a folder of keys: the mission, this node, of a mission's authority all members, and
/// what is wrong. No secret is in it.
struct KeysShown {
  std::string text;
  std::string json;  ///< the same, for programs
  bool good = true;  ///< could the node take part now?
};
[[nodiscard]] KeysShown show_keys(const identity::KeyFolder& keys, std::int64_t now_unix_s);

}  // namespace skein::identity_desk
