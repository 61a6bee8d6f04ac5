// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/time.hpp"

namespace skein::network {

/// Whether more are ready than there are processors for, twice as many of the last minute.
[[nodiscard]] bool is_machine_overloaded();

/// How long a thread was ready and had no processor, by the kernel's account: who has to wait is on
/// a machine too busy for others' silence to mean anything.
class ProcessorWait {
 public:
  /// Of the thread that makes it.
  ProcessorWait();
  ~ProcessorWait();
  ProcessorWait(const ProcessorWait&) = delete;
  ProcessorWait& operator=(const ProcessorWait&) = delete;

  /// Since the last call; zero where the kernel does not say.
  [[nodiscard]] Duration since_last();

 private:
  int file_;
  Duration before_{};
};

}  // namespace skein::network
