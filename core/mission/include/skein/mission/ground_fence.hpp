// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

class Fleet;

/// The fence that the team is to keep: that of the configuration, until the operator orders another
/// one. Each vehicle judges for itself whether it can (FenceAnswered), and tells by Health::fence
/// which one it keeps. Calling rules as of GroundAgent.
class GroundFence {
 public:
  explicit GroundFence(Fence configured) : fence_{std::move(configured)} {}

  /// What this program said before it was started anew.
  void recall(const Message& message, VehicleId sender, Instant at);
  void on_timeout(Instant now);

  /// Can it be ordered? Fails where it is none, where a vehicle that is heard is outside of it, and
  /// where a height is above it: with the vehicle.
  [[nodiscard]] static Result<void> check(const Fence& fence, const Fleet& fleet);
  /// Tells everybody, every 5 s from now on, so that who was out of reach or starts anew hears of
  /// it too. Gives the number of the order. Fails as check().
  Result<std::uint32_t> order(const Fence& fence, const Fleet& fleet, Instant now);

  [[nodiscard]] const Fence& fence() const { return fence_; }
  /// Of the newest order; none: the fence is that of the configuration, or there is none.
  [[nodiscard]] std::optional<std::uint32_t> ordered() const;

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped(); }

 private:
  void take(const FenceOrder& order);

  Fence fence_;
  std::optional<FenceOrder> order_;
  Instant next_ = Instant::max();
  BoundedQueue<Message> messages_{8};
};

}  // namespace skein::mission
