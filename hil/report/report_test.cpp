// SPDX-License-Identifier: Apache-2.0
#include "skein/report/report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "skein/report/drawing.hpp"
#include "story.hpp"

namespace skein::report {
namespace {

using mission::event::BidSent;
using mission::event::CoalitionFormed;
using mission::event::LeaseGranted;
using mission::event::SurveyDone;
using mission::event::SurveyStarted;
using mission::event::TaskDone;
using mission::event::TaskStarted;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

mission::MissionEvent event(VehicleId vehicle, double time_s, mission::EventBody body,
                            const TaskId& task) {
  return {
      vehicle, at_seconds(time_s), {{VehicleId{1}, InstanceId{5}, 1}, 1}, task, std::move(body)};
}

/// Vehicle 1 surveys and leads; vehicle 12 delivers eastward over the site at the origin at 60 s.
Contents small_contents() {
  Contents contents;
  contents.title = "Two & a <site>";
  contents.summary = "seed 1";
  contents.replay = "skein-ground replay runs/<mine>";
  contents.replay_url = "http://127.0.0.1:7460/";
  contents.run = "<mine>";
  Site site;
  site.id = SiteId{3};
  site.deliveries = {{0.0, Duration{}}};
  contents.record.sites = {site};
  contents.record.hazards = {{{HazardId{4}, {500.0, 900.0}, 120.0}, Instant{}}};
  for (const unsigned number : {1U, 12U}) {
    VehicleSpec vehicle;
    vehicle.id = VehicleId{static_cast<std::uint16_t>(number)};
    contents.record.vehicles.push_back(vehicle);
    recording::Recording recorded;
    recorded.vehicle = vehicle.id;
    for (int i = 0; i <= 2000; ++i) {
      const double t = 0.05 * i;
      recording::TrackPoint point;
      point.state.time = at_seconds(t);
      point.state.x_m = number == 1U ? 300.0 * std::cos(t / 6.0) : 50.0 * (t - 60.2);
      point.state.y_m = number == 1U ? 300.0 * std::sin(t / 6.0) : 4.0;
      recorded.track.push_back(point);
    }
    contents.record.recordings.push_back(recorded);
  }
  const TaskId survey{site.id, TaskKind::survey, 0};
  const TaskId delivery{site.id, TaskKind::deliver, 0};
  const VehicleId leader{1};
  const VehicleId member{12};
  contents.record.recordings[0].events = {
      event(leader, 5.0, SurveyStarted{at_seconds(5.0)}, survey),
      event(leader, 25.0, SurveyDone{at_seconds(5.0)}, survey),
      event(leader, 27.0, CoalitionFormed{}, survey)};
  contents.record.recordings[1].events = {
      event(member, 25.2, BidSent{}, delivery),
      event(member, 27.0, LeaseGranted{at_seconds(90.0)}, delivery),
      event(member, 54.0, TaskStarted{}, delivery),
      event(member, 60.2, TaskDone{at_seconds(60.0)}, delivery)};
  contents.checks = {{"turn radius", "none tighter", 4, "plans", "101 %", {}}};
  contents.checks.front().moment = at_seconds(31.26);
  contents.comparison = {{site.id, "survey done", "25.00 s", "43.92 s"}};
  return contents;
}

/// The first fault in the nesting of tags; empty when there is none.
std::string fault_of_tags(std::string text) {
  // A script is no markup.
  if (const std::size_t script = text.find("<script>"); script != std::string::npos) {
    text.erase(script, text.find("</script>") + 9 - script);
  }
  static const std::set<std::string> never_closed{"meta", "br", "hr", "!DOCTYPE", "?xml"};
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return "a tag without end";
    const bool closing = text[at + 1] == '/';
    const std::size_t name_at = at + (closing ? 2 : 1);
    const std::string name = text.substr(name_at, text.find_first_of(" />\n", name_at) - name_at);
    if (never_closed.contains(name) || text[end - 1] == '/') continue;
    if (!closing) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : "<" + open.back() + ">");
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is never closed";
}

TEST(Report, ThePageIsWellFormedAndNeedsNothingElse) {
  const std::string page = html(small_contents());
  EXPECT_EQ(fault_of_tags(page), "");
  for (const char* outside :
       {" src=", "<link", "@import", "url(h", "fetch(", "XMLHttpRequest", "import("}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
  // It may ask nobody, and leads to this machine alone.
  EXPECT_THAT(page, HasSubstr("content=\"default-src 'none'; "));
  for (std::size_t at = page.find("href="); at != std::string::npos;
       at = page.find("href=", at + 1)) {
    EXPECT_EQ(page.substr(at, 28), "href=\"http://127.0.0.1:7460/");
  }
  EXPECT_THAT(page, HasSubstr("<code>skein-ground replay runs/&lt;mine&gt;</code>"));
  EXPECT_THAT(page, HasSubstr("Two &amp; a &lt;site&gt;"));
  EXPECT_THAT(page, HasSubstr("43.92 s"));
}

TEST(Report, ThePageShowsEveryVehicleSiteAndHazard) {
  const std::string page = html(small_contents());
  for (const char* shown :
       {"vehicle 1, working for site 3", "vehicle 12, working for site 3", "vehicle 12, searching",
        "vehicle 12: delivering, site 3, 54.0 s to 60.2 s", "hazard 4, radius 120 m",
        "vehicle 12 passes at 60.20 s, planned 60.00 s", ">site 3</text>"}) {
    EXPECT_THAT(page, HasSubstr(shown));
  }
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Report, EveryCheckHasALinkToItsMomentInTheReplay) {
  Contents contents = small_contents();
  contents.checks.push_back({"loads", "no more than carried", 2, "vehicles", "1 used", {}});
  contents.checks.push_back({"separation", "never below", 1, "pairs", "9 m", {}});
  contents.checks.back().moment = at_seconds(12.0);
  contents.checks.back().violations = {{VehicleId{1}, at_seconds(60.2), "1 and 12 came near"}};
  const std::string page = html(contents);
  // The worst figure; the beginning, where there is nothing else; the violation, twice.
  for (const auto& [moment, times] :
       {std::pair{"31.3", 1U}, std::pair{"0.0", 1U}, std::pair{"60.2", 2U}}) {
    EXPECT_EQ(count_of(page, fmt::format(
                                 "href=\"http://127.0.0.1:7460/#seek={0}&amp;of=%3Cmine%3E\" "
                                 "data-command=\"skein-ground replay runs/&lt;mine&gt; --at {0}\"",
                                 moment)),
              times)
        << moment;
  }
  contents.replay.clear();
  EXPECT_THAT(html(contents), Not(HasSubstr("href=")));
}

TEST(Report, PlotsTellTheirScalesAndWhoseTheirSeriesAre) {
  const std::string page = html(small_contents());
  EXPECT_THAT(page, HasSubstr("data-series=\"site 3|vehicle 12\""));
  EXPECT_THAT(page, HasSubstr("data-series=\"searching|vehicle 1\""));
  EXPECT_THAT(page, HasSubstr("data-series=\"delivering|vehicle 12\""));
  EXPECT_THAT(page, HasSubstr("data-time=\"27 60.2 76 420 s\""));
  EXPECT_THAT(page, HasSubstr("data-times=\"0.0 "));
}

TEST(Report, TheVerdictFollowsTheChecks) {
  Contents contents = small_contents();
  EXPECT_THAT(html(contents), HasSubstr("<b>PASS</b>all 1 checks held"));
  EXPECT_THAT(text_table(contents.checks, contents.comparison),
              EndsWith("PASS: all 1 checks held\n"));
  contents.checks.front().violations = {{VehicleId{1}, Instant{}, "vehicle 1 turned < 150 m"}};
  const std::string page = html(contents);
  EXPECT_EQ(fault_of_tags(page), "");
  EXPECT_THAT(page, HasSubstr("<b>FAIL</b>1 of 1 checks did not hold"));
  EXPECT_THAT(page, HasSubstr("vehicle 1 turned &lt; 150 m"));
  const std::string text = text_table(contents.checks, contents.comparison);
  EXPECT_THAT(text, HasSubstr("vehicle 1 turned < 150 m"));
  EXPECT_THAT(text, EndsWith("FAIL: 1 of 1 checks did not hold\n"));
}

TEST(Report, AMissionThatLeftNothingStillGivesAPage) {
  Contents contents;
  contents.title = "nothing";
  EXPECT_EQ(fault_of_tags(html(contents)), "");
  EXPECT_EQ(fault_of_tags(mission_svg(contents.record)), "");
}

TEST(Report, TheMapStandsAlone) {
  const std::string svg = mission_svg(small_contents().record);
  EXPECT_EQ(fault_of_tags(svg), "");
  EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
}

TEST(Report, LongTracksAreThinned) {
  Contents contents = small_contents();
  EXPECT_LT(html(contents).size(), 60'000U);  // 4000 track points
}

/// A copter in formation, which stands until 50 s and then climbs.
TEST(Report, HowFarCoptersWereFromTheirPlacesIsToldByWhatTheyDid) {
  Contents contents = small_contents();
  auto& flown = contents.record.recordings[1];
  for (auto& point : flown.track) {
    const double climbs_s = std::max(0.0, to_seconds(point.state.time) - 50.0);
    point.state.x_m = 0.0;
    point.state.z_m = climbs_s;
    point.plan_number = 1;
    point.cross_error_m = climbs_s > 0.0 ? 0.75 : 0.05;
  }
  contents.record.truths = {flown};
  const std::string text = truth_text(contents.record, contents.limits);
  EXPECT_THAT(text, HasSubstr("vehicle 12                  in place  0.05 / 0.05 m from its place\n"
                              "                            climbing  0.7"));
  EXPECT_THAT(text, Not(HasSubstr("level")));
  const std::string page = html(contents);
  EXPECT_EQ(fault_of_tags(page), "");
  EXPECT_THAT(page, HasSubstr("<td>0.05 / 0.05 m from its place</td>"));
}

TEST(Story, TellsWhoWorkedForWhomWhen) {
  const auto told = stories(small_contents().record);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(site_at(told[0], at_seconds(2.0)), std::nullopt);
  EXPECT_EQ(site_at(told[0], at_seconds(10.0)), SiteId{3});
  EXPECT_EQ(site_at(told[0], at_seconds(26.0)), SiteId{3});
  EXPECT_EQ(site_at(told[0], at_seconds(30.0)), std::nullopt);
  EXPECT_EQ(site_at(told[1], at_seconds(26.0)), std::nullopt);  // a bid is no work yet
  EXPECT_EQ(site_at(told[1], at_seconds(40.0)), SiteId{3});
  EXPECT_EQ(site_at(told[1], at_seconds(61.0)), std::nullopt);
}

TEST(Drawing, ThinningKeepsCornersAndEnds) {
  std::vector<Vec2> line;
  for (int i = 0; i <= 100; ++i) line.emplace_back(i, 0.0);
  for (int i = 1; i <= 100; ++i) line.emplace_back(100.0, i);
  const auto thin = thinned(line, 0.1);
  ASSERT_EQ(thin.size(), 3U);
  EXPECT_EQ(thin[1], (Vec2{100.0, 0.0}));
}

TEST(Drawing, ThinningStaysWithinItsTolerance) {
  std::vector<Vec2> circle;
  for (int i = 0; i <= 360; ++i) circle.emplace_back(100.0 * unit_vector(radians(i)));
  const auto thin = thinned(circle, 0.5);
  EXPECT_LT(thin.size(), 60U);
  for (std::size_t i = 1; i < thin.size(); ++i) {
    EXPECT_GT((0.5 * (thin[i] + thin[i - 1])).norm(), 99.5 - 1e-9);
  }
}

TEST(Drawing, TicksAreRoundAndWithin) {
  const Axis axis{3.0, 222.0, 0.0, 100.0};
  const auto ticks = axis.ticks(8);
  EXPECT_EQ(ticks.front(), 20.0);
  EXPECT_EQ(ticks.back(), 220.0);
}

TEST(Drawing, AnAxisOfRoundingErrorsHasNoTicks) {
  const double next = std::nextafter(1.0, 2.0);
  EXPECT_TRUE((Axis{1.0, next, 0.0, 100.0}.ticks(6)).empty());
}

TEST(Report, HasWhatCouldHaveBeenFlownWhereItIsKnown) {
  Contents contents = small_contents();
  EXPECT_THAT(html(contents), Not(HasSubstr("Knowing all from the start")));
  contents.hindsight = {{"last task <done>", "201.1 s", "98.3 s", "proven", "2.05"}};
  const std::string page = html(contents);
  EXPECT_THAT(page, HasSubstr("Knowing all from the start"));
  EXPECT_THAT(page, HasSubstr("<td>last task &lt;done&gt;</td><td class=\"number\">201.1 s</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">2.05</td>"));
}

}  // namespace
}  // namespace skein::report
