// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/area_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "search_words.hpp"
#include "skein/base/random.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class AreaDeskTest : public ::testing::Test {
 protected:
  AreaDeskTest() {
    for (const VehicleId id : {VehicleId{1}, VehicleId{2}}) {
      mission::Telemetry t;
      t.vehicle = id;
      t.instance = {id.value};
      t.state.x_m = 300.0 * id.value;
      t.state.groundspeed_mps = 20.0;
      t.range_left_m = 40'000.0;
      node_.on_message(mission::Message{t}, id, now_);
    }
  }
  Answer order(const std::string& line) {
    const auto input = parse_input(line);
    EXPECT_TRUE(input.ok()) << line << ": " << (input ? "" : input.error().message);
    if (const auto* search = std::get_if<SearchArea>(&*input)) return desk_.answer(*search, now_);
    return desk_.answer(std::get<NewHazard>(*input), now_);
  }

  Instant now_ = at_seconds(10.0);
  mission::GroundNode node_{[] {
                              mission::GroundNodeConfig config;
                              config.agent.expected = {{1}, {2}};
                              for (const VehicleId id : {VehicleId{1}, VehicleId{2}}) {
                                VehicleSpec spec;
                                spec.id = id;
                                spec.cruise_speed_mps = 20.0;
                                spec.turn_radius_m = 50.0;
                                spec.sensor_radius_m = 100.0;
                                config.searches.vehicles.push_back(spec);
                              }
                              return config;
                            }(),
                            Instant{}};
  AreaDesk desk_{node_, 0};
};

TEST_F(AreaDeskTest, PreviewsAndGivesASearch) {
  EXPECT_THAT(desk_.text(now_), HasSubstr("no area is searched"));
  const Answer preview = order("preview search 0,200 1000,200 1000,1000 0,1000 by 1,2");
  EXPECT_TRUE(preview.done) << preview.text;
  EXPECT_THAT(preview.text, HasSubstr("80.0 ha in lanes 180 m apart, by 2 vehicles"));
  EXPECT_THAT(preview.text, HasSubstr("100.0 % of it"));
  const auto data = codec::parse_json(preview.data);
  EXPECT_EQ(data["kind"], "search");
  EXPECT_EQ(data["shares"].size(), 2U);
  EXPECT_GT(data["shares"][0]["points"].size(), 4U);
  EXPECT_FALSE(node_.routes().given()) << "it was a preview";
  const Answer given = order("search 0,200 1000,200 1000,1000 0,1000 in 40");
  EXPECT_TRUE(given.done) << given.text;
  EXPECT_THAT(given.text, HasSubstr("begins in 40 s"));
  EXPECT_THAT(desk_.text(now_),
              HasSubstr("0.0 of 80.0 ha searched (0 %), 100 % when all is flown"));
  EXPECT_TRUE(node_.routes().given());
  const auto shown = codec::parse_json(desk_.json(now_));
  EXPECT_EQ(shown["search"]["state"], "flown");
  EXPECT_FALSE(order("search rest").done) << "routes stand";
}

TEST_F(AreaDeskTest, TellsHowFarItIsWhoHasWhatLeftAndWhenItIsDone) {
  ASSERT_TRUE(order("search 0,200 1000,200 1000,1000 0,1000 in 40").done);
  const std::string text = desk_.text(now_);
  EXPECT_THAT(text, HasSubstr("the area is being searched: "));
  EXPECT_THAT(text, ContainsRegex("expected to be done in [0-9]+ min [0-9]+ s, at [0-9.]+ s \\("));
  EXPECT_THAT(text,
              ContainsRegex("1  flies: [0-9]+ lanes with [0-9.]+ km of [0-9]+ left, done in"));
  const auto search = codec::parse_json(desk_.json(now_))["search"];
  EXPECT_EQ(search["area_m2"], 800'000.0);
  EXPECT_GT(search["expected_s"], 50.0);
  EXPECT_GT(search["shares"][0]["left_m"], 1000.0);
  EXPECT_GT(search["shares"][0]["done_s"], 50.0);
  EXPECT_FALSE(desk_.ended());
}

TEST_F(AreaDeskTest, SaysWhoseSearchAnOrderEndsBeforeItIsGivenAndThatItEnded) {
  const auto ends = [&](const std::string& line) {
    return ends_search_text(node_.searches(), *parse_input(line));
  };
  EXPECT_EQ(ends("hold all"), "");
  ASSERT_TRUE(order("search 0,200 1000,200 1000,1000 0,1000 in 40").done);
  EXPECT_THAT(ends("hold all"), HasSubstr("ends the search of vehicles 1,2: 0.0 of 80.0 ha"));
  EXPECT_THAT(ends("return 2"), HasSubstr("ends the search of vehicle 2: "));
  EXPECT_THAT(ends("preview return all"), HasSubstr("ends the search of vehicles 1,2: "));
  EXPECT_EQ(ends("resume all"), "");
  EXPECT_EQ(ends("hold 9"), "");
  // Where both have their lanes, and where nobody is.
  EXPECT_THAT(order("preview hazard 500 600 450").text, HasSubstr("ends the search of vehicle"));
  EXPECT_EQ(order("preview hazard 9000 9000 50").text, "a circle\n");
  EXPECT_THAT(order("hazard polygon 0,200 1000,200 1000,1000 0,1000").text,
              HasSubstr("ends the search of vehicles 1,2: "));
  ASSERT_TRUE(node_.call_off_routes(now_).ok());
  node_.on_timeout(now_);
  now_ += AreaDesk::kJsonPeriod;
  (void)desk_.json(now_);
  ASSERT_TRUE(desk_.ended());
  EXPECT_TRUE(desk_.ended()->is_wanted);
  EXPECT_THAT(desk_.ended()->what, HasSubstr("search called off: 0.0 of 80.0 ha searched"));
}

TEST_F(AreaDeskTest, APolygonIsOneHazardThatIsChangedAndWithdrawn) {
  const Answer preview = order("preview hazard polygon 0,0 400,0 400,200 0,200");
  EXPECT_THAT(preview.text, HasSubstr("circles hold the polygon"));
  EXPECT_TRUE(node_.hazards().known().empty());
  const Answer given = order("hazard polygon 0,0 400,0 400,200 0,200");
  EXPECT_THAT(given.text, HasSubstr("hazard 10010 is told to all; "));
  const std::size_t circles = node_.hazards().known().size();
  EXPECT_GE(circles, 2U);
  EXPECT_TRUE(order("change hazard 10010 600 0 50").done);
  EXPECT_EQ(node_.hazards().known().size(), circles + 1) << "the old one stands yet";
  now_ += mission::GroundHazards::kChangeWithin;
  node_.on_timeout(now_);
  EXPECT_EQ(node_.hazards().known().size(), 1U);
  const auto shown = codec::parse_json(desk_.json(now_));
  EXPECT_EQ(shown["hazards"][0]["hazard"], 10'010);
  EXPECT_EQ(shown["hazards"][0]["radius_m"], 50.0);
  const Answer again = order("hazard polygon 0,0 400,0 400,200 0,200");
  EXPECT_TRUE(again.done);
  const auto& group = *node_.hazards().groups().rbegin();
  EXPECT_THAT(desk_.hazards_text(),
              HasSubstr("hazard " + std::to_string(group.first.value) +
                        ": polygon of 4 corners, the first 0 m east, 0 m north of the origin; "));
  EXPECT_THAT(desk_.hazards_text(),
              HasSubstr("hazard 10010: radius 50 m around 600 m east, 0 m north of the origin\n"));
  EXPECT_EQ(std::ranges::count(desk_.hazards_text(), '\n'), 2) << "a polygon is one hazard";
  const Answer gone = desk_.answer(WithdrawHazard{group.second.circles.back()}, now_);
  EXPECT_THAT(gone.text, HasSubstr(" is withdrawn with all of its "));
  EXPECT_THAT(desk_.answer(WithdrawHazard{{10'010}}, now_).text,
              HasSubstr("hazard 10010 is withdrawn\n"));
  EXPECT_FALSE(desk_.answer(WithdrawHazard{{10'010}}, now_).done);
  EXPECT_TRUE(node_.hazards().known().empty());
  EXPECT_FALSE(order("change hazard 10010 600 0 50").done);
}

TEST(AreaWords, AreReadAndWrittenTheSame) {
  for (const std::string line :
       {"search 0,0 10.5,-3 7,8", "preview search 0,0 10,0 7,8 by 1,2 spacing 150 in 30",
        "search rest by 4", "hazard polygon 0,0 10,0 7,8", "hazard 1 2 3",
        "change hazard 10010 polygon 0,0 10,0 7,8", "preview change hazard 7 1 2 3"}) {
    const auto input = parse_input(line);
    ASSERT_TRUE(input.ok()) << line << ": " << input.error().message;
    EXPECT_EQ(line_of(*input), line);
  }
  EXPECT_TRUE(std::holds_alternative<View>(*parse_input("search")));
  for (const auto* line :
       {"search 0,0", "search 0,0 10,10 10,0 0,10", "search a,b c,d e,f", "search 0,0 10,0 7,8 by",
        "search 0,0 10,0 7,8 by x", "search 0,0 10,0 7,8 spacing 0", "search 0,0 10,0 7,8 in 1",
        "search 0,0 10,0 7,8 fast", "preview search", "search 1e9,0 10,0 7,8", "hazard polygon",
        "hazard polygon 0,0 1,1", "hazard polygon 0,0 10,0 7,8 9", "change hazard",
        "change hazard x 1 2 3", "change hazard 7"}) {
    EXPECT_FALSE(parse_input(line).ok()) << line;
  }
}

TEST(AreaOrders, OfAPage) {
  const auto search = read_order(
      R"({"kind":"search","preview":true,"corners":[[0,0],[10,0],[7,8]],"vehicles":[1,2],"in_s":30})");
  ASSERT_TRUE(search.ok()) << search.error().message;
  EXPECT_EQ(line_of(*search), "preview search 0,0 10,0 7,8 by 1,2 in 30");
  EXPECT_EQ(line_of(*read_order(R"({"kind":"search","preview":false,"rest":true})")),
            "search rest");
  EXPECT_EQ(line_of(*read_order(R"({"kind":"hazard","corners":[[0,0],[10,0],[7,8]],"hazard":9})")),
            "change hazard 9 polygon 0,0 10,0 7,8");
  EXPECT_EQ(line_of(*read_order(R"({"kind":"withdraw","routes":true})")), "withdraw routes");
  for (const auto* text :
       {R"({"kind":"search"})", R"({"kind":"search","preview":false})",
        R"({"kind":"search","preview":true,"corners":[[0,0],[10,0]]})",
        R"({"kind":"search","preview":true,"corners":[[0,0],[10,10],[10,0],[0,10]]})",
        R"({"kind":"search","preview":true,"corners":[[0,0],[10,"x"],[7,8]]})",
        R"({"kind":"search","preview":true,"corners":[[0,0,0],[10,0,0],[7,8,0]]})",
        R"({"kind":"search","preview":true,"corners":[[0,0],[1e300,0],[7,8]]})",
        R"({"kind":"search","preview":true,"corners":{"a":1}})",
        R"({"kind":"search","preview":true,"corners":[[0,0],[10,0],[7,8]],"vehicles":[0]})",
        R"({"kind":"search","preview":true,"rest":1})", R"({"kind":"hazard","corners":[]})",
        R"({"kind":"hazard","corners":[[0,0],[10,0],[7,8]],"hazard":0})"}) {
    EXPECT_FALSE(read_order(text).ok()) << text;
  }
}

/// Whatever is sent is read or refused.
TEST(AreaOrders, AnyTextIsSafe) {
  Random random{5};
  const std::string seed =
      R"({"kind":"search","preview":true,"corners":[[0,0],[10,0],[7,8]],"vehicles":[1,2]})";
  for (int i = 0; i < 5000; ++i) {
    std::string text = seed;
    for (int k = 0; k < 4; ++k) {
      text[random.index(text.size())] = static_cast<char>(32 + random.index(95));
    }
    (void)read_order(text).ok();
    (void)parse_input("search " + text).ok();
  }
}

}  // namespace
}  // namespace skein::groundstation
