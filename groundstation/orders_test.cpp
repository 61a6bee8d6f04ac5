// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/orders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "skein/console/sections.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

std::string line_of_json(const char* json) {
  const auto order = read_order(json);
  EXPECT_TRUE(order.ok()) << (order ? "" : order.error().message);
  return order ? line_of(*order) : "";
}
std::string trouble_with(const char* json) {
  const auto order = read_order(json);
  EXPECT_FALSE(order.ok()) << json;
  return order ? "" : order.error().message;
}

constexpr const char* kLongSite =
    "site 1 2 deliver 090 simultaneous assess 2 wait 3 dwell 8 survey 5 reward 3 decay 0.1";

TEST(Orders, WhatIsTypedComesBackAsItsLine) {
  for (const char* line : {"hold all",
                           "resume 7",
                           "return 3",
                           "give-back 2",
                           "hold 3,4,7",
                           "return 1-3,7,9-12",
                           "land 2,5",
                           "authorise 3",
                           "authorise 3 override",
                           "refuse 4",
                           "withdraw decision 3",
                           "hazard 1200 -300 250",
                           "site 1200 -300",
                           "site 59.1234N 17.5W deliver 090,180 every 4 by 3",
                           "site like fire at 10 20.5 deliver none anyway",
                           kLongSite,
                           "preview site 1 2",
                           "change site 10034 at 5 6",
                           "preview change site 10034 reward 5",
                           "sites fires.yaml",
                           "withdraw site 10034",
                           "withdraw hazard 10034",
                           "accept 1",
                           "dismiss 2",
                           "acknowledge all",
                           "acknowledge 3 14",
                           "alarms",
                           "proposals",
                           "take-off",
                           "rally",
                           "land",
                           "preview land",
                           "wait 10",
                           "record stop",
                           "record runs/mine",
                           "command",
                           "take command",
                           "take command the van moves",
                           "hand over",
                           "quit",
                           "status",
                           "pending",
                           "form wedge",
                           "form line-abreast spacing 5 heading 090 at 0 40.5 20 places 3",
                           "fly-along lap in wedge",
                           "preview fly-along lap in column spacing 45 speed 18.5 laps 2",
                           "fly-along tracks/lap.yaml in heart spacing 60",
                           "form my-shape"}) {
    const auto input = parse_input(line);
    ASSERT_TRUE(input.ok()) << line;
    EXPECT_EQ(line_of(*input), line);
  }
}

TEST(Orders, ToSeveralAreOneWhateverTheirOrder) {
  EXPECT_EQ(line_of_json(R"({"kind":"commands","command":"hold","vehicles":[7,3,4,3]})"),
            "hold 3,4,7");
  EXPECT_EQ(line_of_json(R"({"kind":"commands","command":"return_home","vehicles":[1,2,3]})"),
            "return 1-3");
  EXPECT_THAT(trouble_with(R"({"kind":"commands","command":"hold","vehicles":[]})"),
              HasSubstr("at least one"));
  EXPECT_THAT(trouble_with(R"({"kind":"commands","command":"hold"})"), HasSubstr("vehicles"));
  // 0 is everybody, of whom nobody spoke.
  EXPECT_THAT(trouble_with(R"({"kind":"commands","command":"hold","vehicles":[0,3]})"),
              HasSubstr("vehicles"));
  EXPECT_THAT(trouble_with(R"({"kind":"commands","command":"hold","vehicles":[1.5]})"),
              HasSubstr("whole"));
  EXPECT_THAT(trouble_with(R"({"kind":"commands","command":"give_back","vehicles":[1]})"),
              HasSubstr("one vehicle"));
  for (const char* line : {"hold 3,,4", "hold 3,", "hold 7-3", "hold 3-", "hold 0,1", "hold 3,all",
                           "hold 1-60000", "hold 3, 4", "give-back 1,2"}) {
    EXPECT_FALSE(parse_input(line).ok()) << line;
  }
  EXPECT_EQ(line_of(*parse_input("hold 9,3-5,4")), "hold 3-5,9");
}

TEST(Orders, OfAPageAreReadFieldByField) {
  EXPECT_EQ(line_of_json(R"({"kind":"command","command":"hold","vehicle":0})"), "hold all");
  EXPECT_EQ(line_of_json(R"({"kind":"command","command":"return_home","vehicle":7})"), "return 7");
  EXPECT_EQ(line_of_json(R"({"kind":"hazard","x":1200,"y":-300,"radius_m":250})"),
            "hazard 1200 -300 250");
  EXPECT_EQ(line_of_json(R"({"kind":"site","preview":false,"x":10,"y":20,"like":"fire",
                             "bearings_deg":[90,180],"interval_s":4,"assessments":2,"wait_s":3,
                             "dwell_s":8,"survey_s":5,"reward":3,"vehicle":7})"),
            "site like fire at 10 20 deliver 090,180 every 4 assess 2 wait 3 dwell 8 survey 5 "
            "reward 3 by 7");
  EXPECT_EQ(line_of_json(R"({"kind":"site","preview":true,"site":10034,"reward":3})"),
            "preview change site 10034 reward 3");
  EXPECT_EQ(line_of_json(R"({"kind":"withdraw","site":10034})"), "withdraw site 10034");
  EXPECT_EQ(line_of_json(R"({"kind":"acknowledge","alarms":[3,14]})"), "acknowledge 3 14");
  EXPECT_EQ(line_of_json(R"({"kind":"withdraw","hazard":10034})"), "withdraw hazard 10034");
  EXPECT_EQ(line_of_json(R"({"kind":"withdraw","decision":3})"), "withdraw decision 3");
  EXPECT_EQ(
      line_of_json(R"({"kind":"decision","site":3,"grant":true,"coalition":"1-1-1","round":2,)"
                   R"("override":true})"),
      "authorise 3 override");
  EXPECT_EQ(line_of_json(R"({"kind":"proposal","number":3,"accept":true})"), "accept 3");
  EXPECT_THAT(trouble_with(R"({"kind":"site","preview":false,"x":1,"y":2,"bearings_deg":[900]})"),
              HasSubstr("bearings_deg is to be a list"));
  EXPECT_THAT(trouble_with(R"({"kind":"site","preview":false})"), HasSubstr("x is to be"));
  EXPECT_EQ(line_of_json(R"({"kind":"formation","preview":true,"order":"take_off"})"),
            "preview take-off");
  EXPECT_EQ(line_of_json(R"({"kind":"formation","preview":false,"order":"form","shape":"echelon",
                             "spacing_m":5,"heading_deg":90,"x":0,"y":40.5,"z":20,"places":3})"),
            "form echelon spacing 5 heading 090 at 0 40.5 20 places 3");
  EXPECT_EQ(line_of_json(R"({"kind":"formation","preview":false,"order":"fly_along","track":"lap",
                             "shape":"wedge","spacing_m":45,"speed_mps":20,"laps":2})"),
            "fly-along lap in wedge spacing 45 speed 20 laps 2");
}

TEST(Orders, OfAPageTakeTheCommandAndHandItOver) {
  EXPECT_EQ(line_of_json(R"({"kind":"take_command","reason":"van\nmoves"})"),
            "take command van moves");
  EXPECT_EQ(line_of_json(R"({"kind":"take_command","reason":""})"), "take command");
  EXPECT_EQ(line_of_json(R"({"kind":"hand_over"})"), "hand over");
  EXPECT_THAT(trouble_with(R"({"kind":"take_command"})"), HasSubstr("reason"));
}

TEST(Orders, AlongATrackNeedATrackAndAShape) {
  for (const char* line : {"fly-along", "fly-along lap", "fly-along lap wedge", "fly-along lap in",
                           "fly-along lap in wedge speed", "fly-along lap in wedge speed 0",
                           "fly-along lap in wedge laps 0", "fly-along lap in wedge heading 90",
                           "form wedge speed 20"}) {
    EXPECT_FALSE(parse_input(line).ok()) << line;
  }
}

TEST(Orders, ADecisionOfAPageIsOnThePlanThatItShows) {
  const coalition::CoalitionId id{{27}, {0xFFFFFFFFFFFFFFFFULL}, 3};
  const std::string json = R"({"kind":"decision","site":3,"grant":true,"coalition":")" +
                           console::key_of(id) + R"(","round":4})";
  const auto order = read_order(json);
  ASSERT_TRUE(order.ok());
  const auto& decision = std::get<Decision>(*order);
  EXPECT_EQ(decision.site, SiteId{3});
  EXPECT_TRUE(decision.grant);
  EXPECT_EQ(decision.plan, (coalition::Round{id, 4}));
  EXPECT_FALSE(std::get<Decision>(*parse_input("authorise 3")).plan);
}

TEST(Orders, AnAcknowledgementNamesAlarms) {
  for (const char* json :
       {R"({"kind":"acknowledge"})", R"({"kind":"acknowledge","alarms":[]})",
        R"({"kind":"acknowledge","alarms":[0]})", R"({"kind":"acknowledge","alarms":"all"})"}) {
    EXPECT_THAT(trouble_with(json), HasSubstr("alarms is to"));
  }
}

TEST(Orders, WhatIsWrongIsNamed) {
  EXPECT_THAT(trouble_with("x"), HasSubstr("JSON object"));
  EXPECT_THAT(trouble_with("{}"), HasSubstr("kind"));
  EXPECT_THAT(trouble_with(R"({"kind":"quit"})"), HasSubstr("no order 'quit'"));
  EXPECT_THAT(trouble_with(R"({"kind":"command","command":"fall","vehicle":1})"),
              HasSubstr("no command 'fall'"));
  EXPECT_THAT(trouble_with(R"({"kind":"command","command":"hold","vehicle":-1})"),
              HasSubstr("vehicle"));
  EXPECT_THAT(trouble_with(R"({"kind":"command","command":"hold"})"), HasSubstr("vehicle"));
  EXPECT_THAT(trouble_with(R"({"kind":"hazard","x":1,"y":2,"radius_m":0.5})"),
              HasSubstr("from 1 to 50000"));
  EXPECT_THAT(trouble_with(R"({"kind":"hazard","x":1,"y":"2","radius_m":5})"), HasSubstr("y is"));
  EXPECT_THAT(
      trouble_with(R"({"kind":"decision","site":3,"grant":true,"coalition":"1-x-2","round":4})"),
      HasSubstr("key"));
}

}  // namespace
}  // namespace skein::groundstation
