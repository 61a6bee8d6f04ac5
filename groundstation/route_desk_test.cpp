// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/route_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "skein/configuration/routes_config.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

class RouteDeskTest : public ::testing::Test {
 protected:
  RouteDeskTest() {
    mission::Telemetry t;
    t.vehicle = {2};
    t.instance = {1};
    t.range_left_m = 20'000.0;
    node_.on_message(mission::Message{t}, {2}, now_);
    configuration::RoutePlan plan;
    plan.title = "one";
    plan.site = {1000.0, 1000.0};
    plan.routes.push_back({{2}, {{{0.0, 0.0}, {1000.0, 0.0}, {1000.0, 1000.0}}, 50.0, 20.0}});
    plan.routes[0].arrival_s = 98.0;
    plan.routes[0].length_m = 1960.0;
    plan.routes[0].bound_m = 1414.0;
    plan.arrival_s = plan.bound_s = 98.0;
    std::ofstream{file_} << to_yaml(plan);
  }
  void TearDown() override { std::filesystem::remove(file_); }
  Answer order(const std::string& line) {
    const auto input = parse_input(line);
    EXPECT_TRUE(input.ok()) << line << ": " << (input ? "" : input.error().message);
    if (const auto* routes = std::get_if<RoutesFromFile>(&*input)) {
      return desk_.answer(*routes, now_);
    }
    return desk_.answer(std::get<CallOffRoutes>(*input), now_);
  }

  Instant now_ = at_seconds(10.0);
  std::string file_ = std::filesystem::temp_directory_path() / "skein-route-desk-test.yaml";
  mission::GroundNode node_{[] {
                              mission::GroundNodeConfig config;
                              config.agent.expected = {{2}, {3}};
                              return config;
                            }(),
                            Instant{}};
  RouteDesk desk_{node_};
};

TEST_F(RouteDeskTest, GivesThemShowsThemAndCallsThemOff) {
  EXPECT_EQ(desk_.status_text(now_), "");
  EXPECT_THAT(desk_.text(now_), HasSubstr("no routes"));
  EXPECT_FALSE(order("withdraw routes").done);
  const Answer preview = order("preview routes " + file_ + " in 60");
  EXPECT_TRUE(preview.done) << preview.text;
  EXPECT_THAT(preview.text, HasSubstr("begins at 70.0 s, 0 east 0 north, ends at 168"));
  EXPECT_FALSE(node_.routes().given()) << "it was a preview";
  const Answer given = order("routes " + file_ + " in 60");
  EXPECT_TRUE(given.done) << given.text;
  EXPECT_THAT(given.text, HasSubstr("plan 10001 is offered to 1 vehicles"));
  EXPECT_THAT(desk_.status_text(now_), HasSubstr("plan 10001, offered: begins in 60 s"));
  EXPECT_THAT(desk_.status_text(now_), HasSubstr("2  has not answered"));
  node_.on_message(
      mission::Message{mission::RouteStatus{
          {2}, {1}, 10'001, mission::RouteState::refused, mission::RouteObstacle::too_tight}},
      {2}, now_);
  EXPECT_THAT(desk_.text(now_), HasSubstr("2  refused: its arcs are tighter"));
  node_.on_timeout(now_);
  EXPECT_THAT(desk_.text(now_), HasSubstr("called off"));
}

TEST_F(RouteDeskTest, SaysWhatIsWrong) {
  EXPECT_THAT(order("routes /nowhere.yaml").text, HasSubstr("nowhere.yaml"));
  EXPECT_THAT(order("routes " + file_).text, HasSubstr("begins too soon"));
  now_ = at_seconds(-20.0);
  EXPECT_TRUE(order("preview routes " + file_).done) << "from mission time 0";
  for (const auto* line :
       {"routes a b", "routes a in", "routes a in 2", "preview routes", "routes a in 60 70"}) {
    EXPECT_FALSE(parse_input(line).ok()) << line;
  }
  EXPECT_TRUE(std::holds_alternative<View>(*parse_input("routes")));
  EXPECT_EQ(line_of(*parse_input("preview  routes a.yaml in 60")), "preview routes a.yaml in 60");
  EXPECT_EQ(line_of(*parse_input("withdraw routes")), "withdraw routes");
}

}  // namespace
}  // namespace skein::groundstation
