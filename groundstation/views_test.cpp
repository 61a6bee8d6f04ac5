// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/views.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skein/base/angles.hpp"

namespace skein::groundstation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// 02:13:20 UTC.
constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000 + 14'400'000'000'000;

MissionOrigin origin() {
  return MissionOrigin::make({.latitude_deg = 31.522062, .longitude_deg = 105.044327}).value();
}

mission::FleetEntry heard(double at_s) {
  mission::FleetEntry entry;
  mission::Telemetry telemetry;
  telemetry.activity = mission::Activity::executing;
  telemetry.range_left_m = 12340.0;
  telemetry.loads = 2;
  entry.telemetry = telemetry;
  entry.heard_at = at_seconds(at_s);
  return entry;
}

std::string line_of(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  if (at == std::string::npos) return "";
  const auto begin = text.rfind('\n', at) + 1;
  return text.substr(begin, text.find('\n', at) - begin);
}

TEST(FleetTable, ShowsStateAndHealth) {
  std::map<VehicleId, mission::FleetEntry> fleet;
  fleet[{1}] = heard(9.5);
  fleet[{2}] = {};
  fleet[{3}] = heard(2.0);
  fleet[{3}].silent = true;
  fleet[{4}] = heard(9.5);
  fleet[{4}].duplicate = true;
  for (auto& [vehicle, entry] : fleet) entry.expected = true;
  fleet[{5}] = heard(9.5);
  fleet[{5}].expected = true;
  fleet[{5}].differs = mission::SetupDifference{"origin.latitude_deg", 3.0};
  fleet[{6}] = heard(9.5);
  fleet[{6}].expected = true;
  fleet[{6}].health.emplace().problems = {"the clock is not synchronised"};
  fleet[{9}] = heard(9.5);
  fleet[{9}].telemetry->control_overruns = 7;
  const auto table = fleet_table(fleet, at_seconds(10.0));
  EXPECT_THAT(line_of(table, "good"),
              AllOf(HasSubstr("1  executing"), HasSubstr("0.5 s"), HasSubstr("12.3 km")));
  EXPECT_THAT(line_of(table, "never heard"), HasSubstr("2  -"));
  EXPECT_THAT(line_of(table, "SILENT"), AllOf(HasSubstr("3  silent"), HasSubstr("8.0 s")));
  EXPECT_THAT(line_of(table, "TWO VEHICLES"), HasSubstr("4  executing"));
  EXPECT_THAT(line_of(table, "NOT WORKED WITH"),
              AllOf(HasSubstr("5  executing"), HasSubstr("another origin.latitude_deg"),
                    HasSubstr("a clock that is 3.0 s ahead")));
  EXPECT_THAT(line_of(table, "not synchronised"), HasSubstr("6  executing"));
  EXPECT_THAT(line_of(table, "not in the fleet"),
              AllOf(HasSubstr("9  executing"), HasSubstr("7 control overruns")));
}

mission::PendingAuthorisation request() {
  mission::PendingAuthorisation pending;
  pending.request.round.coalition = {{27}, {5}, 1};
  pending.request.round.number = 2;
  pending.request.site = {3};
  pending.request.site_position = {0.0, -2000.0};
  pending.request.deliveries.push_back(
      {{{{3}, TaskKind::deliver, 0}, {11}, at_seconds(111.2)}, heading_from_compass_deg(45.0)});
  pending.request.decide_by = at_seconds(100.0);
  return pending;
}

TEST(RequestText, SaysWhatWhereWhenWhoUntilWhenAndWhatToType) {
  const auto text =
      request_text(request(), {{{}}, {}, {}, {}, {}}, origin(), kEpoch, at_seconds(88.0));
  EXPECT_THAT(text, HasSubstr("1 delivery at site 3"));
  EXPECT_THAT(text, HasSubstr("2000 m from the origin towards 180 deg"));
  EXPECT_THAT(text, HasSubstr("31.504"));  // 2 km south
  EXPECT_THAT(text, HasSubstr("105.044327 E"));
  EXPECT_THAT(text, HasSubstr("vehicle  11 at 111.2 s (02:15:11 UTC), flying towards 045 deg"));
  EXPECT_THAT(text, HasSubstr("vehicle 27, coalition 1 round 2"));
  EXPECT_THAT(text, HasSubstr("until   100.0 s (02:15:00 UTC), 12 s from now"));
  EXPECT_THAT(text, HasSubstr("authorise 3"));
  EXPECT_THAT(text, HasSubstr("refuse 3"));
}

TEST(PendingText, SaysWhatCanBeTakenBackAndWhatNeedsAnOverride) {
  auto granted = request();
  granted.decision = mission::Authorisation{};
  granted.decision->granted = true;
  granted.decision->decided_by = "ada";
  const auto text = [&](double at_s) {
    return pending_text({granted}, console::Picture{{}}, mission::Fleet{{}}, origin(), kEpoch,
                        at_seconds(at_s));
  };
  EXPECT_THAT(text(88.0), HasSubstr("Authorised at site 3 by ada"));
  EXPECT_THAT(text(88.0), HasSubstr("withdraw decision 3"));
  EXPECT_THAT(text(111.3), HasSubstr("nothing waits"));
  const auto silent =
      request_text(request(), {{{}}, {}, {}, {}, {}, {{11}}}, origin(), kEpoch, at_seconds(88.0));
  EXPECT_THAT(silent, HasSubstr("authorise 3 override"));
}

TEST(PendingText, LeavesOutWhatIsDecidedOrTooLate) {
  EXPECT_THAT(pending_text({request()}, console::Picture{{}}, mission::Fleet{{}}, origin(), kEpoch,
                           at_seconds(88.0)),
              HasSubstr("site 3"));
  EXPECT_THAT(pending_text({request()}, console::Picture{{}}, mission::Fleet{{}}, origin(), kEpoch,
                           at_seconds(100.0)),
              HasSubstr("nothing waits"));
  auto decided = request();
  decided.decision = mission::Authorisation{};
  EXPECT_THAT(pending_text({decided}, console::Picture{{}}, mission::Fleet{{}}, origin(), kEpoch,
                           at_seconds(88.0)),
              HasSubstr("nothing waits"));
}

TEST(SitesText, GathersWhatTheVehiclesTell) {
  console::Picture picture{{}};
  EXPECT_THAT(sites_text(picture), HasSubstr("no site is known"));
  coalition::Announcement announcement;
  announcement.round.coalition.leader = {1};
  announcement.site.id = {1};
  picture.on_message(announcement, {1}, at_seconds(4.0));
  const auto tell = [&](std::uint16_t vehicle, mission::EventKind kind, const TaskId& task) {
    picture.on_event({{vehicle}, at_seconds(5.0), {}, task, mission::body_of(kind)});
  };
  using enum mission::EventKind;
  tell(1, survey_done, {{1}, TaskKind::survey, 0});
  for (std::uint8_t i = 0; i < 8; ++i) tell(2, task_done, {{1}, TaskKind::deliver, i});
  tell(2, task_done, {{1}, TaskKind::deliver, 7});  // said again
  tell(7, task_done, {{1}, TaskKind::assess, 0});
  tell(4, fleet_warning, {});  // concerns no site
  EXPECT_THAT(sites_text(picture),
              HasSubstr("site 1: led by vehicle 1, surveyed, 8 delivered, 1 assessed; 5.0 s"));
}

TEST(SummaryText, SaysWhatIsDoneAndWhereVehiclesWereLeft) {
  console::Picture picture{{}};
  coalition::Announcement announcement;
  announcement.round.coalition.leader = {1};
  announcement.site.id = {1};
  announcement.site.deliveries = {{}, {}};
  announcement.site.assessments = {{}};
  picture.on_message(announcement, {1}, at_seconds(4.0));
  const auto tell = [&](mission::EventKind kind, const TaskId& task) {
    picture.on_event({{1}, at_seconds(5.0), {}, task, mission::body_of(kind)});
  };
  tell(mission::EventKind::task_done, {{1}, TaskKind::deliver, 1});
  mission::Fleet fleet{{.expected = {{1}, {2}, {3}, {4}}}};
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{3}}) {
    mission::Telemetry told;
    told.vehicle = {id};
    told.activity = id == 2 ? mission::Activity::landed : mission::Activity::searching;
    fleet.on_message(told, at_seconds(id == 3 ? 1.0 : 10.0));
  }
  fleet.on_timeout(at_seconds(10.0));
  const auto text = summary_text(picture, fleet);
  EXPECT_THAT(text, HasSubstr("0 of 1 sites done, 1 of 2 deliveries flown, 0 of 1 assessments"));
  EXPECT_THAT(text, HasSubstr("in the air, and fly on without the ground station: 1\n"));
  EXPECT_THAT(text, HasSubstr("on the ground: 2\n"));
  EXPECT_THAT(text, HasSubstr("silent, where they are is not known: 3\n"));
}

}  // namespace
}  // namespace skein::groundstation
