// SPDX-License-Identifier: Apache-2.0
#include "repair_pace.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace skein::air {
namespace {

using namespace std::chrono_literals;

/// Who waits longer for what comes by itself is too late for what does not.
constexpr Duration kLatestMax = 200ms;
constexpr Duration kRoundTripMin = 20ms;
constexpr Duration kRoundTripMax = 150ms;
constexpr Duration kAskAgainMax = 300ms;
constexpr int kSlower = 2;  ///< so often the wait for an answer doubles
/// What was late counts for half after this long.
constexpr Duration kHalved = 30s;
constexpr std::int64_t kSmoothing = 8;
/// Where no first question is answered in time, questions must become slower at last; where much is
/// lost, first ones that are answered outweigh it.
constexpr std::int64_t kSlowDown = 64;

}  // namespace

void RepairPace::on_late(Duration by, Instant now) {
  if (by > kLatestMax) return;
  latest_ = std::max(by, latest(now));
  latest_at_ = now;
}

void RepairPace::on_answer(Duration after) {
  round_trip_ += (after - round_trip_) / kSmoothing;
  round_trip_ = std::clamp(round_trip_, kRoundTripMin, kRoundTripMax);
}

void RepairPace::on_late_answer() {
  round_trip_ = std::min(round_trip_ + round_trip_ / kSlowDown, kRoundTripMax);
}

Duration RepairPace::latest(Instant now) const {
  const double halves = to_seconds(now - latest_at_) / to_seconds(kHalved);
  return from_seconds(to_seconds(latest_) * std::exp2(-halves));
}

Duration RepairPace::patience(Instant now, Random& random) const {
  return latest(now) + from_seconds(to_seconds(least_) * random.uniform(1.0, 2.0));
}

Duration RepairPace::ask_again(int asked) const {
  return std::min(3 * round_trip_ / 2 * (1 << std::min(asked, kSlower)), kAskAgainMax);
}

}  // namespace skein::air
