// SPDX-License-Identifier: Apache-2.0
#include "skein/process/close_limit.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>

namespace skein::process {

CloseLimit::~CloseLimit() {
  {
    const std::lock_guard lock{mutex_};
    closed_ = true;
  }
  changed_.notify_one();
  if (watch_.joinable()) watch_.join();
}

void CloseLimit::start(std::chrono::milliseconds limit) {
  watch_ = std::thread{[this, limit] {
    std::unique_lock lock{mutex_};
    if (changed_.wait_for(lock, limit, [this] { return closed_; })) return;
    spdlog::warn("the network did not close within {} ms; ending without it", limit.count());
    spdlog::default_logger()->flush();
    std::_Exit(0);
  }};
}

}  // namespace skein::process
