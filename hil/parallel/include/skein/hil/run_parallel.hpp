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

/// Flies the runs 0 .. count - 1, each once, on `jobs` threads, of which the caller's is one, and
/// hands each to `take` when it ends, from one thread at a time. Once one fails, cannot be taken,
/// or `stopped` says so before it begins, no other begins; the error is that of the first run in
/// their order, whatever `jobs` is.
template <class Run>
[[nodiscard]] Result<void> each_parallel(
    std::size_t count, std::size_t jobs, const std::function<Result<Run>(std::size_t)>& fly,
    const std::function<Result<void>(std::size_t, Run&&)>& take,
    const std::function<bool()>& stopped = {}) {
  std::size_t failed = count;
  std::optional<Error> error;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      if (stopped && stopped()) return;
      Result<Run> run = fly(i);
      const std::lock_guard lock{mutex};
      const Result<void> done = run ? take(i, std::move(*run)) : Result<void>{run.error()};
      if (done) continue;
      // Those before it have all begun: the first that fails is among them, or it is this one.
      next = count;
      if (i > failed) continue;
      failed = i;
      error = done.error();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min(jobs, count); ++i) others.emplace_back(work);
    work();
  }
  if (error) return *error;
  return {};
}

/// As each_parallel(); the result is in the order of the runs and does not depend on `jobs`.
/// `on_done` is called after every run, from one thread at a time, in the order in which they end.
template <class Run>
[[nodiscard]] Result<std::vector<Run>> run_parallel(
    std::size_t count, std::size_t jobs, const std::function<Result<Run>(std::size_t)>& fly,
    const std::function<void(const Run&)>& on_done = {}) {
  std::vector<Run> runs(count);
  const auto take = [&](std::size_t i, Run&& run) -> Result<void> {
    runs[i] = std::move(run);
    if (on_done) on_done(runs[i]);
    return {};
  };
  if (const auto flown = each_parallel<Run>(count, jobs, fly, take); !flown) return flown.error();
  return runs;
}

}  // namespace skein::hil
