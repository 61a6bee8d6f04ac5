// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/proposals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "skein/agencies/marker_intake.hpp"
#include "skein/ros2/cdr.hpp"

namespace skein::ros2 {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;

skein_msgs::SiteProposal proposal() {
  skein_msgs::SiteProposal made;
  made.latitude = 47.001;
  made.longitude = 8.002;
  made.kind = skein_msgs::SiteProposal::LANDSLIDE;
  made.name = "smoke & \"fire\" <ridge>\n";
  return made;
}
MissionOrigin origin() { return *MissionOrigin::make({47.0, 8.0, 500.0}); }

TEST(Proposals, AreMarkersThatTheGroundStationTakes) {
  const auto text = marker_of(proposal(), "ros2-x-1", kNow_ns);
  ASSERT_TRUE(text);
  const auto marker = agencies::read_marker(*text, origin());
  ASSERT_TRUE(marker);
  ASSERT_TRUE(*marker);
  EXPECT_EQ((*marker)->uid, "ros2-x-1");
  // Whatever kinds its name names.
  EXPECT_EQ((*marker)->detection.kind, mission::IncidentKind::landslide);
  const Wgs84 place = origin().to_wgs84(
      {(*marker)->detection.position.x(), (*marker)->detection.position.y(), 0.0});
  EXPECT_NEAR(place.latitude_deg, 47.001, 1e-7);
  EXPECT_NEAR(place.longitude_deg, 8.002, 1e-7);
  EXPECT_THAT((*marker)->detection.detector, HasSubstr("ROS 2"));
}

TEST(Proposals, WithoutAPlaceOnEarthOrAKindAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double latitude : {nan, 91.0, -90.1, std::numeric_limits<double>::infinity()}) {
    auto made = proposal();
    made.latitude = latitude;
    EXPECT_FALSE(marker_of(made, "u", kNow_ns)) << latitude;
  }
  auto made = proposal();
  made.longitude = 180.1;
  EXPECT_FALSE(marker_of(made, "u", kNow_ns));
  made = proposal();
  made.kind = 6;
  EXPECT_FALSE(marker_of(made, "u", kNow_ns));
}

TEST(Proposals, AFloodIsCutOff) {
  ProposalIntake intake{"run"};
  const auto bytes = to_cdr(proposal());
  int taken = 0;
  for (int i = 0; i < 1000; ++i) taken += intake.take(bytes, at_seconds(1.0), kNow_ns) ? 1 : 0;
  EXPECT_EQ(taken, ProposalIntake::kBurst);
  EXPECT_EQ(intake.too_many(), 1000U - ProposalIntake::kBurst);
  EXPECT_TRUE(intake.poll_trouble());
  EXPECT_FALSE(intake.poll_trouble());
  EXPECT_FALSE(intake.take(bytes, at_seconds(2.9), kNow_ns));
  EXPECT_TRUE(intake.take(bytes, at_seconds(3.1), kNow_ns));
}

TEST(Proposals, WhatIsNoneIsCounted) {
  ProposalIntake intake{"run"};
  EXPECT_FALSE(intake.take({}, {}, kNow_ns));
  auto long_one = proposal();
  long_one.name = std::string(2000, 'x');
  EXPECT_FALSE(intake.take(to_cdr(long_one), {}, kNow_ns));
  EXPECT_EQ(intake.unreadable(), 2U);
}

}  // namespace
}  // namespace skein::ros2
