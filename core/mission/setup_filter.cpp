// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/setup_filter.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {

/// Twice as many as the book waits for: some may be lost behind this filter.
constexpr int kToHeed = 2 * SetupBook::kClean;

}  // namespace

SetupFilter::SetupFilter(const SetupParams& params, VehicleId self)
    : clock_guard_{params.clock_guard}, self_{self}, items_{items_of(params)} {}

bool SetupFilter::heeds(const Message& message, Instant now) {
  if (const auto* setup = std::get_if<Setup>(&message)) return heeds(*setup, now);
  // The book finds clocks that are ahead by telemetry, too, and waits for setups then.
  const auto* telemetry = std::get_if<Telemetry>(&message);
  if (telemetry != nullptr && telemetry->state.time > now + clock_guard_) {
    heard(telemetry->vehicle).to_heed = kToHeed;
  }
  return true;
}

bool SetupFilter::heeds(const Setup& setup, Instant now) {
  if (setup.node == kGroundStation || setup.node == self_) return true;
  Heard& before = heard(setup.node);
  const InstanceId instance = std::exchange(before.instance, setup.instance);
  const bool same_start = instance == setup.instance || instance == InstanceId{};
  if (!same_start || !is_usual(setup, now)) {
    before.to_heed = kToHeed;
    return true;
  }
  if (before.to_heed == 0) return false;
  --before.to_heed;
  return true;
}

bool SetupFilter::is_usual(const Setup& setup, Instant now) const {
  return setup.knows_orders && !contains(setup.ahead, self_) && setup.items == items_ &&
         setup.time - now <= std::min(clock_guard_, setup.clock_guard);
}

SetupFilter::Heard& SetupFilter::heard(VehicleId node) {
  if (heard_.size() <= node.value) heard_.resize(node.value + std::size_t{1});
  return heard_[node.value];
}

}  // namespace skein::mission
