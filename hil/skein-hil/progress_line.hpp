// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

namespace skein::hil {

/// One line on a terminal that is written over: how far, and how long still.
class ProgressLine {
 public:
  /// `before` stands at the beginning of the line.
  explicit ProgressLine(std::size_t runs, std::string before = "")
      : runs_{runs}, before_{std::move(before)}, shown_{::isatty(STDERR_FILENO) != 0} {}

  void count(bool held) {
    ++done_;
    if (!held) ++broken_;
    const auto now = Clock::now();
    if (!shown_ || (now < next_ && done_ < runs_)) return;
    next_ = now + std::chrono::milliseconds{200};
    const double passed = std::chrono::duration<double>(now - start_).count();
    const double left = passed * static_cast<double>(runs_ - done_) / static_cast<double>(done_);
    const std::string broken = broken_ > 0 ? fmt::format(", {} violated", broken_) : "";
    fmt::print(stderr, "\r{}{}/{} runs{}, {:.0f} s left   ", before_, done_, runs_, broken, left);
    std::fflush(stderr);
  }
  void clear() const {
    if (shown_) fmt::print(stderr, "\r{:60}\r", "");
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t runs_;
  std::string before_;
  bool shown_;
  std::size_t done_ = 0;
  std::size_t broken_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

}  // namespace skein::hil
