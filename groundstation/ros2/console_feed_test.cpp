// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/console_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "skein/ros2/cdr.hpp"

namespace skein::ros2 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string hello(const char* role = "observer", const char* run = "a") {
  return std::string{R"({"type":"hello","role":")"} + role + R"(","run":")" + run +
         R"(","epoch_unix_s":1700000000,"origin":{"latitude_deg":47,"longitude_deg":8,"height_m":500}})";
}

std::vector<std::string> topics(const Result<ConsoleFeed::Heard>& heard) {
  std::vector<std::string> all;
  for (const auto& one : heard->publications) all.push_back(one.topic);
  return all;
}

struct Feed : testing::Test {
  Feed() { EXPECT_TRUE(feed.on_text(hello())); }
  ConsoleFeed feed;
};

constexpr const char* kVehicle =
    R"({"type":"state","time_s":10,"vehicles":[{"id":3,"silent":false,"measured_s":9.25,"x":100,"y":-200,"z":60,
        "heading_deg":90.5,"course_deg":91,"groundspeed":20.25,"airspeed":19,"activity":"searching",
        "state":"searching","range_left_m":5000,"loads":1,"mode":null,
        "problems":[{"level":"warning","text":"its clock is off"}]},
       {"id":4,"measured_s":null,"x":null}]})";

TEST(Hello, AnswersFromWhereEventsAreWanted) {
  ConsoleFeed feed;
  const auto heard = feed.on_text(hello());
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->answer, R"({"type":"resume","next_seq":0})");
  EXPECT_THAT(topics(heard), ElementsAre("origin"));
  const auto origin = from_cdr<sensor_msgs::NavSatFix>(heard->publications[0].bytes);
  EXPECT_EQ(origin->latitude, 47.0);
  EXPECT_EQ(heard->publications[0].quality, Quality::state);
}

TEST(Hello, AnOperatorsRightsAreNotWanted) {
  ConsoleFeed feed;
  const auto heard = feed.on_text(hello("operator"));
  ASSERT_FALSE(heard);
  EXPECT_THAT(heard.error().message, HasSubstr("observer"));
}

TEST(Hello, ComesFirstAndHasAnOrigin) {
  ConsoleFeed feed;
  EXPECT_FALSE(feed.on_text(kVehicle));
  EXPECT_FALSE(feed.on_text(R"({"type":"hello","role":"observer"})"));
  EXPECT_FALSE(feed.on_text("[1"));
  EXPECT_FALSE(feed.on_text("7"));
}

TEST_F(Feed, AVehicleIsAFixAndAStatus) {
  const auto heard = feed.on_text(kVehicle);
  ASSERT_TRUE(heard);
  ASSERT_THAT(topics(heard), ElementsAre("vehicle_3/status", "vehicle_3/fix"));
  const auto status = from_cdr<skein_msgs::VehicleStatus>(heard->publications[0].bytes);
  EXPECT_EQ(status->id, 3);
  EXPECT_EQ(status->header.stamp.sec, 1'700'000'009);
  EXPECT_EQ(status->header.stamp.nanosec, 250'000'000U);
  EXPECT_EQ(status->header.frame_id, ConsoleFeed::kFrame);
  EXPECT_EQ(status->position.y, -200.0);
  EXPECT_EQ(status->heading_deg, 90.5F);
  EXPECT_THAT(status->problems, ElementsAre("its clock is off"));
  const auto fix = from_cdr<sensor_msgs::NavSatFix>(heard->publications[1].bytes);
  const Wgs84 place = MissionOrigin::make({47, 8, 500})->to_wgs84({100, -200, 60});
  EXPECT_EQ(fix->latitude, place.latitude_deg);
  EXPECT_EQ(fix->altitude, place.height_m);
  EXPECT_EQ(fix->header.frame_id, "vehicle_3");
  EXPECT_EQ(heard->publications[1].quality, Quality::sensor);
  EXPECT_THAT(topics(feed.on_text(kVehicle)), IsEmpty()) << "nothing of it is new";
}

TEST_F(Feed, AVehicleThatFallsSilentHasNoNewFix) {
  (void)feed.on_text(kVehicle);
  std::string silent = kVehicle;
  silent.replace(silent.find("false"), 5, "true");
  const auto heard = feed.on_text(silent);
  ASSERT_THAT(topics(heard), ElementsAre("vehicle_3/status"));
  EXPECT_TRUE(from_cdr<skein_msgs::VehicleStatus>(heard->publications[0].bytes)->silent);
}

TEST_F(Feed, SitesAndHazardsAreSaidWhenTheyChange) {
  const std::string sites =
      R"("sites":[{"id":7,"x":10,"y":20,"leader":2,"status":"surveyed","news":"n","tasks":[
         {"kind":"deliver","index":1,"vehicle":null,"state":"open"}]},{"id":8,"x":null,"y":null,"status":"found"}])";
  const std::string hazards = R"("hazards":[{"id":1,"x":5,"y":6,"radius_m":120}])";
  const auto heard = feed.on_text(R"({"type":"state","time_s":1,)" + sites + "," + hazards + "}");
  ASSERT_THAT(topics(heard), ElementsAre("sites", "hazards"));
  const auto said = from_cdr<skein_msgs::Sites>(heard->publications[0].bytes);
  ASSERT_EQ(said->sites.size(), 2U);
  EXPECT_EQ(said->sites[0].leader, 2);
  EXPECT_EQ(said->sites[0].tasks[0].kind, "deliver");
  EXPECT_EQ(said->sites[0].tasks[0].vehicle, 0);
  EXPECT_FALSE(said->sites[1].has_place);
  EXPECT_TRUE(std::isnan(said->sites[1].latitude));
  EXPECT_EQ(from_cdr<skein_msgs::Hazards>(heard->publications[1].bytes)->hazards[0].radius, 120.0);
  // As after a new connection: all sections, and nothing is new.
  EXPECT_THAT(topics(feed.on_text(R"({"type":"state","time_s":2,)" + sites + "," + hazards + "}")),
              IsEmpty());
  EXPECT_THAT(topics(feed.on_text(R"({"type":"state","time_s":3,"sites":[]})")),
              ElementsAre("sites"));
}

TEST_F(Feed, APlanIsAPathOnce) {
  const char* const plan =
      R"({"type":"state","time_s":1,"plans":[{"id":3,"number":2,"start_s":5,"points":[[0,0,5],[0,100,9],["x"]],"hold":[]}]})";
  const auto heard = feed.on_text(plan);
  ASSERT_THAT(topics(heard), ElementsAre("vehicle_3/plan"));
  const auto path = from_cdr<nav_msgs::Path>(heard->publications[0].bytes);
  ASSERT_EQ(path->poses.size(), 2U);
  EXPECT_EQ(path->poses[1].header.stamp.sec, 1'700'000'009);
  EXPECT_NEAR(path->poses[0].pose.orientation.z, std::sqrt(0.5), 1e-9) << "to the north";
  EXPECT_THAT(topics(feed.on_text(plan)), IsEmpty());
}

TEST_F(Feed, EventsAreSaidOnceUntilTheServerStartsAnew) {
  const char* const events =
      R"({"type":"events","events":[{"seq":0,"time_s":1,"vehicle":2,"kind":"site_detected","level":"warning",
          "site":7,"text":"vehicle 2: found"},{"seq":1,"time_s":2,"vehicle":0,"kind":"k","level":"info","site":null}]})";
  const auto heard = feed.on_text(events);
  ASSERT_THAT(topics(heard), ElementsAre("events", "events"));
  const auto event = from_cdr<skein_msgs::Event>(heard->publications[0].bytes);
  EXPECT_EQ(event->level, skein_msgs::Event::WARNING);
  EXPECT_EQ(event->site, 7);
  EXPECT_EQ(heard->publications[0].quality, Quality::history);
  EXPECT_THAT(topics(feed.on_text(events)), IsEmpty());
  EXPECT_EQ(feed.on_text(hello())->answer, R"({"type":"resume","next_seq":2})");
  EXPECT_EQ(feed.on_text(hello("observer", "b"))->answer, R"({"type":"resume","next_seq":0})");
}

TEST_F(Feed, WhatIsWrongInItIsPassedOver) {
  EXPECT_TRUE(feed.on_text(
      R"({"type":"state","time_s":null,"vehicles":[1,null,{"id":-3,"measured_s":1},{"id":70000,"measured_s":1},
          {"id":5,"measured_s":1e300,"x":"y","problems":[4]}],"plans":{},"sites":[3],"hazards":[[]]})"));
  EXPECT_TRUE(feed.on_text(R"({"type":"events","events":[{"seq":-1},7]})"));
  EXPECT_TRUE(feed.on_text(R"({"type":"ended"})"));
}

}  // namespace
}  // namespace skein::ros2
