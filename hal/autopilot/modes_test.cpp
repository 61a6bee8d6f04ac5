// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/modes.hpp"

#include <gtest/gtest.h>

#include "skein/autopilot/command.hpp"

namespace skein::autopilot {
namespace {

constexpr std::array kAllPlane{PlaneMode::manual, PlaneMode::fbwa,     PlaneMode::mission,
                               PlaneMode::rtl,    PlaneMode::loiter,   PlaneMode::takeoff,
                               PlaneMode::guided, PlaneMode::q_loiter, PlaneMode::q_land,
                               PlaneMode::q_rtl};
constexpr std::array kAllCopter{CopterMode::stabilize, CopterMode::guided, CopterMode::loiter,
                                CopterMode::rtl, CopterMode::land};
constexpr ModeFacts kGood{.position = true, .mission = true, .rotors = true};

TEST(Modes, EveryModeCanBeSelectedFromEveryMode) {
  for (const PlaneMode from : kAllPlane) {
    for (const PlaneMode to : kAllPlane) {
      ModeMachine<PlaneMode, PlaneEvent> machine{kPlaneModes, from};
      EXPECT_TRUE(machine.fire(selection_of(to), kGood));
      EXPECT_EQ(machine.mode(), to);
    }
  }
  for (const CopterMode from : kAllCopter) {
    for (const CopterMode to : kAllCopter) {
      ModeMachine<CopterMode, CopterEvent> machine{kCopterModes, from};
      EXPECT_TRUE(machine.fire(selection_of(to), kGood));
      EXPECT_EQ(machine.mode(), to);
    }
  }
}

TEST(Modes, WithoutAPositionOnlyPilotsModes) {
  for (const PlaneMode to : kAllPlane) {
    ModeMachine<PlaneMode, PlaneEvent> machine{kPlaneModes, PlaneMode::manual};
    const bool pilots = to == PlaneMode::manual || to == PlaneMode::fbwa;
    EXPECT_EQ(machine.fire(selection_of(to), {.position = false, .mission = true}), pilots)
        << to_string(to);
  }
  for (const CopterMode to : kAllCopter) {
    ModeMachine<CopterMode, CopterEvent> machine{kCopterModes, CopterMode::stabilize};
    const bool without = to == CopterMode::stabilize || to == CopterMode::land;
    EXPECT_EQ(machine.fire(selection_of(to), {}), without) << to_string(to);
  }
  ModeMachine<PlaneMode, PlaneEvent> machine{kPlaneModes, PlaneMode::manual};
  EXPECT_FALSE(machine.fire(PlaneEvent::select_mission, {.position = true, .mission = false}));
  EXPECT_EQ(machine.mode(), PlaneMode::manual);
}

TEST(Modes, ALostCompanionReturnsWhatFliesByItself) {
  for (const PlaneMode from : kAllPlane) {
    ModeMachine<PlaneMode, PlaneEvent> machine{kPlaneModes, from};
    const bool returns =
        from == PlaneMode::guided || from == PlaneMode::mission || from == PlaneMode::loiter;
    EXPECT_EQ(machine.fire(PlaneEvent::companion_lost, kGood), returns) << to_string(from);
    EXPECT_EQ(machine.mode(), returns ? PlaneMode::rtl : from);
  }
  ModeMachine<CopterMode, CopterEvent> good{kCopterModes, CopterMode::guided};
  EXPECT_TRUE(good.fire(CopterEvent::companion_lost, kGood));
  EXPECT_EQ(good.mode(), CopterMode::rtl);
  ModeMachine<CopterMode, CopterEvent> blind{kCopterModes, CopterMode::guided};
  EXPECT_TRUE(blind.fire(CopterEvent::companion_lost, {}));
  EXPECT_EQ(blind.mode(), CopterMode::land);
  ModeMachine<CopterMode, CopterEvent> pilot{kCopterModes, CopterMode::stabilize};
  EXPECT_FALSE(pilot.fire(CopterEvent::companion_lost, kGood));
  EXPECT_FALSE(pilot.fire(CopterEvent::position_lost, {}));
}

TEST(Modes, WithoutRotorsNobodyHovers) {
  constexpr ModeFacts kPlane{.position = true, .mission = true};
  for (const PlaneMode to : {PlaneMode::q_loiter, PlaneMode::q_land, PlaneMode::q_rtl}) {
    ModeMachine<PlaneMode, PlaneEvent> machine{kPlaneModes, PlaneMode::loiter};
    EXPECT_FALSE(machine.fire(selection_of(to), kPlane)) << to_string(to);
  }
}

TEST(Modes, NumbersAndNamesAreArduPilots) {
  for (const PlaneMode mode : kAllPlane) {
    EXPECT_EQ(plane_mode(static_cast<std::uint32_t>(mode)), mode);
  }
  EXPECT_EQ(plane_mode(15), PlaneMode::guided);
  EXPECT_EQ(plane_mode(10), PlaneMode::mission);
  EXPECT_EQ(plane_mode(21), PlaneMode::q_rtl);
  EXPECT_EQ(plane_mode(24), std::nullopt);
  EXPECT_EQ(copter_mode(4), CopterMode::guided);
  EXPECT_EQ(copter_mode(3), std::nullopt);
  EXPECT_EQ(to_string(PlaneMode::mission), "AUTO");
  EXPECT_EQ(to_string(CopterMode::stabilize), "STABILIZE");
}

TEST(Arming, NamesTheFirstReason) {
  EXPECT_EQ(arming_refusal({}), std::nullopt);
  EXPECT_EQ(arming_refusal({.position = false}), "Need Position Estimate");
  EXPECT_EQ(arming_refusal({.gyros = false, .position = false}), "Gyros not healthy");
}

TEST(CompanionWatch, FiresOnceForEachSilence) {
  CompanionWatch watch{true, std::chrono::seconds{5}};
  EXPECT_FALSE(watch.lost_now(at_seconds(100.0)));  // never heard
  watch.heard(at_seconds(100.0));
  EXPECT_FALSE(watch.lost_now(at_seconds(104.9)));
  EXPECT_TRUE(watch.lost_now(at_seconds(105.0)));
  EXPECT_FALSE(watch.lost_now(at_seconds(106.0)));
  EXPECT_TRUE(watch.lost());
  watch.heard(at_seconds(110.0));
  EXPECT_FALSE(watch.lost());
  EXPECT_TRUE(watch.lost_now(at_seconds(115.0)));
  CompanionWatch off{false, std::chrono::seconds{5}};
  off.heard(at_seconds(0.0));
  EXPECT_FALSE(off.lost_now(at_seconds(60.0)));
}

}  // namespace
}  // namespace skein::autopilot
