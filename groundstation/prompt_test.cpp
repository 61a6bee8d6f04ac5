// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/prompt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

template <class T>
T parsed(std::string_view line) {
  const auto input = parse_input(line);
  if (!input.ok()) {
    ADD_FAILURE() << line << ": " << input.error().message;
    return {};
  }
  const auto* wanted = std::get_if<T>(&*input);
  EXPECT_NE(wanted, nullptr) << line;
  return wanted == nullptr ? T{} : *wanted;
}

std::string refusal_of(std::string_view line) {
  const auto input = parse_input(line);
  EXPECT_FALSE(input.ok()) << line;
  return input.ok() ? std::string{} : input.error().message;
}

TEST(Prompt, UnderstandsEveryCommand) {
  EXPECT_EQ(parsed<View>("help"), View::help);
  EXPECT_EQ(parsed<View>(" status "), View::status);
  EXPECT_EQ(parsed<View>("sites\r"), View::sites);
  EXPECT_EQ(parsed<View>("pending"), View::pending);
  EXPECT_TRUE(parsed<Decision>("authorise 3").grant);
  EXPECT_EQ(parsed<Decision>("authorise   3").site, SiteId{3});
  EXPECT_FALSE(parsed<Decision>("refuse 3").grant);
  EXPECT_FALSE(parsed<Decision>("authorise 3").although_silent);
  EXPECT_TRUE(parsed<Decision>("authorise 3 override").although_silent);
  EXPECT_THAT(refusal_of("refuse 3 override"), HasSubstr("number of a site"));
  EXPECT_EQ(parsed<TakeBack>("withdraw decision 3").site, SiteId{3});
  EXPECT_EQ(parsed<Order>("hold 12").vehicle, VehicleId{12});
  EXPECT_EQ(parsed<Order>("hold 12").kind, mission::CommandKind::hold);
  EXPECT_EQ(parsed<Order>("resume all").vehicle, kGroundStation);
  EXPECT_EQ(parsed<Order>("resume all").kind, mission::CommandKind::resume);
  EXPECT_EQ(parsed<Order>("return 2").kind, mission::CommandKind::return_home);
  EXPECT_EQ(parsed<Order>("give-back 7").vehicle, VehicleId{7});
  EXPECT_EQ(parsed<Order>("land 7").kind, mission::CommandKind::land);
  EXPECT_EQ(parsed<Order>("land all").vehicle, kGroundStation);
  EXPECT_FALSE(is_of_formation("land 7"));
  EXPECT_TRUE(is_of_formation("land"));
  EXPECT_EQ(parsed<Order>("give-back 7").kind, mission::CommandKind::give_back);
  EXPECT_EQ(parsed<View>("preflight"), View::preflight);
  EXPECT_EQ(parsed<View>("preflight all"), View::preflight);
  EXPECT_EQ(parsed<PreflightOf>("preflight 12").vehicle, VehicleId{12});
  EXPECT_THAT(refusal_of("preflight zero"), HasSubstr("a vehicle's number"));
  EXPECT_THAT(refusal_of("preflight 1 2"), HasSubstr("a vehicle's number"));
  EXPECT_EQ(parsed<StatusOf>("status 12").vehicle, VehicleId{12});
  EXPECT_THAT(refusal_of("status all"), HasSubstr("a vehicle's number"));
  EXPECT_EQ(parsed<View>("links"), View::links);
  EXPECT_EQ(parsed<View>("wind"), View::wind);
  EXPECT_EQ(parsed<View>("traffic"), View::traffic);
  EXPECT_TRUE(parsed<ReturnPreview>("preview return all").vehicles.empty());
  EXPECT_EQ(parsed<ReturnPreview>("preview return 3-5").vehicles.size(), 3U);
  EXPECT_EQ(parsed<ReturnPreview>("preview return 3,12").vehicles,
            (std::vector{VehicleId{3}, VehicleId{12}}));
  for (const char* wrong : {"preview return", "preview return 3,", "preview return 3, 4",
                            "preview return ,3", "preview return 0"}) {
    EXPECT_THAT(refusal_of(wrong), HasSubstr("'preview return 3,5-9'"));
  }
  EXPECT_EQ(parsed<Record>("record runs/mine").folder, "runs/mine");
  EXPECT_EQ(parsed<Record>("record stop").folder, "");
  EXPECT_EQ(parsed<View>("command"), View::command);
  EXPECT_EQ(parsed<TakeCommand>("take command").reason, "");
  EXPECT_EQ(parsed<TakeCommand>(" take  command  the van  moves ").reason, "the van  moves");
  parsed<HandOver>("hand over");
  EXPECT_THAT(refusal_of("take"), HasSubstr("'take command'"));
  EXPECT_THAT(refusal_of("hand over now"), HasSubstr("stands alone"));
  parsed<Quit>("quit");
  parsed<std::monostate>("   ");
  parsed<std::monostate>("");
}

TEST(Prompt, SaysWhatIsWrongWithASite) {
  EXPECT_THAT(refusal_of("site"), HasSubstr("needs a place"));
  EXPECT_THAT(refusal_of("site 100"), HasSubstr("a place is EAST NORTH"));
  EXPECT_THAT(refusal_of("site 100 x"), HasSubstr("'EAST NORTH' needs a number"));
  EXPECT_THAT(refusal_of("site 99N 17E"), HasSubstr("no latitude and longitude"));
  EXPECT_THAT(refusal_of("site 59N 17"), HasSubstr("no latitude and longitude"));
  EXPECT_THAT(refusal_of("site 1 2 deliver"), HasSubstr("as in 'deliver 090,180'"));
  EXPECT_THAT(refusal_of("site 1 2 deliver 90,"), HasSubstr("needs a number from -360"));
  EXPECT_THAT(refusal_of("site 1 2 assess 17"), HasSubstr("from 0 to 16"));
  EXPECT_THAT(refusal_of("site 1 2 every"), HasSubstr("needs a number after it"));
  EXPECT_THAT(refusal_of("site 1 2 drop"), HasSubstr("is none of at PLACE"));
  EXPECT_THAT(refusal_of("site like fire"), HasSubstr("needs a place"));
  EXPECT_THAT(refusal_of("change site"), HasSubstr("number of a site"));
  EXPECT_THAT(refusal_of("withdraw 3"), HasSubstr("withdraw site 10034"));
  EXPECT_THAT(refusal_of("accept"), HasSubstr("number of a proposal"));
}

TEST(Prompt, SaysWhatIsWrong) {
  EXPECT_THAT(refusal_of("launch"), HasSubstr("no command 'launch'"));
  EXPECT_THAT(refusal_of("record"), HasSubstr("needs a folder, or 'stop'"));
  EXPECT_THAT(refusal_of("Authorise 3"), HasSubstr("no command 'Authorise'"));
  for (const auto* line : {"authorise", "authorise all", "authorise 3 4", "authorise -1",
                           "authorise 0", "authorise 3x", "authorise 70000"}) {
    EXPECT_THAT(refusal_of(line), HasSubstr("number of a site"));
  }
  for (const auto* line : {"hold", "hold 0", "hold 1 2", "hold everyone"}) {
    EXPECT_THAT(refusal_of(line), HasSubstr("number of a vehicle, several as"));
  }
  for (const auto* line : {"give-back", "give-back all", "give-back 0", "give-back 1 2"}) {
    EXPECT_THAT(refusal_of(line), HasSubstr("number of one vehicle"));
  }
  for (const auto* line :
       {"acknowledge", "acknowledge 0", "acknowledge 2.5", "acknowledge 3 all"}) {
    EXPECT_THAT(refusal_of(line), HasSubstr("numbers of alarms or 'all'"));
  }
  EXPECT_THAT(refusal_of("hazards 3"), HasSubstr("stands alone"));
  EXPECT_THAT(refusal_of("quit now"), HasSubstr("stands alone"));
}

TEST(Prompt, HelpNamesEveryCommand) {
  for (const auto* word :
       {"status", "sites", "pending", "authorise", "refuse", "hold", "resume", "return",
        "give-back", "alarms", "acknowledge", "take command", "hand over", "quit"}) {
    EXPECT_THAT(help_text(), HasSubstr(word));
  }
}

TEST(Prompt, AHazardIsThreeNumbers) {
  const auto input = parse_input("hazard 1200 -300.5 250");
  ASSERT_TRUE(input.ok());
  const auto& hazard = std::get<NewHazard>(*input);
  EXPECT_EQ(hazard.centre_m, (Vec2{1200.0, -300.5}));
  EXPECT_EQ(hazard.radius_m, 250.0);
  for (const char* wrong : {"hazard", "hazard 1 2", "hazard 1 2 0", "hazard 1 2 3 4",
                            "hazard x 2 3", "hazard 1 2 nan"}) {
    EXPECT_FALSE(parse_input(wrong).ok()) << wrong;
  }
}

}  // namespace
}  // namespace skein::groundstation
