// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"

/// Many runs at once that do not know of each other.
namespace skein::hil {

/// Threads to work with: as many as were asked for, one for each core where that is 0.
[[nodiscard]] inline std::size_t jobs_of(std::size_t asked) {
  return asked > 0 ? asked : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

/// Flies the runs 0 .. count - 1, each once, on `jobs` threads, of which the caller's is one. The
/// result is in the order of the runs and does not depend on `jobs`. `on_done` is called after
/// every run, from one thread at a time, in the order in which they end. Once one fails no other
/// begins, and the error is that of the first run that fails, whatever `jobs` is.
template <class Run>
[[nodiscard]] Result<std::vector<Run>> run_parallel(
    std::size_t count, std::size_t jobs, const std::function<Result<Run>(std::size_t)>& fly,
    const std::function<void(const Run&)>& on_done = {}) {
  std::vector<Run> runs(count);
  std::size_t failed = count;
  std::optional<Error> error;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      Result<Run> run = fly(i);
      const std::lock_guard lock{mutex};
      if (run) {
        runs[i] = std::move(*run);
        if (on_done) on_done(runs[i]);
        continue;
      }
      // Those before it have all begun: the first that fails is among them, or it is this one.
      next = count;
      if (i > failed) continue;
      failed = i;
      error = run.error();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min(jobs, count); ++i) others.emplace_back(work);
    work();
  }
  if (error) return *error;
  return runs;
}

}  // namespace skein::hil
