// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "in_flight.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// A node of the simulated network, as the radio sees it.
struct RadioNode {
  VehicleId id;
  Vec2 position{0.0, 0.0};
  bool on = true;  ///< hears
};

/// Who hears what, and when: range, loss, delay, and the faults of the mission's schedule. The last
/// node is the ground station, which hears and is heard everywhere.
class RadioChannel {
 public:
  RadioChannel(const TeamMission& mission, InFlight& air);

  /// From one node to all that hear it now.
  void broadcast(const std::vector<RadioNode>& nodes, std::size_t from,
                 const mission::Message& message, Instant now);

 private:
  void post(const RadioNode& sender, const RadioNode& receiver, std::size_t to,
            const std::shared_ptr<const Content>& what, Instant now);

  const TeamMission& mission_;
  InFlight& air_;
  Random random_;
};

}  // namespace skein::hil
