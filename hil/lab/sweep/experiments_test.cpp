// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "skein/experiments/grid.hpp"
#include "skein/experiments/measures.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/experiments/statistics.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/mission/may_say.hpp"

namespace skein::experiments {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

configuration::Scenario scenario(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  EXPECT_TRUE(loaded) << loaded.error().message;
  return *loaded;
}

configuration::Experiment experiment(const std::string& yaml) {
  auto parsed = configuration::parse_experiment(yaml, "e.yaml");
  EXPECT_TRUE(parsed) << parsed.error().message;
  return *parsed;
}

constexpr auto kTwoAxes = R"(
version: 1
title: Try
scenario: s.yaml
runs: 3
random_team:
  - {west_m: 1000, east_m: 8000, south_m: 1000, north_m: 7000, search_share: 0.4}
settings: {formation_margin_s: 1, vehicles: 24}
axes:
  - name: range
    points:
      - {label: near, radio_range_m: 1000, message_delay_s: 0.2}
      - {label: far, radio_range_m: 2500, message_delay_s: 2}
  - name: method
    points:
      - {label: ours}
      - {label: poly, allocation: polynomial, vehicles: 40}
      - {label: late, formation_margin_s: 3}
)";

TEST(StudentT, IsAsInTheTables) {
  // The two-sided 95 % points that every book prints.
  const std::map<std::size_t, double> table{
      {1, 12.706205}, {2, 4.302653},  {3, 3.182446},  {4, 2.776445},  {9, 2.262157},
      {10, 2.228139}, {29, 2.045230}, {49, 2.009575}, {99, 1.984217}, {1000, 1.962339}};
  for (const auto& [degrees, t] : table) EXPECT_NEAR(student_t_95(degrees), t, 5e-7) << degrees;
}

TEST(Estimates, AreMeanAndInterval) {
  const std::vector<double> values{2.0, 4.0, 4.0, 5.0, 10.0};
  const Estimate e = estimate(values);
  EXPECT_EQ(e.count, 5U);
  EXPECT_NEAR(e.mean, 5.0, 1e-12);
  EXPECT_NEAR(e.deviation, 3.0, 1e-12);  // squares 9 + 1 + 1 + 0 + 25 over 4
  EXPECT_NEAR(e.half_width, 2.776445 * 3.0 / std::sqrt(5.0), 1e-5);
}

TEST(Estimates, OfOneValueHaveNoIntervalAndOfNoneNoMean) {
  EXPECT_EQ(estimate({}).count, 0U);
  const std::vector<double> one{7.0};
  EXPECT_EQ(estimate(one).mean, 7.0);
  EXPECT_EQ(estimate(one).half_width, 0.0);
}

TEST(Grid, HasEveryCombinationAndTheLastAxisChangesFastest) {
  const auto e = experiment(kTwoAxes);
  const auto cells = cells_of(e);
  ASSERT_EQ(cells.size(), 6U);
  EXPECT_THAT(labels(e, cells[0]), ElementsAre("near", "ours"));
  EXPECT_THAT(labels(e, cells[1]), ElementsAre("near", "poly"));
  EXPECT_THAT(labels(e, cells[5]), ElementsAre("far", "late"));
}

TEST(Grid, APointGoesBeforeTheSettingsAndThoseBeforeTheScenario) {
  const auto e = experiment(kTwoAxes);
  const auto base = scenario("coalition-32");
  const auto first = scenario_of(e, base, {{1, 0}}, 1);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->vehicles.size(), 24U);
  EXPECT_EQ(first->protocol.margin, from_seconds(1.0));
  EXPECT_EQ(first->protocol.radio_range_m, 2500.0);
  EXPECT_EQ(first->radio.range_m, 2500.0);
  EXPECT_EQ(first->protocol.message_delay, from_seconds(2.0));
  EXPECT_EQ(first->radio.delay_mean + first->radio.delay_jitter, from_seconds(2.0));
  EXPECT_EQ(first->radio.delay_mean - first->radio.delay_jitter, Duration{});
  EXPECT_EQ(first->planning.method, base.planning.method);
  EXPECT_EQ(first->protocol.lease, base.protocol.lease);
  const auto second = scenario_of(e, base, {{0, 1}}, 1);
  EXPECT_EQ(second->vehicles.size(), 40U);
  EXPECT_EQ(second->planning.method, planning::AllocationMethod::polynomial);
  EXPECT_EQ(scenario_of(e, base, {{0, 2}}, 1)->protocol.margin, from_seconds(3.0));
}

TEST(Grid, SaysWhatCannotBeFlownAndWhere) {
  const auto base = scenario("coalition-32");
  auto fixed_fleet = experiment(kTwoAxes);
  fixed_fleet.team.reset();
  const auto no_team = scenario_of(fixed_fleet, base, {{0, 0}}, 1);
  ASSERT_FALSE(no_team);
  EXPECT_THAT(no_team.error().message, HasSubstr("range near, method ours"));
  EXPECT_THAT(no_team.error().message, HasSubstr("add random_team"));

  auto small = experiment(kTwoAxes);
  small.settings.vehicles = std::uint16_t{3};
  const auto too_few = scenario_of(small, base, {{0, 0}}, 1);
  ASSERT_FALSE(too_few);
  EXPECT_THAT(too_few.error().message, HasSubstr("site 1 needs 8 deliveries"));

  auto nowhere = experiment(kTwoAxes);
  nowhere.reported_sites.push_back({SiteId{9}, {}});
  const auto unknown = scenario_of(nowhere, base, {{0, 0}}, 1);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("names site 9"));
}

TEST(RandomTeams, KeepTheSharesOfKindsAndTheArea) {
  const auto e = experiment(kTwoAxes);
  const auto base = scenario("coalition-32");
  const auto kinds = [](const std::vector<configuration::ScenarioVehicle>& vehicles) {
    std::map<std::string, int> count;
    for (const auto& v : vehicles) ++count[v.type];
    return count;
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto team = draw_team(*e.team, base, 32, seed);
    EXPECT_EQ(kinds(team), kinds(base.vehicles)) << seed;
    std::set<double> heights;
    for (const auto& v : team) {
      EXPECT_GE(v.start.x_m, 1000.0);
      EXPECT_LE(v.start.x_m, 8000.0);
      EXPECT_GE(v.start.y_m, 1000.0);
      EXPECT_LE(v.start.y_m, 7000.0);
      heights.insert(v.spec.height_m);
      double route_m = 0.0;
      Vec2 from = v.start.position();
      for (const Vec2& point : v.search) {
        route_m += (point - from).norm();
        from = point;
        const bool near = std::any_of(base.sites.begin(), base.sites.end(), [&](const Site& s) {
          return (point - s.position).norm() <= e.team->search_radius_m;
        });
        EXPECT_TRUE(near);
      }
      EXPECT_LE(route_m, 0.4 * v.spec.range_m);
    }
    EXPECT_EQ(heights.size(), team.size());
    EXPECT_TRUE(scenario_of(e, base, {{0, 1}}, seed)) << seed;
  }
}

TEST(RandomTeams, OfOneSeedBeginAlike) {
  const auto e = experiment(kTwoAxes);
  const auto base = scenario("coalition-32");
  const auto small = draw_team(*e.team, base, 24, 5);
  const auto large = draw_team(*e.team, base, 56, 5);
  const auto other = draw_team(*e.team, base, 24, 6);
  ASSERT_EQ(large.size(), 56U);
  bool differs = false;
  for (std::size_t i = 0; i < small.size(); ++i) {
    EXPECT_EQ(small[i].type, large[i].type);
    EXPECT_EQ(small[i].start.x_m, large[i].start.x_m);
    EXPECT_EQ(small[i].start.heading_rad, large[i].start.heading_rad);
    EXPECT_EQ(small[i].search.size(), large[i].search.size());
    differs = differs || small[i].start.x_m != other[i].start.x_m;
  }
  EXPECT_TRUE(differs);
}

constexpr auto kThousand = R"(
version: 1
title: A thousand
scenario: s.yaml
runs: 1
duration_max_s: 100
random_team:
  - {west_m: -10000, east_m: 18000, south_m: -10000, north_m: 18000, search_share: 0.4}
settings: {vehicles: 1000}
axes: [{name: team, points: [{label: all}]}]
)";

TEST(RandomTeams, OfAThousandIsAScenario) {
  const auto drawn = scenario_of(experiment(kThousand), scenario("coalition-32"), {}, 1);
  ASSERT_TRUE(drawn) << drawn.error().message;
  std::set<VehicleId> ids;
  for (const auto& v : drawn->vehicles) ids.insert(v.spec.id);
  EXPECT_EQ(ids.size(), 1000U);
  EXPECT_FALSE(ids.contains(mission::kSensors));
  const auto file = std::filesystem::path{::testing::TempDir()} / "a-thousand.yaml";
  std::ofstream{file} << to_yaml(*drawn);
  const auto read = configuration::load_flyable_scenario(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->vehicles.size(), 1000U);
}

TEST(RandomTeams, OfAThousandFliesItsMissionAndBreaksNoRule) {
  const auto base = scenario("coalition-32");
  const auto mission = mission_of(experiment(kThousand), base, {}, 1);
  ASSERT_TRUE(mission) << mission.error().message;
  const Measures m = measure(*mission, hil::limits_of(base.expect));
  EXPECT_TRUE(m.safe);
  EXPECT_GE(m.coalitions, 2.0);
}

TEST(MeasuresOfAMission, AreWhatWasFlown) {
  const auto base = scenario("coalition-6");
  const auto mission = hil::team_mission(base);
  const Measures m = measure(mission, hil::limits_of(base.expect));
  EXPECT_TRUE(m.safe);
  EXPECT_EQ(m.tasks, 6.0);  // a survey, three deliveries, two assessments
  EXPECT_EQ(m.tasks_done, 6.0);
  EXPECT_EQ(m.coalitions, 1.0);
  ASSERT_TRUE(m.mission_s);
  EXPECT_EQ(m.mission_s, m.last_done_s);
  ASSERT_EQ(m.formed_s.size(), 1U);
  EXPECT_LT(m.formed_s.begin()->second, *m.mission_s);

  const auto& v = m.value;
  const double sum = 6.0 * mission.sites.front().reward;
  const double beta = mission.sites.front().reward_decay_per_s;
  EXPECT_LE(v.reward, sum);
  EXPECT_GE(v.reward, sum * std::exp(-beta * *m.mission_s));
  EXPECT_NEAR(v.reward_share, v.reward / sum, 1e-12);
  double range_m = 0.0;
  for (const auto& vehicle : mission.vehicles) range_m += vehicle.spec.range_m;
  EXPECT_NEAR(v.range_share, v.range_left_m / range_m, 1e-12);
  // Flown, not planned: no delivery is on time to the nanosecond, and none is a second late.
  EXPECT_GT(v.timing_error_s, 1e-3);
  EXPECT_LT(v.timing_error_s, 5.0);
  EXPECT_NEAR(v.total, v.reward_share + v.range_share - 0.2 * v.timing_share, 1e-12);
}

TEST(MeasuresOfAMission, OfWhatIsNotDoneHaveNoReward) {
  auto base = scenario("coalition-6");
  base.operator_decisions.front().grant = false;
  const Measures m = measure(hil::team_mission(base), hil::limits_of(base.expect));
  EXPECT_EQ(m.tasks_done, 1.0);  // the survey
  EXPECT_FALSE(m.mission_s);
  EXPECT_EQ(m.value.timing_error_s, 0.0);
  EXPECT_LE(m.value.reward_share, 1.0 / 6.0);
}

TEST(Plots, HaveAnIntervalForEachValueAndNoneWhereThereIsNoValue) {
  Plot plot{"A & B",
            "x",
            "y",
            {"1", "2"},
            {{"one", {{3, 1.0, 0.1, 0.2}, {}}}, {"two", {{3, 2.0, 0.1, 0.2}, {3, 3.0, 0.1, 0.2}}}}};
  for (const bool bars : {false, true}) {
    const std::string picture = svg(plot, bars);
    std::size_t intervals = 0;
    for (auto at = picture.find("class=\"error\""); at != std::string::npos;
         at = picture.find("class=\"error\"", at + 1)) {
      ++intervals;
    }
    EXPECT_EQ(intervals, 3U);
    EXPECT_THAT(picture, HasSubstr("A &amp; B"));
    EXPECT_EQ(picture.find("nan"), std::string::npos);
  }
}

TEST(Plots, OfMeansThatDifferByRoundingAreDrawn) {
  const double next = std::nextafter(1.0, 2.0);
  const Plot plot{"A", "x", "y", {"1", "2"}, {{"one", {{3, 1.0, 0.0, 0.0}, {3, next, 0.0, 0.0}}}}};
  EXPECT_THAT(svg(plot, false), HasSubstr(">1</text>"));
}

TEST(Plots, LongLabelsAreSlanted) {
  const std::vector<std::string> many(12, "intermittency");
  const Plot plot{"A", "x", "y", many, {{"one", std::vector<Estimate>(12, {1, 1.0, 0.0, 0.0})}}};
  EXPECT_THAT(svg(plot, true), HasSubstr("rotate"));
  const Plot few{"A", "x", "y", {"1"}, {{"one", {{1, 1.0, 0.0, 0.0}}}}};
  EXPECT_EQ(svg(few, true).find("rotate"), std::string::npos);
}

TEST(Plots, LinesKeepTheirCornersAndNames) {
  const LinePlot plot{
      "A",
      "x",
      "y",
      {{"P & Q", {{0, 0}, {5, 1}, {10, 0}}}, {"none", {}}, {"R", {{0, 2}, {10, 2}}}}};
  const std::string picture = svg(plot);
  EXPECT_THAT(picture, HasSubstr("P &amp; Q"));
  EXPECT_THAT(picture, HasSubstr("class=\"line c2\""));
  EXPECT_THAT(picture, HasSubstr("62.0,"));   // from the left edge
  EXPECT_THAT(picture, HasSubstr("276.0,"));  // the corner in the middle
  EXPECT_EQ(picture.find("nan"), std::string::npos);
  EXPECT_EQ(svg(LinePlot{"A", "x", "y", {}}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace skein::experiments
