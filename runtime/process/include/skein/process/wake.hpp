// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace skein::process {

/// Wakes a thread that has nothing to do. A call before the wait is not lost. Not for the control
/// thread: it locks.
class Wake {
 public:
  void notify() {
    {
      const std::lock_guard lock{mutex_};
      raised_ = true;
    }
    raised_changed_.notify_one();
  }
  /// Returns when notified since the last wait, or at `deadline`.
  void wait_until(std::chrono::steady_clock::time_point deadline) {
    std::unique_lock lock{mutex_};
    raised_changed_.wait_until(lock, deadline, [this] { return raised_; });
    raised_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable raised_changed_;
  bool raised_ = false;
};

}  // namespace skein::process
