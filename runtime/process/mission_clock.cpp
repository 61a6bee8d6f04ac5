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

}  // namespace

MissionClock::MissionClock(std::int64_t epoch_unix_ns, double rate) : rate_{rate} {
  SKEIN_ASSERT(rate > 0.0);
  // The two clocks cannot be read at once: the realtime one belongs between two monotonic readings.
  const auto before = std::chrono::steady_clock::now();
  const auto unix_now =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
  const auto after = std::chrono::steady_clock::now();
  steady_start_ = before + (after - before) / 2;
  const Duration since_epoch = epoch_unix_ns == 0 ? Duration{} : unix_now - Duration{epoch_unix_ns};
  mission_start_ = Instant{scaled(since_epoch, rate_)};
  epoch_unix_ns_ = epoch_unix_ns == 0 ? unix_now.count() : epoch_unix_ns;
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
