// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/marker_intake.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "skein/agencies/cot_event.hpp"

namespace skein::agencies {
namespace {

using ::testing::HasSubstr;

MissionOrigin origin() { return *MissionOrigin::make({59.0, 17.0, 0.0}); }

struct Words {
  std::string type = "b-m-p-s-m";
  std::string uid = "android-1";
  std::string callsign = "Smoke north";
  std::string remarks{};
  double latitude_deg = 59.01;
  bool ended = false;
};

std::string marker(const Words& words = {}) {
  CotEvent event;
  event.uid = words.uid;
  event.type = words.type;
  event.how = "h-g-i-g-o";
  event.time_unix_ns = 1'700'000'000'000'000'000;
  event.stale_unix_ns = event.time_unix_ns + (words.ended ? 0 : 1'000'000'000);
  event.place = {words.latitude_deg, 17.0, 0.0};
  event.callsign = words.callsign;
  event.remarks = words.remarks;
  return to_xml(event);
}

std::string trouble_with(const std::string& text) {
  const auto read = read_marker(text, origin());
  EXPECT_FALSE(read.ok()) << text;
  return read ? "" : read.error().message;
}

mission::Detection detection_of(const std::string& text) {
  const auto read = read_marker(text, origin());
  EXPECT_TRUE(read.ok()) << (read ? "" : read.error().message);
  EXPECT_TRUE(read && *read) << text;
  return read && *read ? (*read)->detection : mission::Detection{};
}

TEST(Marker, TellsOfAnIncidentByItsWords) {
  const auto smoke = detection_of(marker());
  EXPECT_EQ(smoke.kind, mission::IncidentKind::smoke);
  EXPECT_NEAR(smoke.position.y(), 1114.0, 5.0);
  EXPECT_NEAR(smoke.position.x(), 0.0, 0.01);
  EXPECT_EQ(smoke.detector, "marker 'Smoke north'");
  EXPECT_EQ(smoke.vehicle, VehicleId{});
  EXPECT_EQ(detection_of(marker({.callsign = "M.1", .remarks = "the river has a FLOOD"})).kind,
            mission::IncidentKind::flood);
  EXPECT_EQ(detection_of(marker({.callsign = "M.1"})).kind, mission::IncidentKind::damage);
  EXPECT_EQ(detection_of(marker({.type = "a-u-G", .callsign = "M.1"})).detector, "marker 'M.1'");
  EXPECT_EQ(detection_of(marker({.callsign = "\xC3\xA5\x07"})).detector,
            std::string{"marker '"} + "???" + "'")
      << "what every terminal takes";
  EXPECT_EQ(detection_of(marker({.callsign = std::string(500, 'x')})).detector.size(),
            std::string{"marker ''"}.size() + 60);
}

TEST(Marker, IsNoneWhereTheEventTellsOfSomethingElseOrIsEnded) {
  for (const char* type : {"a-f-G-U-C", "a-f-A-M-F-Q", "t-x-c-t", "u-d-c-c", "b-t-f"}) {
    const auto read = read_marker(marker({.type = type}), origin());
    ASSERT_TRUE(read.ok()) << type;
    EXPECT_FALSE(*read) << type;
  }
  const auto ended = read_marker(marker({.ended = true}), origin());
  ASSERT_TRUE(ended.ok());
  EXPECT_FALSE(*ended);
}

TEST(Marker, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(trouble_with(""), HasSubstr("no XML"));
  EXPECT_THAT(trouble_with("<event"), HasSubstr("no XML"));
  EXPECT_THAT(trouble_with("<events/>"), HasSubstr("no event"));
  EXPECT_THAT(trouble_with("<event version='1.0' uid='a' type='b-m-p-s-m'/>"),
              HasSubstr("version 2.0"));
  EXPECT_THAT(trouble_with("<event version='2.0' type='b-m-p-s-m'/>"), HasSubstr("uid"));
  EXPECT_THAT(trouble_with(marker({.uid = std::string(129, 'u')})), HasSubstr("128"));
  EXPECT_THAT(trouble_with("<event version='2.0' uid='a' type='b-m-p-s-m' time='now'/>"),
              HasSubstr("UTC"));
  EXPECT_THAT(trouble_with("<event version='2.0' uid='a' type='b-m-p-s-m' "
                           "time='2023-11-14T22:13:20Z' stale='2023-11-14T22:13:30Z'>"
                           "<point lat='nan' lon='17'/></event>"),
              HasSubstr("degrees"));
  EXPECT_THAT(trouble_with(marker({.latitude_deg = -33.0})), HasSubstr("100 km"));
  EXPECT_THAT(trouble_with(marker({.remarks = std::string(9000, 'r')})), HasSubstr("8192"));
}

TEST(Marker, HasNoEntitiesThatGrow) {
  const std::string growing =
      "<!DOCTYPE event [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;'>]>"
      "<event version='2.0' uid='a' type='b-m-p-s-m' time='2023-11-14T22:13:20Z' "
      "stale='2023-11-14T22:13:30Z'><point lat='59' lon='17'/>"
      "<detail><contact callsign='&b;'/></detail></event>";
  EXPECT_EQ(detection_of(growing).detector, "marker '&b;'");
}

TEST(MarkerIntake, TakesSoManyAtOnceAndThenSlowly) {
  MarkerIntake intake{origin(), "alpha-"};
  EXPECT_FALSE(intake.take(marker({.uid = "alpha-site-1-1"}), at_seconds(1.0))) << "our own";
  for (int i = 0; i < MarkerIntake::kBurst; ++i) {
    EXPECT_TRUE(intake.take(marker(), at_seconds(1.0)));
  }
  EXPECT_FALSE(intake.take(marker(), at_seconds(1.0)));
  EXPECT_EQ(intake.too_many(), 1U);
  EXPECT_TRUE(intake.take(marker(), at_seconds(3.0)));
  EXPECT_FALSE(intake.take(marker(), at_seconds(3.0)));
  EXPECT_EQ(intake.unreadable(), 0U);
  EXPECT_FALSE(intake.take("nonsense", at_seconds(4.0)));
  EXPECT_EQ(intake.unreadable(), 1U);
  EXPECT_TRUE(intake.poll_trouble());
  EXPECT_FALSE(intake.poll_trouble());
}

}  // namespace
}  // namespace skein::agencies
