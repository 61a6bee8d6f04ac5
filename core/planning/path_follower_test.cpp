// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/path_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <optional>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace {
std::atomic<long> g_allocations{0};
}  // namespace

// Every allocation of this program is counted. Not inline: GCC would see free() take what new gave.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;  // NOLINT(cppcoreguidelines-no-malloc)
  throw std::bad_alloc{};
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*none*/) noexcept {
  ++g_allocations;
  return std::malloc(size);  // NOLINT(cppcoreguidelines-no-malloc)
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc)
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc)
}

namespace skein::planning {
namespace {

VehicleSpec vehicle_of(double speed_mps, double gain_per_s) {
  VehicleSpec v;
  v.id = VehicleId{1};
  v.cruise_speed_mps = speed_mps;
  v.speed_min_mps = 0.6 * speed_mps;
  v.speed_max_mps = 1.4 * speed_mps;
  v.turn_radius_m = 150.0;
  v.heading_gain_per_s = gain_per_s;
  v.height_m = 300.0;
  return v;
}

/// The vehicle of Wang 2022, eq. (2), written apart from the project's own model of it.
struct Simulated {
  VehicleSpec vehicle;
  Vec2 wind;
  Vec2 position{0.0, 0.0};
  double heading_rad = 0.0;
  double airspeed_mps = 0.0;
  double rate_largest = 0.0;  ///< of airspeed / turn radius

  [[nodiscard]] VehicleState state(Instant now) const {
    const Vec2 ground = airspeed_mps * unit_vector(heading_rad) + wind;
    return {.time = now,
            .x_m = position.x(),
            .y_m = position.y(),
            .z_m = vehicle.height_m,
            .heading_rad = wrap_pi(heading_rad),
            .course_rad = std::atan2(ground.y(), ground.x()),
            .groundspeed_mps = ground.norm(),
            .airspeed_mps = airspeed_mps,
            .distance_flown_m = 0.0};
  }
  void fly(const Setpoint& command, double seconds) {
    // What is commanded, before the vehicle's own limit: the follower must not lean on that.
    const double rate = vehicle.heading_gain_per_s * wrap_pi(command.heading_rad - heading_rad);
    const double rate_max = airspeed_mps / vehicle.turn_radius_m;
    rate_largest = std::max(rate_largest, std::abs(rate) / rate_max);
    constexpr int kSteps = 10;
    for (int i = 0; i < kSteps; ++i) {
      const double dt = seconds / kSteps;
      const double turn =
          std::clamp(vehicle.heading_gain_per_s * wrap_pi(command.heading_rad - heading_rad),
                     -airspeed_mps / vehicle.turn_radius_m, airspeed_mps / vehicle.turn_radius_m) *
          dt;
      position += (airspeed_mps * unit_vector(heading_rad + turn / 2.0) + wind) * dt;
      heading_rad += turn;
      const double wanted =
          std::clamp(command.airspeed_mps, vehicle.speed_min_mps, vehicle.speed_max_mps);
      airspeed_mps += (wanted - airspeed_mps) * dt;
    }
  }
};

struct Flown {
  double along_m = 0.0;  ///< largest after the transient
  double cross_m = 0.0;
  double along_end_m = 0.0;
  double cross_end_m = 0.0;
  double rate_largest = 0.0;
};

constexpr double kTransient_s = 25.0;

TimedPath course_of(double radius_m, double speed_mps) {
  TimedPath plan{.start_time = at_seconds(100.0),
                 .speed_mps = speed_mps,
                 .tail_curvature_per_m = 0.0,
                 .path = {.start = {0, 0, 0.4}, .segments = {}}};
  const double r = radius_m;
  for (const Segment& s : {Segment{0.0, 30.0 * speed_mps}, Segment{1.0 / r, r * kPi},
                           Segment{0.0, 800.0}, Segment{-1.0 / r, 2.0 * kPi * r},
                           Segment{1.0 / r, 1.5 * r}, Segment{0.0, 40.0 * speed_mps}}) {
    EXPECT_TRUE(plan.path.append(s));
  }
  return plan;
}

Flown fly(const VehicleSpec& vehicle, const TimedPath& plan, const Vec2& wind, const Pose2& from) {
  Simulated s{.vehicle = vehicle,
              .wind = wind,
              .position = from.position(),
              .heading_rad = from.heading_rad,
              .airspeed_mps = vehicle.cruise_speed_mps};
  Flown flown;
  const double seconds = to_seconds(plan.end_time() - plan.start_time);
  constexpr double kPeriod_s = 0.02;
  const int periods = static_cast<int>(std::ceil(seconds / kPeriod_s));
  for (int i = 0; i < periods; ++i) {
    const double t = i * kPeriod_s;
    const Instant now = plan.start_time + from_seconds(t);
    const VehicleState state = s.state(now);
    const FollowError error = follow_error(plan, state, now);
    if (t > kTransient_s) {
      flown.along_m = std::max(flown.along_m, std::abs(error.along_m));
      flown.cross_m = std::max(flown.cross_m, std::abs(error.cross_m));
    }
    flown.along_end_m = std::abs(error.along_m);
    flown.cross_end_m = std::abs(error.cross_m);
    s.fly(follow_path({}, vehicle, plan, state, now), kPeriod_s);
  }
  flown.rate_largest = s.rate_largest;
  return flown;
}

/// On a circle flown at ground speed g downwind, the turn through the air is g^2 / (R (g - w)),
/// which the vehicle can fly where R >= r (g / (g - w))^2.
double radius_for(double speed_mps, double wind_mps, double turn_radius_m) {
  const double ratio = speed_mps / (speed_mps - wind_mps);
  return turn_radius_m * ratio * ratio;
}

TEST(PathFollower, KeepsLinesAndArcsInWind) {
  for (const double speed : {50.0, 60.0}) {
    for (const double gain : {1.0, 2.0}) {
      for (const double wind : {0.0, 4.0, 8.0}) {
        for (const double from : {0.0, 1.7, -2.5}) {
          const VehicleSpec vehicle = vehicle_of(speed, gain);
          const double radius =
              std::max(1.1, 1.02 * radius_for(speed, wind, 1.0)) * vehicle.turn_radius_m;
          const TimedPath plan = course_of(radius, speed);
          const Flown flown = fly(vehicle, plan, wind * unit_vector(from), plan.path.start);
          EXPECT_LT(flown.cross_m, 5.0) << speed << " " << gain << " " << wind << " " << from;
          EXPECT_LT(flown.along_m, 5.0) << speed << " " << gain << " " << wind << " " << from;
          EXPECT_LT(flown.rate_largest, 1.0 + 1e-9);
        }
      }
    }
  }
}

/// A place beside a track moves slower inside its turns and faster outside; where one begins, at
/// once.
TEST(PathFollower, KeepsPlacesBesideATrackInWind) {
  VehicleSpec vehicle = vehicle_of(20.0, 1.5);
  vehicle.turn_radius_m = 60.0;
  vehicle.speed_min_mps = 9.0;
  vehicle.speed_max_mps = 31.0;
  for (const double left_m : {-70.0, -35.0, 0.0, 70.0}) {
    for (const double wind : {0.0, 3.0, 5.0}) {
      for (const double from : {0.0, 1.7, -2.5}) {
        TimedPath plan = course_of(300.0, 20.0);
        for (Segment& segment : plan.path.segments) {
          const double pace = 1.0 - segment.curvature_per_m * left_m;
          segment.length_m *= pace;
          segment.curvature_per_m /= pace;
          plan.paces.push_back(pace);
        }
        plan.paces.push_back(1.0);
        const Flown flown = fly(vehicle, plan, wind * unit_vector(from), plan.path.start);
        EXPECT_LT(flown.cross_m, 3.0) << left_m << " " << wind << " " << from;
        EXPECT_LT(flown.along_m, 4.5) << left_m << " " << wind << " " << from;
        EXPECT_LT(flown.along_end_m, 1.0) << left_m << " " << wind << " " << from;
        EXPECT_LT(flown.rate_largest, 1.0 + 1e-9);
      }
    }
  }
}

TEST(PathFollower, RecoversFromArcsThatTheWindMakesTooTight) {
  for (const double wind : {4.0, 8.0}) {
    const VehicleSpec vehicle = vehicle_of(50.0, 1.5);
    const TimedPath plan = course_of(1.1 * vehicle.turn_radius_m, 50.0);
    const Flown flown = fly(vehicle, plan, {wind, 0.0}, plan.path.start);
    EXPECT_GT(flown.cross_m, 1.0);
    EXPECT_LT(flown.cross_m, 80.0);
    EXPECT_LT(flown.cross_end_m, 2.0);
    EXPECT_LT(flown.along_end_m, 2.0);
    EXPECT_LT(flown.rate_largest, 1.0 + 1e-9);
  }
}

TEST(PathFollower, JoinsThePlanFromBesideAndLate) {
  const VehicleSpec vehicle = vehicle_of(50.0, 1.0);
  const TimedPath plan = course_of(1.1 * vehicle.turn_radius_m, 50.0);
  for (const Vec2& offset : {Vec2{-60.0, 0.0}, Vec2{60.0, 0.0}, Vec2{0.0, 80.0}, Vec2{-40, -80}}) {
    const Vec2 p = plan.path.start.position() + offset;
    const Flown flown = fly(vehicle, plan, {0, 0}, {p.x(), p.y(), 1.2});
    EXPECT_LT(flown.cross_m, 5.0);
    EXPECT_LT(flown.along_m, 5.0);
  }
}

TEST(PathFollower, IsOnItsCourseWhereItIsToBeOnTime) {
  const VehicleSpec vehicle = vehicle_of(30.0, 1.5);
  TimedPath plan = course_of(1.1 * vehicle.turn_radius_m, 30.0);
  plan.on_time_m = 90.0;
  for (const double beside_m : {-24.0, -10.0, 10.0, 24.0}) {
    for (const double wind_mps : {0.0, 4.0}) {
      const Pose2 start = plan.path.start;
      Simulated s{.vehicle = vehicle,
                  .wind = wind_mps * left_of(unit_vector(start.heading_rad)),
                  .position = start.position() + beside_m * left_of(unit_vector(start.heading_rad)),
                  .heading_rad = start.heading_rad - std::asin(wind_mps / 30.0),
                  .airspeed_mps = 30.0};
      for (int i = 0; i < 150; ++i) {
        const Instant now = plan.start_time + from_seconds(i * 0.02);
        s.fly(follow_path({}, vehicle, plan, s.state(now), now), 0.02);
      }
      const double course_rad = s.state(plan.start_time).course_rad;
      EXPECT_LT(std::abs(wrap_pi(course_rad - start.heading_rad)), radians(4.0))
          << beside_m << " " << wind_mps;
      EXPECT_LT(
          std::abs(follow_error(plan, s.state({}), plan.start_time + from_seconds(3.0)).cross_m),
          0.7 * std::abs(beside_m));
    }
  }
}

TEST(PathFollower, ErrorsHaveTheirSigns) {
  TimedPath plan{.start_time = at_seconds(10.0),
                 .speed_mps = 50.0,
                 .tail_curvature_per_m = 0.0,
                 .path = {.start = {0, 0, 0}, .segments = {}}};
  ASSERT_TRUE(plan.path.append(Segment{0.0, 1000.0}));
  VehicleState state;
  state.x_m = 110.0;
  state.y_m = 7.0;
  const FollowError error = follow_error(plan, state, at_seconds(12.0));
  EXPECT_NEAR(error.along_m, 10.0, 1e-9);
  EXPECT_NEAR(error.cross_m, 7.0, 1e-9);
}

TEST(PathFollower, KnowsWhereThePiecesBegin) {
  const Path path = course_of(165.0, 50.0).path;
  const PieceStarts starts{path};
  double begin_m = 0.0;
  for (std::size_t i = 0; i <= path.segments.size(); ++i) {
    const Pose2 pose = path.pose_at(begin_m);
    EXPECT_LT((starts[i].position() - pose.position()).norm(), 1e-6);
    EXPECT_NEAR(wrap_pi(starts[i].heading_rad - pose.heading_rad), 0.0, 1e-9);
    if (i < path.segments.size()) begin_m += path.segments[i].length_m;
  }
  EXPECT_EQ(starts.length_m(), path.length_m());
}

TEST(PathFollower, CommandsAreFiniteAndWithinLimitsWherever) {
  Random random{41};
  const VehicleSpec vehicle = vehicle_of(50.0, 1.0);
  const TimedPath plan = course_of(165.0, 50.0);
  for (int i = 0; i < 20000; ++i) {
    VehicleState state;
    state.x_m = random.uniform(-5000, 5000);
    state.y_m = random.uniform(-5000, 5000);
    state.heading_rad = random.uniform(-kPi, kPi);
    state.course_rad = random.uniform(-kPi, kPi);
    state.airspeed_mps = random.uniform(0.0, 80.0);
    state.groundspeed_mps = random.uniform(0.0, 80.0);
    const Setpoint s = follow_path({}, vehicle, plan, state, at_seconds(random.uniform(0, 400)));
    ASSERT_TRUE(std::isfinite(s.heading_rad));
    EXPECT_GE(s.airspeed_mps, vehicle.speed_min_mps);
    EXPECT_LE(s.airspeed_mps, vehicle.speed_max_mps);
    EXPECT_EQ(s.height_m, vehicle.height_m);
    EXPECT_LE(std::abs(wrap_pi(s.heading_rad - state.heading_rad)) * vehicle.heading_gain_per_s,
              state.airspeed_mps / vehicle.turn_radius_m + 1e-9);
  }
}

TEST(PathFollower, AllocatesNothing) {
  const VehicleSpec vehicle = vehicle_of(50.0, 1.0);
  const TimedPath plan = course_of(165.0, 50.0);
  const VehicleState state;
  const long before = g_allocations;
  double sum = 0.0;
  for (int i = 0; i < 100; ++i) {
    sum += follow_path({}, vehicle, plan, state, at_seconds(100.0 + i)).heading_rad;
    sum += follow_error(plan, state, at_seconds(100.0 + i)).cross_m;
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace skein::planning
