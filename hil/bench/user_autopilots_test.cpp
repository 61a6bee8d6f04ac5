// SPDX-License-Identifier: Apache-2.0
#include "user_autopilots.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "skein/base/angles.hpp"

namespace skein::hil {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

/// A program that does nothing, under a name.
std::string program(const std::string& name) {
  const auto folder = std::filesystem::path{testing::TempDir()} / "user_autopilots";
  std::filesystem::create_directories(folder);
  const auto file = folder / name;
  std::ofstream{file} << "#!/bin/sh\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  return file.string();
}

configuration::VehicleConfig vehicle() {
  configuration::VehicleConfig config;
  config.vehicle.id = VehicleId{4};
  config.vehicle.cruise_speed_mps = 25.0;
  config.vehicle.speed_min_mps = 20.5;
  config.vehicle.speed_max_mps = 29.5;
  config.vehicle.turn_radius_m = 66.0;
  config.origin = {31.5, 105.0, 480.0};
  config.start = {0.0, 0.0, heading_from_compass_deg(50.0)};
  config.flight_controller.kind = configuration::FlightControllerKind::ardupilot;
  config.flight_controller.ardupilot.node_id = 12;
  config.flight_controller.ardupilot.companion_node_id = 72;
  config.flight_controller.ardupilot.system_id = 9;
  config.flight_controller.ardupilot.takeoff_height_m = 300.0;
  config.flight_controller.wind = {5.0, heading_from_compass_deg(240.0), 1.5};
  return config;
}

TEST(UserAutopilots, TheirNamesSayWhatTheyFly) {
  const auto both = user_autopilots({program("arduplane"), program("my-arducopter")}, {});
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_TRUE(both->plane && both->copter);
  const auto nameless = user_autopilots({program("autopilot")}, {});
  ASSERT_FALSE(nameless);
  EXPECT_THAT(nameless.error().message, HasSubstr("arduplane or arducopter"));
  EXPECT_FALSE(user_autopilots({program("arduplane"), program("plane")}, {}));
  EXPECT_FALSE(user_autopilots({"/nowhere/arduplane"}, {}));
  EXPECT_FALSE(user_autopilots({program("arduplane")}, {"/nowhere/my.parm"}));
}

TEST(UserAutopilots, AreGivenWhatTheVehicleAsksOfThem) {
  const std::string text = autopilot_parameters(vehicle());
  for (const char* line :
       {"SYSID_THISMAV 9\n", "SYSID_MYGCS 9\n", "CAN_D1_UC_NODE 12\n", "CAN_D1_UC_S1_NOD 72\n",
        "FS_GCS_ENABL 1\n", "FS_LONG_ACTN 1\n", "TKOFF_ALT 300\n", "AIRSPEED_MIN 15\n",
        "AIRSPEED_CRUISE 25\n", "TECS_SPDWEIGHT 0\n", "AIRSPEED_MAX 30\n", "SIM_WIND_SPD 5\n",
        "SIM_WIND_DIR 240\n", "SIM_WIND_TURB 1.5\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
  // 25 m/s on 66 m: 44 degrees, and a reserve.
  EXPECT_THAT(text, HasSubstr("ROLL_LIMIT_DEG 54\n"));
}

TEST(UserAutopilots, OfAQuadplaneIsAnArduplaneWithRotorsThatStandStillInFlight) {
  configuration::VehicleConfig quadplane = vehicle();
  quadplane.vehicle.airframe = Airframe::quadplane;
  EXPECT_THAT(autopilot_parameters(quadplane),
              AllOf(HasSubstr("Q_ENABLE 1\nQ_ASSIST_SPEED 16\nFS_GCS_ENABL 1\n"),
                    testing::Not(HasSubstr("TKOFF_ALT"))));
  const auto autopilots = user_autopilots({program("arduplane")}, {});
  ASSERT_TRUE(autopilots);
  const auto folder = std::filesystem::path{testing::TempDir()} / "user_autopilots" / "fc-5";
  const auto command = autopilot_command(*autopilots, quadplane, 2, 5001, folder);
  ASSERT_TRUE(command) << command.error().message;
  EXPECT_THAT(*command, Contains("quadplane"));
  EXPECT_THAT(*command, Contains("31.50000000,105.00000000,480.00,50.0")) << "where it starts";
}

TEST(UserAutopilots, KeepTheFenceOfTheTeam) {
  configuration::VehicleConfig fenced = vehicle();
  fenced.fence.corners = {{-100.0, -100.0}, {500.0, -100.0}, {0.0, 500.0}};
  fenced.fence.height_max_m = 350.0;
  EXPECT_THAT(autopilot_parameters(fenced),
              HasSubstr("FENCE_ENABLE 1\nFENCE_ACTION 1\nFENCE_TYPE 5\nFENCE_ALT_MAX 350\n"));
  EXPECT_THAT(autopilot_parameters(vehicle()), testing::Not(HasSubstr("FENCE_")));
}

TEST(UserAutopilots, StartWhereTheVehicleDoesWithParametersOfItsAirframe) {
  const auto autopilots = user_autopilots({program("arduplane")}, {});
  ASSERT_TRUE(autopilots);
  const auto beside = autopilots->plane->parent_path() / "plane.parm";
  std::ofstream{beside} << "PTCH_TRIM_DEG 0\n";
  const auto folder = std::filesystem::path{testing::TempDir()} / "user_autopilots" / "fc-4";
  const auto command = autopilot_command(*autopilots, vehicle(), 2, 5001, folder);
  ASSERT_TRUE(command) << command.error().message;
  // 200 m behind its start, on the ground.
  EXPECT_THAT(*command, Contains("udpclient:127.0.0.1:5001"));
  EXPECT_THAT(*command, Contains("31.49884063,104.99838746,480.00,50.0"));
  EXPECT_THAT(*command, Contains(beside.string() + "," + (folder / "vehicle.parm").string()));
  EXPECT_TRUE(std::filesystem::exists(folder / "vehicle.parm"));
}

}  // namespace
}  // namespace skein::hil
