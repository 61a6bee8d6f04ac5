// SPDX-License-Identifier: Apache-2.0
// The wind that the team tells, held against the one that it flies in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/console/picture.hpp"
#include "skein/console/team_wind.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {
namespace {

/// What the ground station makes of a mission's telemetry.
class WindWatch {
 public:
  explicit WindWatch(const Vec2& true_mps) : true_mps_{true_mps} {}

  TeamObserver observer() {
    TeamObserver observer;
    observer.ground_message = [this](const mission::Message& m, VehicleId, Instant now) {
      if (const auto* told = std::get_if<mission::Telemetry>(&m)) wind_.on_telemetry(*told, now);
    };
    observer.moment = [this](Instant now, const mission::GroundNode&, const std::vector<OwnWord>&) {
      look(now);
    };
    return observer;
  }

  double worst_mps = 0.0;
  double worst_gust_mps = 0.0;
  int moments = 0;

 private:
  /// From when all have a whole window: then three and more of them turn.
  void look(Instant now) {
    if (now < at_seconds(25.0) || now < next_) return;
    next_ = now + std::chrono::seconds{1};
    const auto team = wind_.estimate({}, now);
    if (!team || team->vehicles.size() < 3) return;
    ++moments;
    worst_mps = std::max(worst_mps, (team->wind.mean_mps - true_mps_).norm());
    worst_gust_mps = std::max(worst_gust_mps, team->wind.gust_mps);
  }

  const Vec2 true_mps_;
  console::TeamWind wind_;
  Instant next_{};
};

/// The mission goes on: somewhere is a site that nobody finds.
WindWatch fly(const std::string& name, double speed_mps, double from_deg, double gust_mps) {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  if (!scenario) throw std::runtime_error(scenario.error().message);
  scenario->wind.speed_mps = speed_mps;
  scenario->wind.from_rad = heading_from_compass_deg(from_deg);
  scenario->wind.gust_mps = gust_mps;
  TeamMission team = team_mission(*scenario);
  Site far;
  far.id = SiteId{99};
  far.position = {50'000.0, 0.0};
  team.sites.push_back(far);
  team.duration_max = std::chrono::seconds{110};
  WindWatch watch{team.wind.steady_mps};
  (void)simulate_team(team, watch.observer());
  return watch;
}

TEST(WindRuns, IsToldWithinHalfAMetreASecond) {
  for (const double from_deg : {0.0, 100.0, 240.0, 355.0}) {
    const WindWatch watch = fly("coalition-6", 3.0, from_deg, 0.0);
    EXPECT_GT(watch.moments, 50) << from_deg;
    EXPECT_LT(watch.worst_mps, 0.5) << from_deg;
    RecordProperty("worst_mm_per_s_from_" + std::to_string(std::lround(from_deg)),
                   std::to_string(std::lround(1e3 * watch.worst_mps)));
  }
}

TEST(WindRuns, AlsoInGusts) {
  const WindWatch watch = fly("coalition-6", 3.0, 240.0, 0.5);
  EXPECT_GT(watch.moments, 50);
  EXPECT_LT(watch.worst_mps, 1.0) << "the gusts of 20 s are not all of them";
  EXPECT_GT(watch.worst_gust_mps, 3.1);
}

TEST(WindRuns, ACalmIsACalm) {
  const WindWatch watch = fly("coalition-6", 0.0, 0.0, 0.0);
  EXPECT_GT(watch.moments, 50);
  EXPECT_LT(watch.worst_mps, 0.5);
}

}  // namespace
}  // namespace skein::hil
