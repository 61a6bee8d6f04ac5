// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace skein::hil {

/// Takes SIGINT and SIGTERM over while it lives. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// Since the newest was made.
  [[nodiscard]] static bool interrupted();

 private:
  struct sigaction old_int_ {};
  struct sigaction old_term_ {};
};

}  // namespace skein::hil
