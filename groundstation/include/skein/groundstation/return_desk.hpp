// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// Shows the ways home before they are ordered. To plan them takes time, and whoever may look may
/// ask: what was found is shown again for a second, and nothing else is planned meanwhile.
class ReturnDesk {
 public:
  static constexpr Duration kShownFor = std::chrono::seconds{1};

  explicit ReturnDesk(const mission::GroundNode& node) : node_{node} {}

  [[nodiscard]] Answer answer(const ReturnPreview& asked, Instant now);

 private:
  struct Shown {
    std::vector<VehicleId> vehicles;
    Answer answer;
    Instant at{};
  };
  const mission::GroundNode& node_;
  std::optional<Shown> shown_;
};

}  // namespace skein::groundstation
