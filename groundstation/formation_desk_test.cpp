// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/formation_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

TEST(FormationDesk, TheScriptSaysOnceWhyItWaitsThoughTheNumbersChange) {
  configuration::FormationConfig config;
  config.script = {"take-off"};
  mission::GroundNode node{{.agent = {}, .formation = formation_ground(config, {{1}, {2}})},
                           Instant{}};
  auto desk = FormationDesk::open(config, {{1}, {2}}, node);
  ASSERT_TRUE(desk.ok()) << desk.error().message;
  std::vector<mission::MissionEvent> warnings;
  for (int i = 1; i <= 30; ++i) {
    const Instant now = at_seconds(0.5 * i);
    for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
      mission::FormationStatus status;
      status.vehicle = {id};
      status.reference_m.x() = id == 1 ? 0.0 : 1.0 + 0.01 * i;  // gusts move it, and it is too near
      node.on_message(status, {id}, now);
    }
    node.on_timeout(now);
    desk->on_timeout(now);
    while (const auto event = node.poll_event()) {
      if (mission::is_warning(event->kind())) warnings.push_back(*event);
    }
  }
  ASSERT_EQ(warnings.size(), 1U);
  const auto& waits = std::get<mission::event::OrderWaits>(warnings[0].body);
  EXPECT_EQ(waits.line, 1U);
  EXPECT_EQ(waits.order, "take-off");
  EXPECT_THAT(waits.detail, HasSubstr("vehicle 1 and vehicle 2 would come within 1.01 m"));
}

TEST(FormationDesk, RefusesOrdersBeforeTheMissionBegins) {
  mission::GroundNode node{{.agent = {}, .formation = formation_ground({}, {{1}})},
                           at_seconds(-5.0)};
  auto desk = FormationDesk::open({}, {{1}}, node);
  ASSERT_TRUE(desk.ok()) << desk.error().message;
  mission::FormationStatus status;
  status.vehicle = {1};
  node.on_message(status, {1}, at_seconds(-4.0));
  Formation order;
  order.order.kind = mission::OrderKind::take_off;
  const auto early = desk->answer(order, at_seconds(-3.0));
  ASSERT_FALSE(early.ok());
  EXPECT_THAT(early.error().message, HasSubstr("the mission has not begun"));
  node.on_message(status, {1}, at_seconds(1.0));
  EXPECT_TRUE(desk->answer(order, at_seconds(1.0)).ok());
}

/// Planes, a lap that they know, and the desk.
class PlanesDesk : public ::testing::Test {
 protected:
  PlanesDesk() {
    config_.planes = true;
    config_.tracks = {{"lap", std::string{SKEIN_SOURCE_DIR} + "/scenarios/tracks/bent-lap.yaml"}};
    VehicleSpec spec;
    spec.id = {1};
    node_.emplace(
        mission::GroundNodeConfig{
            .agent = {}, .formation = {}, .tracks = track_ground(config_, {spec}, {})},
        Instant{});
  }
  std::string refused(const char* line) {
    auto desk = FormationDesk::open(config_, {{1}}, *node_);
    EXPECT_TRUE(desk.ok()) << desk.error().message;
    const auto input = parse_input(line);
    EXPECT_TRUE(input.ok()) << line;
    const auto answer = desk->answer(std::get<Formation>(*input), at_seconds(1.0));
    return answer ? "given" : answer.error().message;
  }
  configuration::FormationConfig config_;
  std::optional<mission::GroundNode> node_;
};

TEST_F(PlanesDesk, SaysWhatPlanesCannotDo) {
  EXPECT_THAT(refused("take-off"), HasSubstr("planes cannot rest: order fly-along"));
  EXPECT_THAT(refused("form wedge at 0 0 20"), HasSubstr("from their track"));
  EXPECT_THAT(refused("fly-along square in wedge"), HasSubstr("no track 'square'; known are: lap"));
  EXPECT_THAT(refused("fly-along lap in heart"), HasSubstr("'heart' is no shape"));
  EXPECT_THAT(refused("fly-along lap in wedge"), HasSubstr("no plane is heard"));
  config_.planes = false;
  EXPECT_THAT(refused("fly-along lap in wedge"), HasSubstr("along a track fly planes"));
}

}  // namespace
}  // namespace skein::groundstation
