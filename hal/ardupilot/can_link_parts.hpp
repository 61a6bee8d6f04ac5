// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "link_watch.hpp"
#include "skein/ardupilot/can_link.hpp"

namespace skein::ardupilot {

/// The companion's node: the same for whoever speaks in its name, since autopilots refuse a node
/// whose unique id changes.
[[nodiscard]] dronecan::NodeParams node_params(const CanLinkParams& params);
[[nodiscard]] dronecan::TunnelParams tunnel_params(const CanLinkParams& params);
[[nodiscard]] LinkIds link_ids(const CanLinkParams& params, const std::string& bus);

}  // namespace skein::ardupilot
