// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_fence.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "names.hpp"
#include "skein/mission/fleet.hpp"

namespace skein::mission {
namespace {

constexpr Duration kRepeat = std::chrono::seconds{5};

}  // namespace

void GroundFence::recall(const Message& message, VehicleId sender, Instant at) {
  const auto* order = std::get_if<FenceOrder>(&message);
  if (order == nullptr || sender != kGroundStation) return;
  if (order_ && order->number <= order_->number) return;
  take(*order);
  next_ = std::min(next_, at);
}

void GroundFence::take(const FenceOrder& order) {
  order_ = order;
  fence_.corners = order.corners;
  fence_.height_max_m = order.height_max_m;
}

Result<void> GroundFence::check(const Fence& fence, const Fleet& fleet) {
  if (const auto why = why_no_fence(fence)) return Error{"this is no fence: " + *why};
  for (const auto& [id, known] : fleet.vehicles()) {
    if (!known.telemetry || known.silent) continue;
    const VehicleState& state = known.telemetry->state;
    if (fence.inside_m({state.x_m, state.y_m}) <= 0.0) {
      return Error{name_of(id) + " is outside of it: widen it, or bring the vehicle in first"};
    }
    if (state.z_m >= fence.height_max_m) {
      return Error{name_of(id) + " flies above its height: raise that, or bring it down first"};
    }
  }
  return {};
}

Result<std::uint32_t> GroundFence::order(const Fence& fence, const Fleet& fleet, Instant now) {
  if (auto good = check(fence, fleet); !good) return good.error();
  const auto since_epoch =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::max(now, Instant{}) - Instant{});
  const std::uint32_t last = order_ ? order_->number : 0;
  // As Command::number: a ground station that has forgotten what it ordered goes on beyond it.
  const auto number = std::max(last, static_cast<std::uint32_t>(since_epoch.count())) + 1;
  take({number, fence.corners, fence.height_max_m});
  messages_.push(Message{*order_});
  next_ = now + kRepeat;
  return number;
}

std::optional<std::uint32_t> GroundFence::ordered() const {
  return order_ ? std::optional{order_->number} : std::nullopt;
}

void GroundFence::on_timeout(Instant now) {
  if (now < next_ || !order_) return;
  messages_.push(Message{*order_});
  next_ = now + kRepeat;
}

}  // namespace skein::mission
