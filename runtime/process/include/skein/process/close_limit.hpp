// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace skein::process {

inline constexpr std::chrono::seconds kCloseWithin{4};

/// Lets a process end that has nothing left to do but to close its network. Fast DDS 2.9 can wait
/// for itself for ever when a participant is deleted while others come and go (eProsima/Fast-DDS,
/// issues 4026, 6193 and 6502). Make it before the network is opened, so that it outlives it.
class CloseLimit {
 public:
  CloseLimit() = default;
  ~CloseLimit();
  CloseLimit(const CloseLimit&) = delete;
  CloseLimit& operator=(const CloseLimit&) = delete;

  /// From now on: once `limit` is over and this still lives, the process says so in its log and
  /// ends with exit status 0. Everything must be recorded before. Call it once.
  void start(std::chrono::milliseconds limit);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool closed_ = false;
  std::thread watch_;
};

}  // namespace skein::process
