// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/process_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <variant>

namespace skein::hil {
namespace {

using testing::HasSubstr;

configuration::Scenario scenario(std::uint64_t seed) {
  configuration::Scenario scenario;
  scenario.seed = seed;
  for (std::uint16_t id = 1; id <= 8; ++id) {
    configuration::ScenarioVehicle vehicle;
    vehicle.spec.id = VehicleId{id};
    vehicle.spec.speed_max_mps = 30.0;
    vehicle.spec.range_m = 10'000.0;
    scenario.vehicles.push_back(vehicle);
  }
  Site site;
  site.id = SiteId{1};
  scenario.sites.push_back(site);
  scenario.operator_decisions.push_back({SiteId{1}});
  return scenario;
}

std::string text_of(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += describe(fault) + "\n";
  return text;
}

std::string drawn(const std::string& profiles, std::uint64_t seed) {
  auto of = scenario(seed);
  const auto faults = spoil(of, profiles, true);
  EXPECT_TRUE(faults) << faults.error().message;
  return faults ? text_of(*faults) : "";
}

TEST(ProcessFaults, ASeedDrawsTheSameAgainAndAnotherDoesNot) {
  EXPECT_EQ(drawn("nemesis", 7), drawn("nemesis", 7));
  EXPECT_NE(drawn("stall", 7), drawn("stall", 8));
}

TEST(ProcessFaults, ANemesisHasEverythingInTheEnd) {
  std::set<std::size_t> kinds;
  bool ground_restarted = false;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    auto of = scenario(seed);
    const auto faults = spoil(of, "nemesis", true);
    ASSERT_TRUE(faults);
    for (const Fault& fault : *faults) {
      kinds.insert(fault.what.index());
      const auto* ended = std::get_if<ProgramsEnd>(&fault.what);
      ground_restarted = ground_restarted || (ended != nullptr && fault.lasts &&
                                              ended->who == std::vector{kGroundStation});
    }
  }
  const auto has = [&kinds](const auto& what) {
    return kinds.contains(decltype(Fault::what){what}.index());
  };
  EXPECT_TRUE(has(ProgramsEnd{}));
  EXPECT_TRUE(has(ProgramsStall{}));
  EXPECT_TRUE(has(ProgramSlow{}));
  EXPECT_TRUE(has(DiskFull{}));
  EXPECT_TRUE(has(ClockStep{}));
  EXPECT_TRUE(has(OtherRelease{}));
  EXPECT_TRUE(has(radio::Cut{}));
  EXPECT_TRUE(has(Healing{}));
  EXPECT_TRUE(ground_restarted);
}

TEST(ProcessFaults, AnotherReleaseIsNotToldItsClock) {
  int others = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    auto of = scenario(seed);
    const auto faults = spoil(of, "versions,clocks,clock,nemesis", true);
    ASSERT_TRUE(faults);
    for (const Fault& fault : *faults) {
      const auto* off = std::get_if<ClockOff>(&fault.what);
      const auto* step = std::get_if<ClockStep>(&fault.what);
      EXPECT_FALSE(off != nullptr && is_of_other_release(*faults, off->node)) << seed;
      EXPECT_FALSE(step != nullptr && is_of_other_release(*faults, step->vehicle)) << seed;
      others += std::holds_alternative<OtherRelease>(fault.what) ? 1 : 0;
    }
  }
  EXPECT_GT(others, 100);
}

TEST(ProcessFaults, TheRadioIsWholeFromTheHealingOn) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    auto of = scenario(seed);
    const auto faults = spoil(of, "partition,flapping,lossy", false);
    ASSERT_TRUE(faults);
    const auto healed = healing_of(*faults);
    ASSERT_TRUE(healed);
    for (const Fault& fault : *faults) {
      if (!std::holds_alternative<radio::Cut>(fault.what)) continue;
      ASSERT_TRUE(fault.lasts);
      EXPECT_LE(fault.when.not_before + *fault.lasts, *healed);
    }
    EXPECT_GT(of.duration_max, *healed - Instant{});
  }
}

TEST(ProcessFaults, LaterHazardsAndDecisionsAreTheScenarios) {
  bool appeared = false;
  bool late = false;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    auto of = scenario(seed);
    ASSERT_TRUE(spoil(of, "hazards,operator", false));
    appeared = appeared || !of.hazards.empty();
    late = late ||
           (!of.operator_decisions.empty() && of.operator_decisions.front().not_before > Instant{});
  }
  EXPECT_TRUE(appeared);
  EXPECT_TRUE(late);
}

TEST(ProcessFaults, WithoutAnyTheScenarioIsWhatItWas) {
  auto of = scenario(1);
  const auto before = of.duration_max;
  const auto faults = spoil(of, "none", false);
  ASSERT_TRUE(faults);
  EXPECT_TRUE(faults->empty());
  EXPECT_EQ(of.duration_max, before);
}

TEST(ProcessFaults, WhatCannotBeDrawnIsRefusedWithAWord) {
  auto of = scenario(1);
  EXPECT_THAT(spoil(of, "planner", false).error().message, HasSubstr("in virtual time only"));
  EXPECT_THAT(spoil(of, "stal", false).error().message, HasSubstr("no fault profile 'stal'"));
  EXPECT_THAT(spoil(of, "versions", false).error().message, HasSubstr("--other-bin"));
  of.sites.clear();
  EXPECT_THAT(spoil(of, "stall", false).error().message, HasSubstr("missions with sites"));
}

}  // namespace
}  // namespace skein::hil
