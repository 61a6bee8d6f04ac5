// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/site_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "skein/base/angles.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

configuration::GroundConfig config() {
  const auto parsed = configuration::parse_ground_config(R"(
version: 1
origin: {latitude_deg: 59.0, longitude_deg: 17.0}
vehicles: [1, 2]
network: {port: 7410}
time: {epoch_unix_ns: 1700000000000000000}
site_templates:
  - name: fire
    survey: {dwell_s: 4}
    deliveries: {mode: sequential, interval_s: 3, bearings_deg: [10, 20]}
    assessments: {count: 1, wait_s: 2, dwell_s: 7}
    reward: 5
detections: {same_site_m: 40}
)",
                                                         "ground.yaml");
  EXPECT_TRUE(parsed.ok()) << (parsed ? "" : parsed.error().message);
  return parsed ? *parsed : configuration::GroundConfig{};
}

class SiteDeskTest : public ::testing::Test {
 protected:
  SiteDeskTest() {
    mission::Telemetry t;
    t.vehicle = {2};
    t.instance = {1};
    t.range_left_m = 20'000.0;
    t.capabilities = Capabilities{}.add(TaskKind::survey);
    node_.on_message(mission::Message{t}, {2}, at_seconds(1.0));
  }
  Answer order(const std::string& line) {
    const auto input = parse_input(line);
    EXPECT_TRUE(input.ok()) << line << ": " << (input ? "" : input.error().message);
    if (const auto* site = std::get_if<NewSite>(&*input)) return desk_.answer(*site, "ada", now_);
    if (const auto* gone = std::get_if<WithdrawSite>(&*input)) {
      return desk_.answer(*gone, "ada", now_);
    }
    if (const auto* answer = std::get_if<ProposalAnswer>(&*input)) {
      return desk_.answer(*answer, "ada", now_);
    }
    return desk_.answer(std::get<SitesFromFile>(*input), now_);
  }
  /// The newest report of a site that is said.
  Site said() {
    Site site;
    while (const auto message = node_.poll_message()) {
      const auto* report = std::get_if<mission::SiteReport>(&*message);
      if (report != nullptr && !report->withdrawn) site = report->site;
    }
    return site;
  }

  Instant now_ = at_seconds(2.0);
  configuration::GroundConfig config_ = config();
  mission::GroundNode node_{{.agent = {.expected = {{1}, {2}}, .decisions = {}},
                             .formation = {},
                             .detections = detections_config(config_)},
                            Instant{}};
  SiteDesk desk_{config_, *MissionOrigin::make(config_.origin), node_};
};

TEST_F(SiteDeskTest, TellsWhatIsAskedFor) {
  const Answer told =
      order("site 100 -200 deliver 090,180 every 4 assess 2 wait 3 dwell 8 reward 3");
  EXPECT_TRUE(told.done) << told.text;
  EXPECT_THAT(told.text, HasSubstr("site 10002, told to vehicle 2"));
  EXPECT_THAT(told.text,
              HasSubstr("deliveries towards 090 deg, 180 deg, one every 4 s; 2 assessments"));
  const Site site = said();
  EXPECT_EQ(site.id, SiteId{10'002});
  EXPECT_EQ(site.position, (Vec2{100.0, -200.0}));
  ASSERT_EQ(site.deliveries.size(), 2U);
  EXPECT_NEAR(site.deliveries[0].bearing_rad, heading_from_compass_deg(90.0), 1e-12);
  EXPECT_EQ(site.deliveries[1].offset, std::chrono::seconds{4});
  ASSERT_EQ(site.assessments.size(), 2U);
  EXPECT_EQ(site.assessments[1].dwell, std::chrono::seconds{8});
  EXPECT_EQ(site.assess_wait, std::chrono::seconds{3});
  EXPECT_EQ(site.reward, 3.0);
  EXPECT_GT(site.survey.dwell, Duration{});
}

TEST_F(SiteDeskTest, TakesLatitudesTemplatesAndWhatIsToBeOtherwise) {
  EXPECT_TRUE(order("site like fire at 59.01N 17.0E reward 9 simultaneous").done);
  const Site site = said();
  EXPECT_NEAR(site.position.x(), 0.0, 1.0);
  EXPECT_NEAR(site.position.y(), 1114.0, 5.0);
  EXPECT_EQ(site.deliveries.size(), 2U);
  EXPECT_EQ(site.deliveries[1].offset, Duration{});
  EXPECT_EQ(site.assessments.size(), 1U);
  EXPECT_EQ(site.reward, 9.0);
  EXPECT_THAT(order("site like flood at 0 0").text, HasSubstr("site_templates has fire"));
  EXPECT_THAT(order("site 59.0N 99.0E").text, HasSubstr("km from the mission's origin"));
}

TEST_F(SiteDeskTest, OnePlaceIsOneSiteUnlessTheOperatorInsists) {
  EXPECT_TRUE(order("site 100 0").done);
  const Answer twice = order("site 130 0");
  EXPECT_FALSE(twice.done);
  EXPECT_THAT(twice.text, HasSubstr("site 10002 is 30 m from there"));
  EXPECT_TRUE(order("site 130 0 anyway").done);
  EXPECT_TRUE(order("site 200 0").done);
}

TEST_F(SiteDeskTest, WhatLooksLikeDegreesIsNotTakenForMetres) {
  const Answer degrees = order("site 59.001 17.002");
  EXPECT_FALSE(degrees.done);
  EXPECT_THAT(degrees.text, HasSubstr("59.001N 17.002E"));
  EXPECT_TRUE(order("site 59.001 17.002 anyway").done);
  EXPECT_TRUE(order("site 159.5 17.5").done);
}

TEST_F(SiteDeskTest, APlaceInsideAHazardIsForTheOperatorToInsistOn) {
  ASSERT_TRUE(node_.hazards().add({100.0, 0.0}, 50.0, now_).ok());
  EXPECT_THAT(order("site 120 0").text, HasSubstr("inside hazard 10002"));
  EXPECT_TRUE(order("site 120 0 anyway").done);
}

TEST_F(SiteDeskTest, SaysWhyNobodyIsTold) {
  mission::Telemetry held;
  held.vehicle = {2};
  held.instance = {1};
  held.range_left_m = 20'000.0;
  held.capabilities = Capabilities{}.add(TaskKind::survey);
  held.activity = mission::Activity::holding;
  node_.on_message(mission::Message{held}, {2}, at_seconds(1.5));
  EXPECT_THAT(order("site 100 0").text, HasSubstr("the vehicles that can survey hold"));
  EXPECT_THAT(order("preview site 100 500").text, HasSubstr("the vehicles that can survey hold"));
}

TEST_F(SiteDeskTest, APreviewTellsNobody) {
  const Answer shown = order("preview site 100 0 deliver 45");
  EXPECT_TRUE(shown.done);
  EXPECT_THAT(shown.text, HasSubstr("vehicle 2 would survey it"));
  EXPECT_EQ(said().id, SiteId{});
  EXPECT_TRUE(node_.sites().sites().empty());
}

TEST_F(SiteDeskTest, ChangesAndWithdraws) {
  EXPECT_TRUE(order("site like fire at 100 0").done);
  const Answer changed = order("change site 10002 at 110 0 reward 2");
  EXPECT_TRUE(changed.done) << changed.text;
  EXPECT_THAT(changed.text, HasSubstr("in place of site 10002"));
  const Site site = said();
  EXPECT_EQ(site.position.x(), 110.0);
  EXPECT_EQ(site.reward, 2.0);
  EXPECT_EQ(site.deliveries.size(), 2U) << "the rest is as it was";
  EXPECT_TRUE(node_.sites().is_withdrawn({10'002}));
  EXPECT_TRUE(order("withdraw site 10003").done);
  EXPECT_FALSE(order("withdraw site 10003").done);
  EXPECT_FALSE(order("change site 10003 reward 3").done);
  EXPECT_FALSE(order("change site 77 reward 3").done);
}

TEST_F(SiteDeskTest, ReadsAFileOfSites) {
  const auto file = std::filesystem::path{::testing::TempDir()} / "site_desk_sites.yaml";
  std::ofstream{file} << "version: 1\nsites:\n"
                         "  - {east_m: 100, north_m: 0, survey: {dwell_s: 5}}\n"
                         "  - {east_m: 110, north_m: 0, survey: {dwell_s: 5}}\n"
                         "  - {east_m: 300, north_m: 0, survey: {dwell_s: 5}, reward: 2}\n";
  const Answer told = order("sites " + file.string());
  EXPECT_FALSE(told.done) << "two of them are at one place";
  EXPECT_THAT(told.text, HasSubstr("site 10002, told"));
  EXPECT_THAT(told.text, HasSubstr("not the one at 110 m east, 0 m north"));
  EXPECT_THAT(told.text, HasSubstr("site 10003, told"));
  EXPECT_FALSE(order("sites nowhere.yaml").done);
}

TEST_F(SiteDeskTest, WhatADetectorHasSeenIsProposedAndTakenAsItsTemplateHasIt) {
  EXPECT_THAT(desk_.proposals_text(), HasSubstr("nothing"));
  mission::Detection seen;
  seen.vehicle = {2};
  seen.number = 1;
  seen.position = {500.0, 0.0};
  seen.confidence = 0.9;
  seen.detector = "thermal";
  node_.on_message(mission::Message{seen}, {2}, now_);
  EXPECT_THAT(desk_.proposals_text(), HasSubstr("proposal 1: fire, 90 %, thermal of vehicle 2"));
  EXPECT_TRUE(order("accept 1").done);
  EXPECT_EQ(said().deliveries.size(), 2U);
  EXPECT_FALSE(order("dismiss 1").done);
}

}  // namespace
}  // namespace skein::groundstation
