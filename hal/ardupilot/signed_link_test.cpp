// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kUnix_us = 1'764'000'000'000'000;

CompanionParams with_key(const char* passphrase, std::int64_t unix_us = kUnix_us) {
  CompanionParams p = params();
  p.signing = mavlink::Signing{mavlink::key_of(passphrase), unix_us};
  return p;
}

/// An autopilot and a companion with keys.
struct SignedLine : Line {
  explicit SignedLine(const CompanionParams& p = with_key("ours"), const char* theirs = "ours")
      : Line{p} {
    autopilot.sign_with(mavlink::key_of(theirs), mavlink::signing_time(kUnix_us));
  }
};

TEST(SignedLink, BothSignAndHeedEachOther) {
  SignedLine line;
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5});
  EXPECT_GT(line.targets_within(1.0), 20U);
  EXPECT_EQ(line.autopilot.bad_signatures(), 0U);
  EXPECT_EQ(line.companion.parser().bad_signature, 0U);
}

TEST(SignedLink, AnUnsignedAutopilotIsNotHeededAndThatIsTold) {
  Line line{with_key("ours")};
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::searching);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("not signed with the key")));
  EXPECT_TRUE(line.autopilot.commands.empty());
}

TEST(SignedLink, NorIsOneWithAnotherKey) {
  SignedLine line{with_key("ours"), "theirs"};
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::searching);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("not signed with the key")));
}

TEST(SignedLink, AStrangersPacketChangesNothing) {
  SignedLine line;
  line.until(State::flying, 10.0);
  mavlink::Encoder stranger{1, mavlink::kComponentAutopilot};
  mavlink::Heartbeat rtl;
  rtl.type = 1;
  rtl.autopilot = 3;
  rtl.base_mode = 0x81;
  rtl.custom_mode = 11;
  for (int i = 0; i < 20; ++i) {
    line.companion.on_bytes(stranger.encode(rtl), line.now);
    line.run(0.05);
  }
  EXPECT_EQ(line.companion.state(), State::flying) << "it would be piloted";
  EXPECT_EQ(line.companion.parser().bad_signature, 20U);
}

TEST(SignedLink, WhatWasHeardBeforeCountsOnce) {
  SignedLine line;
  line.until(State::flying, 10.0);
  mavlink::Encoder genuine{1, mavlink::kComponentAutopilot};
  genuine.sign_with({mavlink::key_of("ours"), 7, mavlink::signing_time(kUnix_us)});
  mavlink::Heartbeat loiter;
  loiter.type = 1;
  loiter.autopilot = 3;
  loiter.base_mode = 0x81;
  loiter.custom_mode = 12;
  const auto recorded = genuine.encode(loiter);
  line.companion.on_bytes(recorded, line.now);
  EXPECT_EQ(line.companion.state(), State::piloted);
  const auto before = line.companion.parser().bad_signature;
  line.companion.on_bytes(recorded, line.now);
  EXPECT_EQ(line.companion.parser().bad_signature, before + 1);
}

/// It signs with the newest time that it has heard of.
TEST(SignedLink, AClockThatWasSetBackDoesNotMakeItMute) {
  SignedLine line{with_key("ours", kUnix_us - 30'000'000)};
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5});
  EXPECT_EQ(line.autopilot.bad_signatures(), 0U);
}

TEST(SigningKeyFile, IsHexadecimalOrAPassphrase) {
  const std::string hex(64, 'a');
  EXPECT_EQ(mavlink::key_from_text(" " + hex + "\n").value()[31], 0xAA);
  EXPECT_EQ(mavlink::key_from_text("open sesame\n").value(), mavlink::key_of("open sesame"));
  EXPECT_EQ(mavlink::key_from_text(std::string(63, 'a') + "g").value(),
            mavlink::key_of(std::string(63, 'a') + "g"));
  EXPECT_FALSE(mavlink::key_from_text(" \n"));
}

}  // namespace
}  // namespace skein::ardupilot
