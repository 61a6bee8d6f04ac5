// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

/// On the ground, for the pilot.
void stand(Line& line) {
  line.autopilot.armed = false;
  line.autopilot.landed = 1;
  line.autopilot.relative_height_m = 0.0;
}

const TestedParameter& safety_of(const AutopilotFacts& facts, const std::string& name) {
  for (const auto& parameter : facts.safety) {
    if (parameter.name == name) return parameter;
  }
  ADD_FAILURE() << name << " is not looked at";
  return facts.safety.at(0);
}

TEST(CompanionFacts, AreWhatTheAutopilotHasSaid) {
  Line line;
  stand(line);
  line.autopilot.parameters["FENCE_ENABLE"] = 1.0F;
  EXPECT_FALSE(line.companion.facts(line.now));
  line.run(5.0);
  const auto facts = line.companion.facts(line.now);
  ASSERT_TRUE(facts);
  ASSERT_TRUE(facts->heartbeat && facts->health && facts->gnss && facts->filter && facts->landed);
  EXPECT_EQ(facts->gnss->fix_type, 3);
  EXPECT_EQ(facts->filter->flags, 0x33F);
  ASSERT_TRUE(facts->time);
  EXPECT_LT(line.now - facts->time_at, std::chrono::seconds{2});
  EXPECT_EQ(facts->firmware, line.autopilot.firmware);
  EXPECT_THAT(facts->parameters, Contains(std::pair<const std::string, double>{"FENCE_ENABLE", 1}));
  EXPECT_THAT(facts->parameters,
              Contains(std::pair<const std::string, double>{"ROLL_LIMIT_DEG", 75}));
  EXPECT_EQ(facts->safety.size(), 3U);
  EXPECT_TRUE(safety_of(*facts, "SYSID_MYGCS").of_own_id);
  EXPECT_FALSE(safety_of(*facts, "FS_LONG_ACTN").of_own_id);
  EXPECT_FALSE(facts->trouble);
  EXPECT_FALSE(facts->in_flight);
}

TEST(CompanionFacts, AParameterThatIsNotToldIsWaitedForAndThenNamed) {
  Line line;
  stand(line);
  line.autopilot.parameters.erase("FS_LONG_ACTN");
  line.run(1.0);
  EXPECT_FALSE(line.companion.facts(line.now));  // it may only be late
  line.run(4.0);
  const auto facts = line.companion.facts(line.now);
  ASSERT_TRUE(facts);
  EXPECT_FALSE(safety_of(*facts, "FS_LONG_ACTN").value);
  EXPECT_THAT(safety_of(*facts, "FS_LONG_ACTN").finding, Not(IsEmpty()));
  line.autopilot.set_parameter("FS_LONG_ACTN", 1.0F);
  line.run(0.1);
  EXPECT_THAT(safety_of(*line.companion.facts(line.now), "FS_LONG_ACTN").finding, IsEmpty());
}

TEST(CompanionFacts, NothingIsKnownOfAnAutopilotThatIsNotHeard) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  ASSERT_TRUE(line.companion.facts(line.now));
  EXPECT_TRUE(line.companion.facts(line.now)->in_flight);
  line.cut = true;
  line.run(0.5);
  EXPECT_FALSE(line.companion.facts(line.now));
  line.companion.on_link_trouble(AutopilotNotice{AutopilotNews::no_bus_traffic});
  const auto facts = line.companion.facts(line.now);
  ASSERT_TRUE(facts);
  EXPECT_FALSE(facts->heartbeat);
  EXPECT_EQ(facts->trouble->news, AutopilotNews::no_bus_traffic);
}

TEST(CompanionFacts, AStreamThatIsOnlyLookedAtMayBeRefused) {
  Line line;
  stand(line);
  line.autopilot.refuses_streams = {mavlink::GpsRawInt::kDefinition.id,
                                    mavlink::EkfStatusReport::kDefinition.id};
  line.run(6.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_THAT(line.warnings, IsEmpty());
  ASSERT_TRUE(line.companion.facts(line.now));
  EXPECT_FALSE(line.companion.facts(line.now)->gnss);
}

TEST(AutopilotFacts, TellTheBatteryWhereItIsMeasured) {
  AutopilotFacts facts;
  EXPECT_EQ(facts.battery_percent(), kBatteryNotTold);
  facts.health.emplace();
  facts.health->battery_remaining = 55;
  EXPECT_EQ(facts.battery_percent(), kBatteryNotTold) << "BATT_MONITOR is 0";
  facts.health->onboard_control_sensors_enabled = mavlink::sensor_battery;
  EXPECT_EQ(facts.battery_percent(), 55);
  for (const std::int8_t none : {std::int8_t{-1}, std::int8_t{101}}) {
    facts.health->battery_remaining = none;
    EXPECT_EQ(facts.battery_percent(), kBatteryNotTold);
  }
}

}  // namespace
}  // namespace skein::ardupilot
