// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_hazards.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace skein::mission {
namespace {

std::vector<HazardReport> said(GroundHazards& hazards) {
  std::vector<HazardReport> all;
  while (const auto message = hazards.poll_message()) {
    all.push_back(std::get<HazardReport>(*message));
  }
  return all;
}

void run(GroundHazards& hazards, double from_s, double to_s) {
  for (double t = from_s; t <= to_s; t += 0.5) hazards.on_timeout(at_seconds(t));
}

TEST(GroundHazards, TellsOfAHazardAgainAndAgain) {
  GroundHazards hazards{{{{10'001}, {0.0, 0.0}, 5.0}}};
  hazards.on_message(Message{HazardReport{{{10'002}, {0.0, 0.0}, 10.0}, false}});
  const auto id = hazards.add({100.0, -200.0}, 300.0, at_seconds(1.0));
  ASSERT_TRUE(id.ok());
  EXPECT_EQ(*id, HazardId{10'003});  // none that is known
  EXPECT_EQ(hazards.add({0.0, 0.0}, 1.0, at_seconds(2.0)).value(), HazardId{10'004});
  run(hazards, 2.0, 30.0);
  const auto told = said(hazards);
  EXPECT_GE(told.size(), 10U);
  EXPECT_EQ(std::count_if(
                told.begin(), told.end(),
                [&](const auto& m) { return m.hazard.id == *id && m.hazard.radius_m == 300.0; }),
            static_cast<std::ptrdiff_t>(told.size() / 2));
  for (const double radius : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(hazards.add({0.0, 0.0}, radius, at_seconds(31.0)).ok());
  }
  for (std::size_t i = 2; i < GroundHazards::kHazardsMax; ++i) {
    EXPECT_TRUE(hazards.add({0.0, 0.0}, 1.0, at_seconds(31.0)).ok());
  }
  EXPECT_FALSE(hazards.add({0.0, 0.0}, 1.0, at_seconds(31.0)).ok());
}

TEST(GroundHazards, OneAfterANewStartIsANewOne) {
  GroundHazards before{{}};
  const auto first = before.add({0.0, 0.0}, 1.0, at_seconds(100.0));
  GroundHazards after{{}};
  EXPECT_NE(after.add({5.0, 5.0}, 1.0, at_seconds(110.0)).value(), *first);
  // However long the mission is, and whatever others say.
  GroundHazards late{{}};
  late.on_message(Message{HazardReport{{{65'535}, {0.0, 0.0}, 10.0}, false}});
  EXPECT_EQ(late.add({0.0, 0.0}, 1.0, at_seconds(1e6)).value(), HazardId{65'534});
}

TEST(GroundHazards, WhatIsWithdrawnIsToldInPlaceOfTheHazardAlsoAfterANewStart) {
  GroundHazards hazards{{{{3}, {7.0, 8.0}, 5.0}}};
  const auto id = hazards.add({100.0, 0.0}, 30.0, at_seconds(1.0));
  std::vector<HazardReport> record = said(hazards);
  ASSERT_TRUE(hazards.withdraw(*id, at_seconds(2.0)).ok());
  ASSERT_TRUE(hazards.withdraw({3}, at_seconds(3.0)).ok()) << "known before the mission";
  EXPECT_FALSE(hazards.withdraw(*id, at_seconds(3.0)).ok()) << "there is none any more";
  EXPECT_FALSE(hazards.withdraw({9}, at_seconds(3.0)).ok());
  run(hazards, 3.0, 20.0);
  const auto told = said(hazards);
  EXPECT_GE(told.size(), 8U);
  for (const HazardReport& report : told) EXPECT_TRUE(report.withdrawn);

  record.insert(record.end(), told.begin(), told.end());
  GroundHazards after{{{{3}, {7.0, 8.0}, 5.0}}};
  for (const HazardReport& report : record) {
    after.recall(Message{report}, kGroundStation, at_seconds(20.0));
  }
  EXPECT_TRUE(said(after).empty()) << "what was said then is not said again at once";
  run(after, 21.0, 26.0);
  const auto again = said(after);
  ASSERT_EQ(again.size(), 2U);
  for (const HazardReport& report : again) EXPECT_TRUE(report.withdrawn);
}

}  // namespace
}  // namespace skein::mission
