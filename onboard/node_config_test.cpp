// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/node_config.hpp"

#include <gtest/gtest.h>

namespace skein::onboard {
namespace {

bool lands_by_itself(const configuration::VehicleConfig& config) {
  const auto node = node_config(config, std::nullopt, {1}, "skein-onboard 1");
  return std::get<mission::VehicleAgentConfig>(node.agent).lands_by_itself;
}

/// Real ground is looked at by people.
TEST(NodeConfig, APlaneOnAnArdupilotLandsByItselfOnlyWhereItsFileSaysWhere) {
  configuration::VehicleConfig config;
  config.vehicle.capabilities.add(TaskKind::survey);
  EXPECT_TRUE(lands_by_itself(config));
  config.flight_controller.kind = configuration::FlightControllerKind::ardupilot;
  EXPECT_FALSE(lands_by_itself(config));
  config.vehicle.landing.x_m = config.vehicle.landing.y_m = 10.0;
  EXPECT_FALSE(lands_by_itself(config)) << "in which direction?";
  config.vehicle.landing.heading_rad = 1.0;
  EXPECT_TRUE(lands_by_itself(config));
  config.vehicle.recovery = Recovery::anywhere;
  EXPECT_FALSE(lands_by_itself(config));
  config.vehicle.landing = {};
  config.vehicle.airframe = Airframe::copter;
  EXPECT_TRUE(lands_by_itself(config));
}

}  // namespace
}  // namespace skein::onboard
