// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/preflight_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "skein/codec/codec.hpp"

namespace skein::onboard {
namespace {

using mission::Preflight;
using ::testing::SizeIs;

Check check(Verdict verdict, CheckGroup group, std::string what = "x", std::string remedy = {}) {
  return {std::move(what), verdict, "found", std::move(remedy), group};
}

TEST(PreflightReport, CountsByGroupAndTellsWhatIsNotOkFailuresFirst) {
  const Preflight told = preflight_of(
      {}, {check(Verdict::ok, CheckGroup::clock), check(Verdict::warn, CheckGroup::clock, "source"),
           check(Verdict::ok, CheckGroup::gnss), check(Verdict::fail, CheckGroup::gnss, "fix")});
  ASSERT_THAT(told.counts, SizeIs(2));
  EXPECT_EQ(told.counts[0], (mission::CheckCount{CheckGroup::clock, 1, 1, 0}));
  EXPECT_EQ(told.counts[1], (mission::CheckCount{CheckGroup::gnss, 1, 0, 1}));
  ASSERT_THAT(told.lines, SizeIs(2));
  EXPECT_EQ(told.lines[0].what, "fix");
  EXPECT_EQ(told.lines[1].what, "source");
  EXPECT_EQ(told.lines_left_out, 0);
}

TEST(PreflightReport, IsSmallWhateverIsFound) {
  Checks all;
  for (int i = 0; i < 60; ++i) {
    all.push_back(check(Verdict::fail, CheckGroup::network, std::string(80, 'w'),
                        std::string(199, 'r') + "\u00e4\u00e4\u00e4"));
  }
  const Preflight told = preflight_of({}, all);
  EXPECT_EQ(told.lines.size() + told.lines_left_out, 60U);
  EXPECT_GE(told.lines.size(), 3U);
  const auto bytes = codec::encode(mission::Message{told});
  ASSERT_TRUE(bytes);  // no half of a letter, either
  EXPECT_LE(bytes->size(), 1400U);
  EXPECT_TRUE(
      std::holds_alternative<mission::Message>(codec::decode(codec::Topic::preflight, *bytes)));
}

TEST(PreflightReport, AUsualOneIsAHundredthOfWhatAVehicleMaySay) {
  Checks all;
  for (std::size_t group = 0; group < static_cast<std::size_t>(CheckGroup::count); ++group) {
    all.push_back(check(Verdict::ok, static_cast<CheckGroup>(group)));
  }
  all.push_back({"time source", Verdict::warn, "none of chrony, systemd-timesyncd, ntpd runs",
                 "in the field a GNSS receiver or one machine of the team gives the time "
                 "(docs/field-guide.md)",
                 CheckGroup::clock});
  all.push_back({"geofence", Verdict::warn, "FENCE_ENABLE is not told",
                 "with FENCE_ENABLE 1 the autopilot keeps within its own bounds, whatever it is "
                 "asked",
                 CheckGroup::arming});
  Preflight base;
  base.release = "0.2.0+g8d24e6798ec5";
  base.firmware = "4.6.3";
  const auto bytes = codec::encode(mission::Message{preflight_of(base, all)});
  ASSERT_TRUE(bytes);
  constexpr double kAir_bytes_per_s = 3000.0;
  EXPECT_LE(static_cast<double>(bytes->size()) / to_seconds(PreflightTeller::kRepeat),
            0.01 * kAir_bytes_per_s)
      << bytes->size();
}

TEST(PreflightReport, ADigestIsTheSameWhereParametersAreSetAlike) {
  ardupilot::AutopilotFacts facts;
  EXPECT_EQ(digest_of(facts), 0U);
  facts.safety = {{"SYSID_MYGCS", 3.0, {}, true}, {"FS_LONG_ACTN", 1.0, {}, false}};
  facts.parameters = {{"ROLL_LIMIT_DEG", 45.0}};
  auto other = facts;
  other.safety[0].value = 4.0;  // each its own
  EXPECT_EQ(digest_of(facts), digest_of(other));
  other.safety[0].finding = "it is another's";
  EXPECT_NE(digest_of(facts), digest_of(other));
  other = facts;
  other.parameters["ROLL_LIMIT_DEG"] = 46.0;
  EXPECT_NE(digest_of(facts), digest_of(other));
}

/// With one line that has this verdict, and says this.
Preflight with(Verdict verdict, const std::string& found) {
  Preflight told;
  told.lines = {{CheckGroup::battery, verdict, "battery", found, "charge it"}};
  return told;
}

TEST(PreflightTeller, TellsVerdictsAtOnceFiguresLaterAndAllOfItAgain) {
  PreflightTeller teller;
  EXPECT_FALSE(teller.due(at_seconds(0.0)));
  teller.put(with(Verdict::warn, "40 %"));
  EXPECT_TRUE(teller.due(at_seconds(0.0)));
  EXPECT_FALSE(teller.due(at_seconds(1.0)));
  teller.put(with(Verdict::warn, "39 %"));
  EXPECT_FALSE(teller.due(at_seconds(9.0)));
  EXPECT_EQ(teller.due(at_seconds(10.0)).value().lines[0].found, "39 %");
  teller.put(with(Verdict::fail, "39 %"));
  EXPECT_FALSE(teller.due(at_seconds(11.0)));  // what comes and goes fills no radio
  EXPECT_EQ(teller.due(at_seconds(12.0)).value().lines[0].verdict, Verdict::fail);
  EXPECT_FALSE(teller.due(at_seconds(41.0)));
  EXPECT_TRUE(teller.due(at_seconds(42.0)));
}

TEST(PreflightTeller, WhoHasStartedAnewIsTold) {
  PreflightTeller teller;
  teller.put({});
  EXPECT_TRUE(teller.due(at_seconds(0.0)));
  EXPECT_FALSE(teller.due(at_seconds(5.0)));
  teller.ask();
  EXPECT_TRUE(teller.due(at_seconds(5.0)));
  EXPECT_FALSE(teller.due(at_seconds(8.0)));
}

}  // namespace
}  // namespace skein::onboard
