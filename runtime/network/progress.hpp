// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "skein/base/time.hpp"

namespace skein::network {

/// Sees from outside whether the threads of Fast DDS get on. From any thread, without a lock: one
/// that hangs must not hold it.
class Progress {
 public:
  /// Around what a thread does with a datagram that came in.
  class Receiving {
   public:
    Receiving(Progress& progress, Instant now);
    ~Receiving();
    Receiving(const Receiving&) = delete;
    Receiving& operator=(const Receiving&) = delete;

   private:
    std::atomic<std::int64_t>* slot_ = nullptr;
  };

  /// Something was handed over that has a reader, so a datagram must go out.
  void written(Instant now);
  void sent() { unsent_since_.store(kNever, std::memory_order_relaxed); }

  /// For how long the slowest has been at it; zero where all rest.
  [[nodiscard]] Duration longest(Instant now) const;

 private:
  static constexpr std::int64_t kNever = 0;
  static constexpr std::size_t kThreadsMax = 16;  ///< more are not watched
  std::array<std::atomic<std::int64_t>, kThreadsMax> receiving_since_{};
  std::atomic<std::int64_t> unsent_since_{kNever};
};

}  // namespace skein::network
