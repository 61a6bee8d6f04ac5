// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "skein/base/time.hpp"

namespace skein::hil {

/// How the operator of a scenario ends it that is to end on the ground: orders, each until the
/// ground station takes it.
class OrdersToLand {
 public:
  /// The next, where it is time for one; what came of it.
  [[nodiscard]] std::optional<std::string> give(const std::string& control_socket, Instant now);

 private:
  std::size_t next_ = 0;
  Instant again_at_{};
};

}  // namespace skein::hil
