// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace skein::process {

/// How a process is asked to end: SIGINT, SIGTERM, or itself. Blocks both signals in the thread
/// that makes it and in those that this thread starts afterwards, so make it before any thread.
class Shutdown {
 public:
  Shutdown();
  ~Shutdown() = default;
  Shutdown(const Shutdown&) = delete;
  Shutdown& operator=(const Shutdown&) = delete;

  /// Blocks until asked. Gives the name of the signal.
  const char* wait() const;
  /// The same, or null once `at_most` is over.
  [[nodiscard]] const char* wait_for(std::chrono::nanoseconds at_most) const;
  /// Asks. From any thread.
  void request() const;
};

}  // namespace skein::process
