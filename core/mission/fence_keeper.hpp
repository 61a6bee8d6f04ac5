// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "skein/domain/fence.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Which fence a vehicle keeps: that of its configuration, then what the operator orders and the
/// vehicle can keep. The order is said again and again: one that cannot be kept is looked at with
/// each time, and answered when the answer is another one.
class FenceKeeper {
 public:
  explicit FenceKeeper(Fence configured) : fence_{std::move(configured)} {}

  /// Why not, for people; empty: it can be kept.
  [[nodiscard]] static std::string why_not(const Fence& fence, const VehicleState& state) {
    if (const auto why = why_no_fence(fence)) return *why;
    if (fence.inside_m({state.x_m, state.y_m}) <= 0.0) return "it is outside of it";
    if (state.z_m >= fence.height_max_m) return "it flies above its height";
    return {};
  }

  /// The fence of an order that is news; none: it is kept already, or an older one.
  [[nodiscard]] std::optional<Fence> asked(const FenceOrder& order) const {
    if (order.number <= number_) return std::nullopt;
    return Fence{order.corners, order.height_max_m};
  }

  /// What came of it. Gives what is to be told.
  std::optional<event::FenceAnswered> answer(const FenceOrder& order, const Fence& fence,
                                             const std::string& why) {
    if (why.empty()) {
      number_ = order.number;
      fence_ = fence;
      changed_ = true;
    } else if (refused_ == std::pair{order.number, why}) {
      return std::nullopt;
    }
    refused_ = {order.number, why};
    return event::FenceAnswered{order.number, why.empty(), digest_of(fence_), why};
  }

  [[nodiscard]] const Fence& fence() const { return fence_; }
  /// For the flight controller: a new one.
  [[nodiscard]] std::optional<Fence> poll_changed() {
    if (!std::exchange(changed_, false)) return std::nullopt;
    return fence_;
  }

 private:
  Fence fence_;
  std::uint32_t number_ = 0;  ///< of the order that is kept
  std::pair<std::uint32_t, std::string> refused_;
  bool changed_ = false;
};

}  // namespace skein::mission
