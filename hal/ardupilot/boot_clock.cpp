// SPDX-License-Identifier: Apache-2.0
#include "boot_clock.hpp"

#include <algorithm>

namespace skein::ardupilot {
namespace {

/// Of two crystals against each other: 100 ppm.
constexpr int kDriftDivisor = 10'000;
/// Two round trips that are further apart than what they may be wrong, and this, contradict.
constexpr Duration kContradiction = std::chrono::milliseconds{1};

}  // namespace

void BootClock::restart() {
  best_.reset();
  earliest_zero_.reset();
}

Duration BootClock::uncertainty(Instant now) const {
  if (!best_) return Duration::max();
  return best_->half_trip + (now - best_->at) / kDriftDivisor;
}

void BootClock::on_round_trip(Instant sent, Instant answered, Duration boot) {
  if (answered < sent) return;
  const Duration half = (answered - sent) / 2;
  const Instant zero = sent + half - boot;
  if (best_) {
    const Duration known = uncertainty(answered);
    // Which of them is wrong cannot be told.
    if (std::chrono::abs(zero - best_->zero) > half + known + kContradiction) return restart();
    if (half > known) return;
  }
  best_ = Binding{zero, half, answered};
}

void BootClock::on_arrival(Instant now, Duration boot) {
  const Instant zero = now - boot;
  earliest_zero_ = std::min(earliest_zero_.value_or(zero), zero);
}

std::optional<Instant> BootClock::mission_time(Duration boot, Instant now) const {
  if (best_) return std::min(now, best_->zero + boot);
  if (earliest_zero_) return std::min(now, *earliest_zero_ + boot);
  return std::nullopt;
}

}  // namespace skein::ardupilot
