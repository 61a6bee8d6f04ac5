// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/base/result.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// Where the operator gives vehicles the routes of a plan's file (plan.yaml of `skein-ground plan`)
/// over the air. Without I/O but for that file.
class RouteDesk {
 public:
  /// The node must outlive it.
  explicit RouteDesk(mission::GroundNode& node) : node_{&node} {}

  // What came of it, for the operator.
  [[nodiscard]] Answer answer(const RoutesFromFile& order, Instant now);
  [[nodiscard]] Answer answer(const CallOffRoutes& order, Instant now);
  /// The plan that is given, and how far each vehicle is with its route.
  [[nodiscard]] std::string text(Instant now) const;
  /// The same for the table of the fleet: nothing where no plan is given.
  [[nodiscard]] std::string status_text(Instant now) const;

 private:
  mission::GroundNode* node_;
};

}  // namespace skein::groundstation
