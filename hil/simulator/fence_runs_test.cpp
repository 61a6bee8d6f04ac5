// SPDX-License-Identifier: Apache-2.0
// Whole missions close to the edges of a fence: nobody leaves it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/checks/checks.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

constexpr double kRadius_m = 70.0;
constexpr double kHeight_m = 100.0;
constexpr std::uint16_t kPlanes = 4;

/// A star around the site: with `convex` none of its corners points inwards.
Fence random_fence(Random& random, bool convex) {
  Fence fence;
  const int corners = 5 + static_cast<int>(random.index(5));
  for (int i = 0; i < corners; ++i) {
    const double reach_m = convex ? 1400.0 : random.uniform(900.0, 1700.0);
    const double at = convex ? random.uniform(0.2, 0.8) : 0.5;
    fence.corners.push_back(reach_m * unit_vector((i + at) * kTwoPi / corners));
  }
  fence.height_max_m = 200.0;
  return fence;
}

/// There is an orbit within the fence that leads over it.
bool has_room(const Fence& fence, const Vec2& point, double spare_m) {
  for (int i = 0; i < 72; ++i) {
    const Vec2 centre = point + kRadius_m * unit_vector(i * kTwoPi / 72.0);
    if (fence.inside_m(centre) >= kRadius_m + spare_m) return true;
  }
  return false;
}

Vec2 random_place(const Fence& fence, Random& random, double from_m, double to_m) {
  while (true) {
    const Vec2 place{random.uniform(-1700.0, 1700.0), random.uniform(-1700.0, 1700.0)};
    const double inside_m = fence.inside_m(place);
    if (inside_m > from_m && inside_m < to_m && has_room(fence, place, from_m)) return place;
  }
}

SimulatedVehicle plane(std::uint16_t number, const Fence& fence, Random& random) {
  SimulatedVehicle v;
  v.spec.id = VehicleId{number};
  v.spec.cruise_speed_mps = 28.0;
  v.spec.speed_min_mps = 22.0;
  v.spec.speed_max_mps = 34.0;
  v.spec.turn_radius_m = kRadius_m;
  v.spec.heading_gain_per_s = 1.5;
  v.spec.range_m = 30e3;
  v.spec.height_m = kHeight_m + 10.0 * number;
  v.spec.sensor_radius_m = v.spec.assess_radius_m = 120.0;
  v.spec.final_approach_m = 150.0;
  v.spec.loads = 1;
  v.spec.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
  const Vec2 home = random_place(fence, random, 2.0 * kRadius_m + 20.0, 1e4);
  v.start = {home.x(), home.y(), random.uniform(-kPi, kPi)};
  for (int i = 0; i < 8; ++i) v.search.push_back(random_place(fence, random, 12.0, 60.0));
  return v;
}

/// Somebody is told to hold, to come home, to go on, all the time.
void give_orders(TeamMission& team, Random& random) {
  using mission::CommandKind;
  static constexpr std::array kOrders{CommandKind::hold, CommandKind::resume,
                                      CommandKind::return_home, CommandKind::resume};
  for (std::size_t i = 0; i < 12; ++i) {
    const VehicleId who{static_cast<std::uint16_t>(1 + random.index(kPlanes))};
    team.faults.push_back({{.not_before = at_seconds(10.0 + 20.0 * static_cast<double>(i))},
                           {},
                           Ordered{who, kOrders.at(i % kOrders.size())}});
  }
}

TeamMission near_the_edge(std::uint64_t seed) {
  Random random{seed};
  TeamMission team;
  team.seed = seed;
  team.fence = random_fence(random, seed % 2 == 0);
  for (std::uint16_t n = 1; n <= kPlanes; ++n) {
    team.vehicles.push_back(plane(n, team.fence, random));
  }
  Site site;
  site.id = SiteId{1};
  site.position = random_place(team.fence, random, 60.0, 500.0);
  site.survey.dwell = std::chrono::seconds{4};
  site.deliveries.push_back({random.uniform(-kPi, kPi), {}});
  team.sites.push_back(site);
  team.reported[site.id] = at_seconds(30.0);
  team.decisions.push_back({SiteId{1}, true, std::chrono::seconds{1}, {}});
  team.wind.steady_mps = random.uniform(0.0, 3.0) * unit_vector(random.uniform(-kPi, kPi));
  team.heeds_wind = seed % 3 == 0;
  team.duration_max = std::chrono::seconds{300};
  give_orders(team, random);
  return team;
}

TEST(FenceRuns, NobodyLeavesItInSearchesHoldsAndTasksCloseToItsEdges) {
  int near_edge = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TeamMission team = near_the_edge(seed);
    checks::RunRecord record;
    (void)fly_judged(team, {}, {}, &record);
    const auto fence = checks::check_fence(record);
    ASSERT_TRUE(fence);
    for (const auto& violation : fence->violations) ADD_FAILURE() << violation.sentence;
    for (const auto& recording : record.recordings) {
      for (const auto& sample : recording.track) {
        near_edge += team.fence.inside_m({sample.state.x_m, sample.state.y_m}) < 40.0 ? 1 : 0;
      }
      for (const mission::MissionEvent& event : recording.events) {
        const auto* trouble = std::get_if<mission::event::VehicleTrouble>(&event.body);
        EXPECT_FALSE(trouble != nullptr && trouble->trouble == mission::event::Trouble::left_fence);
      }
    }
  }
  EXPECT_GT(near_edge, 1000) << "of what was recorded";
}

}  // namespace
}  // namespace skein::hil
