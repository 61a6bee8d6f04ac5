// SPDX-License-Identifier: Apache-2.0
#include "link_params.hpp"

namespace skein::onboard {

ardupilot::CanLinkParams can_params(const configuration::VehicleConfig& config) {
  const configuration::ArdupilotConfig& fc = config.flight_controller.ardupilot;
  ardupilot::CanLinkParams params;
  params.node_id = fc.node_id;
  params.companion_node_id = fc.companion_node_id;
  params.serial_id = fc.serial_id;
  ardupilot::CompanionParams& companion = params.companion;
  companion.vehicle = config.vehicle;
  companion.fence = config.fence;
  companion.system_id = fc.system_id;
  companion.airframe = config.vehicle.airframe;
  switch (fc.take_over) {
    case configuration::TakeOverKind::in_flight:
      companion.take_over = ardupilot::TakeOver::in_flight;
      break;
    case configuration::TakeOverKind::from_ground:
      companion.take_over = ardupilot::TakeOver::from_ground;
      break;
    case configuration::TakeOverKind::when_guided:
    case configuration::TakeOverKind::count:
      companion.take_over = ardupilot::TakeOver::when_guided;
      break;
  }
  companion.takeoff_height_m = fc.takeoff_height_m;
  companion.geoid_height_m = fc.geoid_height_m;
  return params;
}

}  // namespace skein::onboard
