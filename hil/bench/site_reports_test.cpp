// SPDX-License-Identifier: Apache-2.0
#include "site_reports.hpp"

#include <gtest/gtest.h>

namespace skein::hil {
namespace {

constexpr VehicleId kNear{1};
constexpr VehicleId kFar{2};
constexpr SiteId kSite{7};

configuration::Scenario one_site() {
  configuration::Scenario scenario;
  for (const VehicleId id : {kNear, kFar}) {
    configuration::ScenarioVehicle vehicle;
    vehicle.spec.id = id;
    vehicle.spec.sensor_radius_m = 100.0;
    vehicle.spec.capabilities.add(TaskKind::survey);
    scenario.vehicles.push_back(vehicle);
  }
  Site site;
  site.id = kSite;
  scenario.sites.push_back(site);
  return scenario;
}

mission::Telemetry at(double x_m) {
  mission::Telemetry telemetry;
  telemetry.state.x_m = x_m;
  return telemetry;
}

mission::MissionEvent detected(VehicleId vehicle) {
  mission::MissionEvent event;
  event.vehicle = vehicle;
  event.task.site = kSite;
  event.body = mission::event::SiteDetected{};
  return event;
}

TEST(SiteReports, WhatWasSaidToAProgramThatDidNotHearItIsSaidAgain) {
  SiteReports reports{one_site()};
  const SiteReports::Team team{{kNear, at(50.0)}, {kFar, at(5000.0)}};
  ASSERT_EQ(reports.look(team).size(), 1U);
  EXPECT_TRUE(reports.look(team).empty()) << "a sensor sees it once";
  for (int i = 0; i < 2; ++i) {
    const auto again = reports.report_unattended(team);
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(again[0].finder, kNear);
  }
  reports.on_event(detected(kNear));
  EXPECT_TRUE(reports.report_unattended(team).empty());
}

TEST(SiteReports, WhatOnlyOneKnowsWhomItsPilotHasIsSaidToAnother) {
  SiteReports reports{one_site()};
  SiteReports::Team team{{kNear, at(500.0)}, {kFar, at(5000.0)}};
  ASSERT_EQ(reports.report_unattended(team).size(), 1U);
  reports.on_event(detected(kNear));
  EXPECT_TRUE(reports.report_unattended(team).empty());
  team[kNear].activity = mission::Activity::holding;
  const auto again = reports.report_unattended(team);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].finder, kFar);
}

TEST(SiteReports, WhatNobodyKnowsAnyMoreIsFoundAnew) {
  SiteReports reports{one_site()};
  ASSERT_EQ(reports.look({{kNear, at(50.0)}}).size(), 1U);
  reports.on_event(detected(kNear));
  reports.on_program_end(kNear);
  EXPECT_TRUE(reports.look({{kFar, at(5000.0)}}).empty());
  const auto unattended = reports.report_unattended({{kFar, at(5000.0)}});
  ASSERT_EQ(unattended.size(), 1U);
  EXPECT_EQ(unattended[0].finder, kFar);
  EXPECT_EQ(reports.look({{kFar, at(90.0)}}).size(), 1U);
}

}  // namespace
}  // namespace skein::hil
