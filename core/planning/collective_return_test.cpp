// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/collective_return.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::planning {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct World {
  ReturnParams params;
  std::vector<ReturningVehicle> vehicles;
  std::vector<Hazard> hazards;
};

ReturningVehicle plane(std::uint16_t number, const Pose2& start, const Vec2& home) {
  ReturningVehicle v;
  v.id = VehicleId{number};
  v.start = start;
  v.height_m = 100.0;
  v.speed_mps = 22.0;
  v.speed_min_mps = 18.0;
  v.turn_radius_m = 60.0;
  v.range_left_m = 40'000.0;
  v.home = home;
  return v;
}

bool keeps_free(const Vec2& point, double room_m, const World& world) {
  return std::ranges::all_of(world.hazards, [&](const Hazard& h) {
    return (h.centre - point).norm() > 1.2 * h.radius_m + room_m;
  });
}

/// Vehicles all over the place, some at one height, headed anywhere, with homes in a row.
World random_world(Random& random, std::size_t count) {
  World world;
  const std::size_t hazards = random.index(5);
  for (std::size_t i = 0; i < hazards; ++i) {
    world.hazards.push_back(Hazard{{static_cast<std::uint16_t>(i + 1)},
                                   {random.uniform(800.0, 4000.0), random.uniform(-3000.0, 3000.0)},
                                   random.uniform(50.0, 350.0)});
  }
  if (random.chance(0.5)) world.params.arrival_spacing = seconds{5 + random.index(15)};
  const double layers = static_cast<double>(1 + random.index(6));
  while (world.vehicles.size() < count) {
    const auto n = static_cast<double>(world.vehicles.size());
    ReturningVehicle v = plane(
        static_cast<std::uint16_t>(n + 1.0),
        {random.uniform(500.0, 5000.0), random.uniform(-4000.0, 4000.0), random.uniform(-kPi, kPi)},
        {0.0, 20.0 * n});
    v.height_m = 60.0 + 10.0 * std::fmod(n, layers);
    v.speed_mps = random.uniform(18.0, 25.0);
    v.speed_min_mps = random.chance(0.5) ? 0.85 * v.speed_mps : v.speed_mps;
    v.turn_radius_m = random.uniform(40.0, 80.0);
    v.range_left_m = random.uniform(9'000.0, 40'000.0);
    if (random.chance(0.3)) v.arrival_heading_rad = kPi;
    const bool alone = std::ranges::all_of(world.vehicles, [&](const ReturningVehicle& o) {
      return (o.start.position() - v.start.position()).norm() > 300.0;
    });
    if (alone && keeps_free(v.start.position(), 3.0 * v.turn_radius_m, world)) {
      world.vehicles.push_back(v);
    }
  }
  return world;
}

// --- the checker: samples, and knows nothing of how a plan was made ---

struct Flown {
  const ReturningVehicle* vehicle = nullptr;
  const ReturnFlight* flight = nullptr;
};

std::vector<Flown> flown(const World& world, const CollectiveReturn& plan) {
  std::vector<Flown> all;
  for (const ReturnFlight& f : plan.flights) {
    const auto v = std::ranges::find(world.vehicles, f.vehicle, &ReturningVehicle::id);
    all.push_back({&*v, &f});
  }
  return all;
}

/// The least distance of any two that are at one height, from when both have begun to two laps
/// after the last has come home.
double least_apart_m(const World& world, const CollectiveReturn& plan, double step_s) {
  double least_m = 1e9;
  const auto all = flown(world, plan);
  const double last_s = to_seconds(plan.last_arrival) + 60.0;
  for (double t = 0.0; t < last_s; t += step_s) {
    std::vector<Vec2> at;
    at.reserve(all.size());
    for (const Flown& f : all) at.push_back(f.flight->timed.pose_at(at_seconds(t)).position());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const ReturningVehicle& a = *all[i].vehicle;
        const ReturningVehicle& b = *all[j].vehicle;
        const bool begun = at_seconds(t) >= std::max(a.start_time, b.start_time);
        if (!begun || std::abs(a.height_m - b.height_m) >= world.params.separation_vertical_m) {
          continue;
        }
        least_m = std::min(least_m, (at[i] - at[j]).norm());
      }
    }
  }
  return least_m;
}

void expect_flyable(const World& world, const Flown& f) {
  const ReturningVehicle& v = *f.vehicle;
  const TimedPath& timed = f.flight->timed;
  const Path& path = timed.path;
  EXPECT_EQ(timed.start_time, v.start_time);
  EXPECT_LE((path.start.position() - v.start.position()).norm(), 1e-9);
  EXPECT_NEAR(wrap_pi(path.start.heading_rad - v.start.heading_rad), 0.0, 1e-9);
  EXPECT_LE(path.curvature_max_per_m(), 1.0 / v.turn_radius_m + 1e-9);
  EXPECT_LE(std::abs(timed.tail_curvature_per_m), 1.0 / v.turn_radius_m + 1e-9);
  EXPECT_GT(std::abs(timed.tail_curvature_per_m), 0.0);
  EXPECT_LE(timed.speed_mps, v.speed_mps + 1e-9);
  EXPECT_GE(timed.speed_mps, v.speed_min_mps - 1e-9);
  const double lap_m = kTwoPi / std::abs(timed.tail_curvature_per_m);
  EXPECT_LE(path.length_m() + lap_m, v.range_left_m + 1e-6);
  double off_home_m = 1e9;
  for (double s = 0.0; s < path.length_m() + lap_m; s += 2.0) {
    const Vec2 at = timed.pose_at_distance(s).position();
    for (const Hazard& h : world.hazards) {
      ASSERT_GE((at - h.centre).norm(), h.radius_m - 1e-6) << "vehicle " << v.id.value;
    }
    if (s >= path.length_m()) off_home_m = std::min(off_home_m, (at - v.home).norm());
  }
  EXPECT_NEAR(off_home_m, f.flight->off_home_m, 2.0) << "vehicle " << v.id.value;
  EXPECT_LE(off_home_m, world.params.hold_within_m + 2.0);
  if (v.arrival_heading_rad && f.flight->off_home_m < 1e-6) {
    EXPECT_NEAR(wrap_pi(path.end().heading_rad - *v.arrival_heading_rad), 0.0, 1e-6);
  }
}

void expect_spacing(const World& world, const CollectiveReturn& plan) {
  const auto all = flown(world, plan);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((all[i].vehicle->home - all[j].vehicle->home).norm() > world.params.runway_m) continue;
      const Duration apart = all[i].flight->timed.end_time() - all[j].flight->timed.end_time();
      EXPECT_GE(std::abs(to_seconds(apart)), to_seconds(world.params.arrival_spacing) - 1e-6);
    }
  }
}

void expect_good(const World& world, const CollectiveReturn& plan, double step_s = 0.1) {
  EXPECT_EQ(plan.flights.size() + plan.failures.size(), world.vehicles.size());
  double length_m = 0.0;
  for (const Flown& f : flown(world, plan)) {
    expect_flyable(world, f);
    length_m += f.flight->timed.path.length_m();
    EXPECT_LE(f.flight->timed.end_time(), plan.last_arrival);
  }
  EXPECT_NEAR(length_m, plan.length_m, 1e-3);
  EXPECT_GE(least_apart_m(world, plan, step_s), world.params.separation_horizontal_m);
  expect_spacing(world, plan);
}

// --- what is asked of it ---

TEST(CollectiveReturn, OneVehicleFliesTheShortestWay) {
  World world;
  world.vehicles = {plane(1, {2000.0, 0.0, kPi}, {0.0, 0.0})};
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(plan.flights, SizeIs(1));
  EXPECT_NEAR(plan.length_m, 2000.0, 1e-6);
  EXPECT_NEAR(to_seconds(plan.last_arrival), 2000.0 / 22.0, 1e-6);
  EXPECT_NEAR(plan.flights[0].off_home_m, 0.0, 1e-9);
}

TEST(CollectiveReturn, TheCheckerSeesWhatEachAloneWouldDo) {
  World world;
  world.vehicles = {plane(1, {1500.0, 1500.0, kPi}, {-800.0, -800.0}),
                    plane(2, {1500.0, -1500.0, kPi}, {-800.0, 800.0})};
  CollectiveReturn alone;
  for (const ReturningVehicle& v : world.vehicles) {
    const auto one = plan_return(world.params, std::span{&v, 1}, {});
    alone.flights.push_back(one.flights.at(0));
    alone.last_arrival = std::max(alone.last_arrival, one.last_arrival);
  }
  EXPECT_LT(least_apart_m(world, alone, 0.1), world.params.separation_horizontal_m);
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  EXPECT_THAT(plan.failures, IsEmpty());
  expect_good(world, plan, 0.02);
}

TEST(CollectiveReturn, HeightsKeepApartByThemselves) {
  World world;
  world.vehicles = {plane(1, {1500.0, 1500.0, kPi}, {0.0, 0.0}),
                    plane(2, {1500.0, -1500.0, kPi}, {0.0, 0.0})};
  world.vehicles[1].height_m += world.params.separation_vertical_m;
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(plan.flights, SizeIs(2));
  for (const ReturnFlight& f : plan.flights) EXPECT_NEAR(f.off_home_m, 0.0, 1e-9);
  world.vehicles[1].height_m -= 0.1;
  const auto lower = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(lower.flights, SizeIs(2));
  expect_good(world, lower);
}

TEST(CollectiveReturn, ArrivalsKeepTheirSpacingAtAnyHeight) {
  World world;
  world.params.arrival_spacing = seconds{20};
  for (std::uint16_t i = 1; i <= 6; ++i) {
    world.vehicles.push_back(plane(i, {2000.0, 300.0 * i, kPi}, {0.0, 20.0 * i}));
    world.vehicles.back().height_m = 50.0 + 10.0 * i;
  }
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  EXPECT_THAT(plan.failures, IsEmpty());
  expect_good(world, plan);
  EXPECT_GE(to_seconds(plan.last_arrival), 2000.0 / 22.0 + 5 * 20.0);
}

TEST(CollectiveReturn, WhoCannotIsNamedWithTheReason) {
  World world;
  world.vehicles = {plane(1, {3000.0, 0.0, kPi}, {0.0, 0.0}),
                    plane(2, {3000.0, 500.0, kPi}, {0.0, 500.0}),
                    plane(3, {3000.0, -500.0, kPi}, {0.0, -500.0}),
                    plane(4, {3000.0, -900.0, kPi}, {0.0, -900.0})};
  world.vehicles[1].range_left_m = 3000.0;                 // no lap at home
  world.hazards = {Hazard{{1}, {3000.0, -500.0}, 100.0}};  // where 3 is
  world.vehicles[3].speed_mps = 0.0;
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(plan.flights, SizeIs(1));
  ASSERT_THAT(plan.failures, SizeIs(3));
  EXPECT_EQ(plan.failures[0].why, ReturnObstacle::out_of_range);
  EXPECT_NEAR(plan.failures[0].short_m, kTwoPi * 60.0, 1.0);
  EXPECT_THAT(reason_of(plan.failures[0]), HasSubstr("lacks 377 m of range"));
  EXPECT_EQ(plan.failures[1].why, ReturnObstacle::no_way);
  EXPECT_EQ(plan.failures[2].why, ReturnObstacle::bad_request);
  expect_good(world, plan);
}

TEST(CollectiveReturn, WhoBeginsTooNearAnotherIsNamedWithIt) {
  World world;
  world.vehicles = {plane(1, {3000.0, 0.0, kPi}, {0.0, 0.0}),
                    plane(2, {3000.0, 10.0, kPi}, {0.0, 500.0})};
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(plan.failures, SizeIs(1));
  EXPECT_EQ(plan.failures[0].why, ReturnObstacle::others);
  EXPECT_EQ(plan.failures[0].vehicle.value + plan.failures[0].other.value, 3);
}

TEST(CollectiveReturn, WithoutRoomToHoldSomebodyIsLeftOut) {
  World world;
  world.params.hold_within_m = 0.0;
  for (std::uint16_t i = 1; i <= 4; ++i) {
    world.vehicles.push_back(plane(i, {3000.0, 400.0 * i, kPi}, {0.0, 0.0}));
  }
  const auto plan = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_THAT(plan.failures, ::testing::Not(IsEmpty()));
  EXPECT_EQ(plan.failures[0].why, ReturnObstacle::no_room_to_hold);
  expect_good(world, plan);
}

TEST(CollectiveReturn, RandomWorldsHaveNoConflict) {
  std::size_t vehicles = 0;
  std::size_t failed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    const World world = random_world(random, 2 + random.index(19));
    const auto plan = plan_return(world.params, world.vehicles, world.hazards);
    expect_good(world, plan, 0.2);
    vehicles += world.vehicles.size();
    failed += plan.failures.size();
    for (const ReturnFailure& f : plan.failures) {
      std::printf("seed %lu: vehicle %u %s\n", static_cast<unsigned long>(seed), f.vehicle.value,
                  reason_of(f).c_str());
    }
  }
  std::printf("%zu of %zu vehicles without a way\n", failed, vehicles);
  EXPECT_LE(failed * 50, vehicles);
}

TEST(CollectiveReturn, InWindTheirTimesAreThoseOfOneAirspeed) {
  std::size_t vehicles = 0;
  std::size_t failed = 0;
  for (std::uint64_t seed = 300; seed < 330; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    World world = random_world(random, 2 + random.index(19));
    const Vec2 wind = random.uniform(1.0, 7.0) * unit_vector(random.uniform(-kPi, kPi));
    for (ReturningVehicle& v : world.vehicles) v.wind_mps = wind;
    const auto plan = plan_return(world.params, world.vehicles, world.hazards);
    expect_good(world, plan, 0.2);
    for (const Flown& f : flown(world, plan)) {
      const TimedPath& timed = f.flight->timed;
      EXPECT_EQ(timed.start_time, f.vehicle->start_time);
      EXPECT_EQ(timed.speed_mps, f.vehicle->speed_mps);
      // What each does through the air: its own speed, to second order in the wind.
      for (double s = 1.0; s < timed.path.length_m(); s += 40.0) {
        const Vec2 over_ground =
            timed.speed_at_distance(s) * unit_vector(timed.pose_at_distance(s).heading_rad);
        EXPECT_NEAR((over_ground - wind).norm(), timed.speed_mps,
                    1.5 * wind.squaredNorm() / timed.speed_mps);
      }
    }
    vehicles += world.vehicles.size();
    failed += plan.failures.size();
  }
  EXPECT_LE(failed * 50, vehicles);
}

TEST(CollectiveReturn, FiftyAtOneHeightWithHomesInARow) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    World world = random_world(random, 50);
    for (ReturningVehicle& v : world.vehicles) {
      v.height_m = 100.0;
      v.range_left_m = 40'000.0;
    }
    const auto plan = plan_return(world.params, world.vehicles, world.hazards);
    EXPECT_THAT(plan.failures, IsEmpty());
    expect_good(world, plan, 0.2);
  }
}

TEST(CollectiveReturn, WhoFliesAlreadyIsKeptClearOf) {
  std::size_t planned = 0;
  for (std::uint64_t seed = 200; seed < 215; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    World world = random_world(random, 12);
    const Vec2 wind = seed % 2 == 0 ? Vec2{0.0, 0.0} : Vec2{-3.0, 4.0};
    for (ReturningVehicle& v : world.vehicles) v.wind_mps = wind;
    const auto first = plan_return(world.params, world.vehicles, world.hazards);
    // Every second one flies what it was given; the others are planned a second time.
    for (const ReturnFlight& f : first.flights) {
      const auto v = std::ranges::find(world.vehicles, f.vehicle, &ReturningVehicle::id);
      if (v->id.value % 2 == 0) v->flies = f.timed;
    }
    auto both = plan_return(world.params, world.vehicles, world.hazards);
    planned += both.flights.size();
    for (const ReturnFlight& f : both.flights) EXPECT_EQ(f.vehicle.value % 2, 1);
    for (const ReturnFlight& f : first.flights) {
      if (f.vehicle.value % 2 == 0) both.flights.push_back(f);
      both.last_arrival = std::max(both.last_arrival, f.timed.end_time());
    }
    EXPECT_GE(least_apart_m(world, both, 0.2), world.params.separation_horizontal_m);
    expect_spacing(world, both);
  }
  EXPECT_GE(planned, 85U);  // of 90
}

TEST(CollectiveReturn, IsTheSameEachTime) {
  Random random{5};
  const World world = random_world(random, 20);
  const auto a = plan_return(world.params, world.vehicles, world.hazards);
  const auto b = plan_return(world.params, world.vehicles, world.hazards);
  ASSERT_EQ(a.flights.size(), b.flights.size());
  EXPECT_EQ(a.last_arrival, b.last_arrival);
  EXPECT_EQ(a.length_m, b.length_m);
}

/// Of all orders of priority none brings more home, and the best no one sooner by much.
TEST(CollectiveReturn, OrdersAreAsGoodAsAllOrdersOfFew) {
  double ours_s = 0.0;
  double best_s = 0.0;
  for (std::uint64_t seed = 100; seed < 125; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    World world = random_world(random, 2 + random.index(4));
    for (ReturningVehicle& v : world.vehicles) {
      v.height_m = 100.0;
      v.start.x_m *= 0.3;
      v.start.y_m *= 0.3;
    }
    world.hazards.clear();
    const auto plan = plan_return(world.params, world.vehicles, world.hazards);
    std::vector<std::size_t> order(world.vehicles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::size_t least_failures = order.size();
    Instant soonest = Instant::max();
    do {
      const auto other = plan_return_in_order(world.params, world.vehicles, world.hazards, order);
      expect_good(world, other, 0.5);
      if (other.failures.size() < least_failures) soonest = Instant::max();
      if (other.failures.size() > least_failures) continue;
      least_failures = other.failures.size();
      soonest = std::min(soonest, other.last_arrival);
    } while (std::ranges::next_permutation(order).found);
    EXPECT_EQ(plan.failures.size(), least_failures);
    ours_s += to_seconds(plan.last_arrival);
    best_s += to_seconds(soonest);
  }
  std::printf("last arrivals: %.1f s, the best of all orders %.1f s\n", ours_s, best_s);
  EXPECT_LE(ours_s, 1.05 * best_s);
}

}  // namespace
}  // namespace skein::planning
