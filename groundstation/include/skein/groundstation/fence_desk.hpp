// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/frames.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// Where the operator gives the team another fence. Without I/O but for its file.
class FenceDesk {
 public:
  /// The node must outlive it.
  FenceDesk(mission::GroundNode& node, const MissionOrigin& origin)
      : node_{&node}, origin_{&origin} {}

  /// What came of it, for the operator.
  [[nodiscard]] Answer answer(const NewFence& order, Instant now);

 private:
  mission::GroundNode* node_;
  const MissionOrigin* origin_;
};

}  // namespace skein::groundstation
