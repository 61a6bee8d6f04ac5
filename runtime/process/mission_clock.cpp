// SPDX-License-Identifier: Apache-2.0
#include "skein/process/mission_clock.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

#include "skein/base/assert.hpp"

namespace skein::process {
namespace {

constexpr Duration kWaitMax = std::chrono::hours{24};

Duration scaled(Duration d, double factor) {
  return Duration{std::llround(static_cast<double>(d.count()) * factor)};
}

struct BothClocks {
  std::chrono::steady_clock::time_point steady;
  Duration unix_time;
};

/// The two cannot be read at once: the realtime clock is read between two readings of the monotonic
/// one, and where another process had the core in between (milliseconds), again.
BothClocks read_both_clocks() {
  constexpr int kTries = 16;
  constexpr Duration kClose = std::chrono::microseconds{5};
  BothClocks best{};
  Duration least = Duration::max();
  for (int i = 0; i < kTries && least > kClose; ++i) {
    const auto before = std::chrono::steady_clock::now();
    const auto unix_now = std::chrono::system_clock::now().time_since_epoch();
    const Duration taken = std::chrono::steady_clock::now() - before;
    if (taken >= least) continue;
    least = taken;
    best = {before + taken / 2, std::chrono::duration_cast<Duration>(unix_now)};
  }
  return best;
}

}  // namespace

MissionClock::MissionClock(std::int64_t epoch_unix_ns, double rate)
    : rate_{rate}, epoch_unix_ns_{epoch_unix_ns} {
  SKEIN_ASSERT(epoch_unix_ns > 0);
  SKEIN_ASSERT(rate > 0.0);
  const BothClocks start = read_both_clocks();
  steady_start_ = start.steady;
  mission_start_ = Instant{scaled(start.unix_time - Duration{epoch_unix_ns}, rate_)};
}

Instant MissionClock::now() const {
  return mission_start_ + scaled(std::chrono::steady_clock::now() - steady_start_, rate_);
}

std::chrono::steady_clock::time_point MissionClock::steady_time_of(Instant t) const {
  const Instant soon = std::clamp(t, mission_start_, now() + scaled(kWaitMax, rate_));
  return steady_start_ + scaled(soon - mission_start_, 1.0 / rate_);
}

void MissionClock::sleep_until(Instant t) const {
  const auto since_boot = steady_time_of(t).time_since_epoch();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  timespec until{};
  until.tv_sec = static_cast<std::time_t>(whole.count());
  until.tv_nsec = static_cast<long>((since_boot - whole).count());
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace skein::process
