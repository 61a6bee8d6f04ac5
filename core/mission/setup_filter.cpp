// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/setup_filter.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {

/// Those of a team that starts together are proven at different times: by whom, of whom.
Duration turn(VehicleId self, VehicleId node) {
  constexpr std::uint32_t kTurns = 50;
  return std::chrono::seconds{10 + (7U * self.value + 11U * node.value) % kTurns};
}

}  // namespace

SetupFilter::SetupFilter(const SetupParams& params, VehicleId self)
    : clock_guard_{params.clock_guard}, self_{self}, items_{items_of(params)} {}

bool SetupFilter::heeds(const Message& message, Instant now) {
  if (const auto* setup = std::get_if<Setup>(&message)) return heeds(*setup, now);
  // The book finds clocks that are ahead by telemetry, too, and waits for setups then.
  const auto* telemetry = std::get_if<Telemetry>(&message);
  if (telemetry != nullptr && telemetry->state.time > now + clock_guard_) {
    heard(telemetry->vehicle).heeded_until = now + kHeeded;
  }
  return true;
}

bool SetupFilter::heeds(const Setup& setup, Instant now) {
  if (setup.node == kGroundStation || setup.node == self_) return true;
  Heard& of = heard(setup.node);
  if (of.proven_at == Instant::max()) of.proven_at = now + turn(self_, setup.node);
  const InstanceId before = std::exchange(of.instance, setup.instance);
  const bool same_start = before == setup.instance || before == InstanceId{};
  if (!same_start || !is_usual(setup, now)) of.heeded_until = now + kHeeded;
  const bool heeded = now < of.heeded_until || now >= of.proven_at;
  if (now >= of.proven_at) of.proven_at = now + kProven;
  return heeded;
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
