// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/fence_desk.hpp"

#include <fmt/format.h>

#include <utility>

#include "fence_file.hpp"
#include "skein/console/team_fence.hpp"

namespace skein::groundstation {
Answer FenceDesk::answer(const NewFence& order, Instant now) {
  Fence fence = order.fence;
  if (!order.file.empty()) {
    auto corners = load_fence(order.file, *origin_);
    if (!corners) return {false, corners.error().message + "\n"};
    fence.corners = *std::move(corners);
  }
  if (order.preview) {
    const auto good = mission::GroundFence::check(fence, node_->fleet());
    if (!good) return {false, good.error().message + "\n"};
    return {true, "can be ordered: " + console::fence_size(fence) + "\n"};
  }
  const auto number = node_->order_fence(fence, now);
  if (!number) return {false, number.error().message + "\n"};
  return {true, fmt::format("fence of order {}, {}: told to all; 'fence' shows who keeps it\n",
                            *number, console::fence_size(fence))};
}

}  // namespace skein::groundstation
