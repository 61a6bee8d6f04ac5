// SPDX-License-Identifier: Apache-2.0
#include "link_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "troubles.hpp"

namespace skein::ardupilot {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

can::Frame frame_of(std::uint8_t node) {
  dronecan::Header header;
  header.type = 341;
  header.source = node;
  can::Frame frame;
  frame.id = dronecan::can_id(header);
  frame.extended = true;
  frame.size = 8;
  return frame;
}

TEST(LinkWatch, TellsTheLowestThatIsMissingAndGivesTheNextItsTime) {
  LinkWatch watch{{.bus = "can0"}, at_seconds(0.0)};
  EXPECT_FALSE(watch.trouble(at_seconds(4.4)));
  EXPECT_EQ(watch.trouble(at_seconds(4.5))->news, AutopilotNews::no_bus_traffic);
  (void)watch.trouble(at_seconds(19.9));
  watch.on_frame(frame_of(10), at_seconds(20.0));
  EXPECT_EQ(watch.trouble(at_seconds(20.0)), std::nullopt) << "what is above gets its time";
  for (int i = 21; i <= 25; ++i) {
    watch.on_frame(frame_of(10), at_seconds(i));
    const auto trouble = watch.trouble(at_seconds(i));
    EXPECT_EQ(trouble.has_value(), i == 25) << i;
    if (trouble) {
      EXPECT_EQ(trouble->news, AutopilotNews::no_serial_port);
    }
  }
}

TEST(LinkWatch, OwnErrorFramesAreNoTraffic) {
  LinkWatch watch{{.bus = "can0"}, at_seconds(0.0)};
  can::Frame frame = frame_of(10);
  frame.error = true;
  watch.on_frame(frame, at_seconds(4.0));
  EXPECT_EQ(watch.trouble(at_seconds(5.0))->news, AutopilotNews::no_bus_traffic);
}

TEST(LinkWatch, NamesTheNodesThatAreThere) {
  LinkWatch watch{{.bus = "can0"}, at_seconds(0.0)};
  for (int id = 20; id < 40; ++id) {
    watch.on_frame(frame_of(static_cast<std::uint8_t>(id)), at_seconds(4.0));
  }
  const auto trouble = watch.trouble(at_seconds(5.0));
  ASSERT_TRUE(trouble);
  EXPECT_EQ(trouble->news, AutopilotNews::node_missing);
  EXPECT_EQ(trouble->number, 10);
  EXPECT_EQ(trouble->detail, "20, 21, 22, 23, 24, 25, 26, 27 and 12 more");
  can::Frame foreign = frame_of(20);
  foreign.extended = false;
  foreign.id = 0x123;
  watch.on_frame(foreign, at_seconds(12.0));
  EXPECT_EQ(watch.trouble(at_seconds(12.0))->detail,
            "none, though frames come that are not DroneCAN's");
}

TEST(Troubles, AreToldWhenTheyComeUpAndEachMinute) {
  Troubles troubles;
  const AutopilotNotice a{AutopilotNews::no_bus_traffic};
  const AutopilotNotice b{AutopilotNews::no_heartbeat};
  EXPECT_THAT(troubles.update({a}, at_seconds(0.0)), ElementsAre(a));
  for (int i = 1; i < 60; ++i) EXPECT_THAT(troubles.update({a}, at_seconds(i)), IsEmpty());
  EXPECT_THAT(troubles.update({a, b}, at_seconds(60.0)), ElementsAre(a, b));
  // One that comes and goes within seconds is the same still.
  EXPECT_THAT(troubles.update({}, at_seconds(62.0)), IsEmpty());
  EXPECT_THAT(troubles.update({a}, at_seconds(64.0)), IsEmpty());
  EXPECT_THAT(troubles.update({}, at_seconds(70.0)), IsEmpty());
  EXPECT_THAT(troubles.update({a}, at_seconds(71.0)), ElementsAre(a));
}

TEST(PreArmTexts, EachIsNewsOnceUntilItIsSaidNoMore) {
  PreArmTexts texts;
  EXPECT_TRUE(PreArmTexts::is_one("PreArm: Compass not calibrated"));
  EXPECT_FALSE(PreArmTexts::is_one("Arm: Compass not calibrated"));
  EXPECT_TRUE(texts.add("a", at_seconds(0.0)));
  EXPECT_TRUE(texts.add("b", at_seconds(0.0)));
  EXPECT_FALSE(texts.add("a", at_seconds(30.0)));
  texts.expire(at_seconds(80.0));
  EXPECT_EQ(texts.texts().size(), 1U);
  for (char c = 'c'; c <= 'z'; ++c) EXPECT_TRUE(texts.add(std::string{c}, at_seconds(81.0)));
  EXPECT_LE(texts.texts().size(), PreArmTexts::kMax);
}

TEST(PreArmTexts, EachHasARemedy) {
  EXPECT_EQ(PreArmTexts::reason_of("PreArm: GPS 1: Bad fix"),
            "GPS 1: Bad fix (wait under open sky; is its receiver connected?)");
  EXPECT_EQ(PreArmTexts::reason_of("PreArm: Tuesday"), "Tuesday (see ArduPilot's pre-arm checks)");
  const std::string longest = PreArmTexts::reason_of("PreArm: " + std::string(400, 'x'));
  EXPECT_EQ(longest.size(), PreArmTexts::kBytesMax);
  EXPECT_TRUE(longest.ends_with("x (see ArduPilot's pre-arm checks)"));
}

TEST(PreArmTexts, OneThatIsMeasuredAgainIsNoNews) {
  PreArmTexts texts;
  EXPECT_TRUE(texts.add("EKF3 Yaw inconsistent 94 deg", at_seconds(0.0)));
  EXPECT_FALSE(texts.add("EKF3 Yaw inconsistent 101 deg", at_seconds(30.0)));
  ASSERT_EQ(texts.texts().size(), 1U);
  EXPECT_EQ(texts.texts().front().text, "EKF3 Yaw inconsistent 101 deg");
  EXPECT_TRUE(texts.add("GPS 1: Bad fix", at_seconds(30.0)));
  EXPECT_TRUE(texts.add("GPS 2: Bad fix", at_seconds(30.0)));
  EXPECT_TRUE(texts.add("GPS", at_seconds(30.0)));
}

}  // namespace
}  // namespace skein::ardupilot
