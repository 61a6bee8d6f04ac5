// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_sites.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

struct GroundSitesTest : ::testing::Test {
  /// A vehicle that can survey, at that place on the east axis, is heard.
  void hear(std::uint16_t vehicle, double east_m, Activity activity = Activity::searching,
            std::uint64_t instance = 1) {
    Telemetry t;
    t.vehicle = {vehicle};
    t.instance = {instance};
    t.state.time = now;
    t.state.x_m = east_m;
    t.activity = activity;
    t.range_left_m = 20'000.0;
    t.capabilities = Capabilities{}.add(TaskKind::survey);
    heard[{vehicle}] = t;
    fleet.on_message(Message{t}, now);
  }
  void run_until(double seconds) {
    while (now < at_seconds(seconds)) {
      now += std::chrono::milliseconds{500};
      for (auto& [vehicle, t] : heard) {
        if (silent.contains(vehicle)) continue;
        t.state.time = now;
        fleet.on_message(Message{t}, now);
      }
      fleet.on_timeout(now);
      sites.on_timeout(fleet, now);
    }
  }
  void event(std::uint16_t vehicle, SiteId site, EventBody body, TaskKind kind = TaskKind::survey) {
    sites.on_message(Message{MissionEvent{{vehicle}, now, {}, {site, kind, 0}, std::move(body)}},
                     now);
  }
  void is_announced(const Site& site) {
    coalition::Announcement announcement;
    announcement.round = {{{7}, {1}, 1}, 1};
    announcement.site = site;
    sites.on_message(Message{coalition::Message{announcement}}, now);
  }
  std::vector<SiteReport> said() {
    std::vector<SiteReport> all;
    while (const auto message = sites.poll_message()) {
      all.push_back(std::get<SiteReport>(*message));
      record.push_back(*message);
    }
    return all;
  }
  SiteId add(double east_m) {
    Site site = test_site(0);
    site.position = {east_m, 0.0};
    return sites.add(site, std::nullopt, fleet, now).value();
  }
  [[nodiscard]] const GroundSite& at(SiteId id) const { return sites.sites().at(id); }

  Instant now = at_seconds(100.0);
  Fleet fleet{{.expected = {{1}, {2}, {3}}}};
  GroundSites sites;
  std::map<VehicleId, Telemetry> heard;
  std::set<VehicleId> silent;
  std::vector<Message> record;
};

TEST_F(GroundSitesTest, TellsTheNearestThatCanSurveyUntilItTakesTheSiteUp) {
  hear(1, 5000.0);
  hear(2, 900.0);
  hear(3, 1000.0, Activity::executing);
  const SiteId id = add(1000.0);
  EXPECT_EQ(id, SiteId{10'100});
  run_until(105.0);
  auto told = said();
  ASSERT_GE(told.size(), 2U);
  for (const auto& report : told) {
    EXPECT_EQ(report.finder, VehicleId{2}) << "3 is nearer, and has something else to do";
    EXPECT_FALSE(report.withdrawn);
  }
  event(2, id, event::SiteDetected{});
  run_until(130.0);
  EXPECT_TRUE(said().empty());
  EXPECT_EQ(at(id).state, SiteState::taken_up);
  EXPECT_NE(add(3000.0), id);
}

TEST_F(GroundSitesTest, TellsAnotherWhereTheFirstDoesNotAnswerCannotOrIsLost) {
  hear(1, 0.0);
  hear(2, 2000.0);
  const SiteId id = add(100.0);
  run_until(112.0);
  EXPECT_EQ(at(id).surveyor, VehicleId{2}) << "1 has not answered";
  event(2, id, event::SiteDetected{});
  event(2, id, event::TaskFailed{event::TaskFailure::no_plan, {}, ""});
  run_until(113.0);
  EXPECT_NE(at(id).surveyor, std::nullopt) << "all were tried: the first is tried again";
  event(1, id, event::SiteDetected{});
  silent.insert({1});
  run_until(125.0);
  EXPECT_EQ(at(id).surveyor, VehicleId{2}) << "1 fell silent before anybody led the site";
  event(2, id, event::SiteDetected{});
  (void)said();
  heard.at({2}).instance = {8};
  run_until(127.0);
  EXPECT_FALSE(said().empty()) << "it has started anew and remembers nothing";
}

TEST_F(GroundSitesTest, CaresNoMoreForWhatIsLedUnlessEverybodyHasForgottenIt) {
  hear(1, 0.0);
  const SiteId id = add(100.0);
  is_announced(at(id).site);
  (void)said();
  run_until(200.0);
  EXPECT_TRUE(said().empty());
  run_until(260.0);
  EXPECT_FALSE(said().empty()) << "nobody has said for long that it is led";
}

TEST_F(GroundSitesTest, WhatWaitsIsSaidOnceAndNotLostWithTheProcess) {
  const SiteId id = add(1000.0);
  run_until(110.0);
  const auto first = said();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].finder, VehicleId{});
  EXPECT_FALSE(first[0].withdrawn);
  sites = {};
  for (const Message& message : record) sites.recall(message, kGroundStation, at_seconds(100.0));
  EXPECT_EQ(at(id).state, SiteState::waits);
  hear(1, 500.0);
  run_until(112.0);
  EXPECT_EQ(at(id).state, SiteState::told);
  EXPECT_EQ(at(id).surveyor, VehicleId{1});
}

TEST_F(GroundSitesTest, WaitsForSomebodyWhoCan) {
  hear(1, 0.0, Activity::holding);
  const SiteId id = add(100.0);
  EXPECT_EQ(at(id).state, SiteState::waits);
  run_until(110.0);
  for (const SiteReport& report : said()) EXPECT_EQ(report.finder, VehicleId{});
  EXPECT_FALSE(sites.add(test_site(0), VehicleId{1}, fleet, now).ok()) << "held by the operator";
  hear(1, 0.0, Activity::searching);
  run_until(112.0);
  EXPECT_FALSE(said().empty());
}

TEST_F(GroundSitesTest, WhatIsWithdrawnIsToldToAllAlsoAfterANewStart) {
  hear(1, 0.0);
  const SiteId id = add(100.0);
  is_announced(test_site(5));
  event(1, {5}, event::TaskStarted{}, TaskKind::deliver);
  (void)said();
  ASSERT_TRUE(sites.withdraw(id, "ada", now).ok());
  const auto flown_on = sites.withdraw({5}, "ada", now);  // one that sensors found
  ASSERT_TRUE(flown_on.ok());
  EXPECT_EQ(*flown_on, (std::vector<TaskId>{{{5}, TaskKind::deliver, 0}})) << "it has begun";
  EXPECT_THAT(sites.withdraw(id, "ada", now).error().message, HasSubstr("already"));
  EXPECT_FALSE(sites.withdraw({77}, "ada", now).ok());
  run_until(120.0);
  const auto told = said();
  EXPECT_GE(told.size(), 6U);
  for (const auto& report : told) {
    EXPECT_TRUE(report.withdrawn);
    EXPECT_EQ(report.finder, VehicleId{}) << "a release that does not know this takes up nothing";
  }

  GroundSites after;
  for (const Message& message : record) after.recall(message, kGroundStation, at_seconds(121.0));
  EXPECT_TRUE(after.is_withdrawn(id));
  after.on_timeout(fleet, at_seconds(130.0));
  int again = 0;
  while (const auto message = after.poll_message()) {
    again += std::get<SiteReport>(*message).withdrawn ? 1 : 0;
  }
  EXPECT_EQ(again, 2);
  EXPECT_NE(after.add(test_site(0), std::nullopt, fleet, at_seconds(100.0)).value(), id);
}

TEST_F(GroundSitesTest, ANewProcessGoesOnWithWhatNobodyHadTakenUp) {
  hear(1, 0.0);
  const SiteId id = add(100.0);
  (void)said();
  GroundSites after;
  for (const Message& message : record) after.recall(message, kGroundStation, now);
  EXPECT_FALSE(after.poll_message());
  after.on_timeout(fleet, now + std::chrono::seconds{1});
  const auto message = after.poll_message();
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<SiteReport>(*message).site.id, id);
}

TEST_F(GroundSitesTest, AChangedSiteIsANewOneUntilADeliveryIsAuthorised) {
  hear(1, 0.0);
  const SiteId id = add(100.0);
  Site other = test_site(0);
  other.position = {300.0, 0.0};
  const auto changed = sites.change(id, other, std::nullopt, fleet, "ada", now);
  ASSERT_TRUE(changed.ok());
  EXPECT_NE(*changed, id);
  EXPECT_TRUE(sites.is_withdrawn(id));
  sites.on_granted(*changed);
  EXPECT_THAT(sites.change(*changed, other, std::nullopt, fleet, "ada", now).error().message,
              HasSubstr("withdraw it"));
  EXPECT_FALSE(sites.is_withdrawn(*changed));
}

TEST_F(GroundSitesTest, KnowsWhichSiteIsAtAPlace) {
  hear(1, 0.0);
  const SiteId near = add(100.0);
  const SiteId nearer = add(110.0);
  ASSERT_NE(sites.open_near({112.0, 0.0}, 30.0), nullptr);
  EXPECT_EQ(sites.open_near({112.0, 0.0}, 30.0)->site.id, nearer);
  ASSERT_TRUE(sites.withdraw(nearer, "ada", now).ok());
  EXPECT_EQ(sites.open_near({112.0, 0.0}, 30.0)->site.id, near);
  EXPECT_EQ(sites.open_near({200.0, 0.0}, 30.0), nullptr);
}

}  // namespace
}  // namespace skein::mission
