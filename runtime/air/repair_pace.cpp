// SPDX-License-Identifier: Apache-2.0
#include "repair_pace.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace skein::air {
namespace {

using namespace std::chrono_literals;

/// Whoever waits longer for what comes by itself is too late for what does not.
constexpr Duration kPatienceMax = 200ms;
constexpr Duration kRoundTripMin = 20ms;
constexpr Duration kRoundTripMax = 300ms;
/// What was late counts for half after this long.
constexpr Duration kHalved = 30s;
constexpr std::int64_t kSmoothing = 8;

}  // namespace

void RepairPace::on_late(Duration by, Instant now) {
  latest_ = std::clamp(by, patience(now) - least_, kPatienceMax);
  latest_at_ = now;
}

void RepairPace::on_answer(Duration after) {
  round_trip_ =
      std::clamp(round_trip_ + (after - round_trip_) / kSmoothing, kRoundTripMin, kRoundTripMax);
}

Duration RepairPace::patience(Instant now) const {
  const double halves = to_seconds(now - latest_at_) / to_seconds(kHalved);
  return least_ + from_seconds(to_seconds(latest_) * std::exp2(-halves));
}

}  // namespace skein::air
