// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iterator>
#include <string>
#include <utility>

#include "skein/onboard/preflight.hpp"

namespace skein::onboard {

/// Until in_group() says which.
inline constexpr CheckGroup kAnyGroup = CheckGroup::configuration;

[[nodiscard]] inline Check ok(std::string what, std::string found) {
  return {std::move(what), Verdict::ok, std::move(found), {}, kAnyGroup};
}
[[nodiscard]] inline Check warn(std::string what, std::string found, std::string remedy) {
  return {std::move(what), Verdict::warn, std::move(found), std::move(remedy), kAnyGroup};
}
[[nodiscard]] inline Check fail(std::string what, std::string found, std::string remedy) {
  return {std::move(what), Verdict::fail, std::move(found), std::move(remedy), kAnyGroup};
}
/// They are all about that.
[[nodiscard]] inline Checks in_group(CheckGroup group, Checks checks) {
  for (Check& check : checks) check.group = group;
  return checks;
}
inline void append(Checks& all, Checks more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace skein::onboard
