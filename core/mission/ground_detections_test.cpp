// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_detections.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

Detection seen(double east_m, std::uint16_t by = 2, IncidentKind kind = IncidentKind::fire) {
  Detection detection;
  detection.vehicle = {by};
  detection.number = 1;
  detection.kind = kind;
  detection.position = {east_m, 0.0};
  detection.confidence = 0.9;
  return detection;
}

struct GroundDetectionsTest : ::testing::Test {
  std::optional<Site> hear(const Detection& detection) {
    return detections.on_message(Message{detection}, sites, at_seconds(10.0));
  }
  int events() {
    int count = 0;
    while (detections.poll_event()) ++count;
    return count;
  }
  static GroundDetectionsConfig config(bool take) {
    GroundDetectionsConfig made;
    made.take = take;
    made.sites[IncidentKind::fire] = test_site(0);
    return made;
  }
  Fleet fleet{{}};
  GroundSites sites;
  GroundDetections detections{config(false)};
};

TEST_F(GroundDetectionsTest, WhatComesFromOutsideTheTeamIsProposedInEveryMode) {
  GroundDetections takes{config(true)};
  EXPECT_TRUE(takes.propose_from_outside(seen(100.0), sites, at_seconds(10.0)));
  EXPECT_FALSE(takes.propose_from_outside(seen(105.0), sites, at_seconds(10.0)))
      << "the same place";
  ASSERT_EQ(takes.proposals().size(), 1U);
  EXPECT_EQ(takes.proposals().at(1).detection.vehicle, kGroundStation);
  EXPECT_EQ(takes.proposals().at(1).state, Proposal::State::open);
  std::size_t proposed = 1;
  for (int i = 0; i < 100; ++i) {
    proposed +=
        takes.propose_from_outside(seen(1000.0 + 100.0 * i), sites, at_seconds(11.0)) ? 1 : 0;
  }
  EXPECT_EQ(proposed, GroundDetections::kOutsideMax) << "the others' room is kept";
  ASSERT_TRUE(takes.answer(1, false, "ada", at_seconds(12.0)).ok());
  EXPECT_TRUE(takes.propose_from_outside(seen(-1000.0), sites, at_seconds(13.0)));
}

TEST_F(GroundDetectionsTest, OnePlaceIsProposedOnceWhoeverSeesIt) {
  EXPECT_FALSE(hear(seen(100.0)));
  EXPECT_FALSE(hear(seen(100.0)));
  EXPECT_FALSE(hear(seen(115.0, 3)));
  EXPECT_EQ(events(), 1);
  ASSERT_EQ(detections.proposals().size(), 1U);
  EXPECT_FALSE(hear(seen(200.0)));
  EXPECT_EQ(events(), 1);
  const auto site = detections.answer(1, true, "ada", at_seconds(11.0));
  ASSERT_TRUE(site.ok());
  EXPECT_EQ(site->position.x(), 100.0);
  EXPECT_EQ(site->deliveries.size(), 1U) << "as fires are to be treated";
  EXPECT_FALSE(detections.answer(1, false, "ada", at_seconds(12.0)).ok());
  EXPECT_FALSE(detections.answer(9, true, "ada", at_seconds(12.0)).ok());
  ASSERT_TRUE(detections.answer(2, false, "ada", at_seconds(12.0)).ok());
  (void)events();
  EXPECT_FALSE(hear(seen(205.0)));
  EXPECT_EQ(events(), 0) << "what was dismissed is not proposed again";
}

TEST_F(GroundDetectionsTest, WhereASiteIsOrWasNothingIsProposed) {
  Site site = test_site(0);
  site.position = {100.0, 0.0};
  const auto id = sites.add(site, std::nullopt, fleet, at_seconds(5.0));
  EXPECT_FALSE(hear(seen(120.0)));
  ASSERT_TRUE(sites.withdraw(*id, "ada", at_seconds(6.0)).ok());
  EXPECT_FALSE(hear(seen(120.0)));
  EXPECT_EQ(events(), 0);
}

TEST_F(GroundDetectionsTest, IsTakenAtOnceWhereThatIsConfigured) {
  detections = GroundDetections{config(true)};
  const auto fire = hear(seen(100.0));
  ASSERT_TRUE(fire);
  EXPECT_EQ(fire->deliveries.size(), 1U);
  const auto flood = hear(seen(500.0, 2, IncidentKind::flood));
  ASSERT_TRUE(flood);
  EXPECT_TRUE(flood->deliveries.empty()) << "a kind without a template is surveyed";
  EXPECT_EQ(events(), 0);
}

TEST_F(GroundDetectionsTest, ANewProcessKnowsWhatWasAnswered) {
  hear(seen(100.0));
  hear(seen(300.0));
  (void)detections.answer(1, false, "ada", at_seconds(5.0));
  std::vector<Message> said;
  while (auto event = detections.poll_event()) said.emplace_back(*std::move(event));
  detections = GroundDetections{config(false)};
  for (const Message& message : said) detections.recall(message, kGroundStation);
  for (const Message& message : said) detections.recall(message, {2});
  EXPECT_FALSE(detections.proposed(1).ok());
  ASSERT_TRUE(detections.proposed(2).ok());
  EXPECT_EQ(detections.proposals().at(2).detection.confidence, seen(300.0).confidence);
  EXPECT_EQ(events(), 0);
  detections.on_timeout(at_seconds(9.0));
  detections.on_timeout(at_seconds(9.5));
  EXPECT_EQ(events(), 1) << "what is open is told again, once";
}

TEST_F(GroundDetectionsTest, OfWhatIsAnsweredTheOldestMakesRoom) {
  for (std::size_t i = 1; i <= GroundDetections::kProposalsMax; ++i) {
    hear(seen(100.0 * static_cast<double>(i)));
    (void)events();
  }
  hear(seen(50'000.0));
  EXPECT_EQ(detections.dropped(), 1U) << "all wait for the operator";
  (void)detections.answer(3, false, "ada", at_seconds(5.0));
  hear(seen(50'000.0));
  EXPECT_EQ(detections.dropped(), 1U);
  EXPECT_FALSE(detections.proposals().contains(3));
  EXPECT_TRUE(detections.proposed(GroundDetections::kProposalsMax + 1).ok());
}

}  // namespace
}  // namespace skein::mission
