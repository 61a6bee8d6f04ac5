// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/survey_sensors.hpp"

#include <gtest/gtest.h>

namespace skein::hil {
namespace {

VehicleSpec vehicle(std::uint16_t id, bool surveys) {
  VehicleSpec v;
  v.id = VehicleId{id};
  v.sensor_radius_m = 300.0;
  if (surveys) v.capabilities.add(TaskKind::survey);
  return v;
}

TEST(SurveySensors, ASiteIsFoundOnceByTheFirstThatSeesIt) {
  Site site;
  site.id = SiteId{7};
  site.position = {1000.0, 0.0};
  SurveySensors sensors{{site}, {vehicle(3, true), vehicle(2, true), vehicle(1, false)}};

  // Vehicle 1 is over the site but has no sensor; 2 and 3 are just out of range.
  EXPECT_TRUE(
      sensors
          .update({{VehicleId{1}, {1000, 0}}, {VehicleId{2}, {699, 0}}, {VehicleId{3}, {699, 0}}})
          .empty());
  const auto found = sensors.update({{VehicleId{2}, {701, 0}}, {VehicleId{3}, {701, 0}}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].finder, VehicleId{2});
  EXPECT_EQ(found[0].site.id, SiteId{7});
  EXPECT_TRUE(sensors.update({{VehicleId{3}, {1000, 0}}}).empty());
  EXPECT_TRUE(sensors.hidden().empty());
}

}  // namespace
}  // namespace skein::hil
