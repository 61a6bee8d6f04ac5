// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/formation/track_planner.hpp"
#include "track_checks.hpp"

namespace skein::formation {
namespace {

constexpr double kRadius_m = 250.0;

/// With a turn each way, whatever is drawn.
Track random_track(Random& random, bool closed) {
  Track track{{{0.0, 0.0}}, closed, kRadius_m * random.uniform(1.0, 1.6)};
  if (closed) {
    const double a = random.uniform(2500.0, 4000.0);
    const double b = random.uniform(2500.0, 4000.0);
    // An L: five turns to the left and one to the right.
    track.waypoints = {{0.0, 0.0}, {2.0 * a, 0.0}, {2.0 * a, b},
                       {a, b},     {a, 2.0 * b},   {0.0, 2.0 * b}};
    return track;
  }
  double heading = random.uniform(-3.0, 3.0);
  for (int i = 0; i < 4; ++i) {
    track.waypoints.push_back(track.waypoints.back() +
                              random.uniform(1800.0, 3000.0) * unit_vector(heading));
    heading += (i % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.3, 1.8);
  }
  return track;
}

VehicleSpec plane(std::uint16_t id) {
  VehicleSpec spec;
  spec.id = {id};
  spec.cruise_speed_mps = 20.0;
  spec.speed_min_mps = 11.0;
  spec.speed_max_mps = 30.0;
  spec.turn_radius_m = 60.0;
  spec.turn_radius_margin = 1.5;
  spec.range_m = 90'000.0;
  spec.height_m = 80.0 + 10.0 * id;
  return spec;
}

TrackRequest request_of(const Track& track, std::size_t n) {
  TrackRequest request;
  request.track = track;
  request.speed_mps = 20.0;
  request.shape.kind = ShapeKind::wedge;
  request.shape.spacing_m = 45.0;
  request.start = at_seconds(30.0);
  request.rules.separation = {20.0, 8.0};
  request.rules.tracking_m = 6.0;
  request.rules.wind_mps = 4.0;
  request.rules.ceiling_m = 900.0;
  for (std::size_t i = 0; i < n; ++i) {
    TrackPlane one;
    one.spec = plane(static_cast<std::uint16_t>(i + 1));
    one.range_left_m = one.spec.range_m;
    one.flies.start_time = at_seconds(1.0);
    one.flies.speed_mps = 20.0;
    one.flies.path.start = {-600.0 - 300.0 * static_cast<double>(i), -800.0, 0.3};
    one.flies.tail_curvature_per_m = 1.0 / one.spec.planning_radius_m();
    request.planes.push_back(one);
  }
  return request;
}

TEST(TrackPath, IsSmoothAndAClosedOneComesBack) {
  Random random{7};
  for (int i = 0; i < 200; ++i) {
    const Track track = random_track(random, i % 2 == 0);
    const auto path = track_path(track, 2);
    ASSERT_TRUE(path.ok()) << path.error().message;
    EXPECT_NEAR(path->curvature_max_per_m() * track.turn_radius_m, 1.0, 1e-9);
    const Pose2 end = path->end();
    const Vec2 there = track.closed ? path->start.position() : track.waypoints.back();
    EXPECT_LT((end.position() - there).norm(), 1e-5);
    if (!track.closed) continue;
    EXPECT_LT(std::abs(wrap_pi(end.heading_rad - path->start.heading_rad)), 1e-9);
  }
}

TEST(TrackPath, RefusesWhatHasNoRoomWithWhatToChange) {
  const auto short_leg = track_path({{{0, 0}, {1000, 0}, {1000, 100}, {0, 100}}, true, 200.0});
  ASSERT_FALSE(short_leg.ok());
  EXPECT_NE(short_leg.error().message.find("the leg from waypoint 2 to 3 is 100 m long"),
            std::string::npos)
      << short_leg.error().message;
  EXPECT_FALSE(track_path({{{0, 0}}, false, 200.0}).ok());
  EXPECT_FALSE(track_path({{{0, 0}, {1000, 0}, {0, 1}}, false, 200.0}).ok());
  const Track lap{{{0, 0}, {2000, 0}, {2000, 2000}, {0, 2000}}, true, 200.0};
  EXPECT_TRUE(track_path(lap, 7).ok());
  const auto many = track_path(lap, 8);
  ASSERT_FALSE(many.ok());
  EXPECT_NE(many.error().message.find("fewer laps"), std::string::npos);
}

/// What the paces and curvatures say is what the geometry of an offset curve is.
TEST(TrackPlace, IsTheOffsetOfTheCurveAtEveryMoment) {
  Random random{8};
  for (int i = 0; i < 50; ++i) {
    const Track track = random_track(random, i % 2 == 0);
    const auto path = track_path(track);
    ASSERT_TRUE(path.ok());
    TimedPath centre;
    centre.speed_mps = 20.0;
    centre.path = *path;
    centre.tail_curvature_per_m = 1.0 / track.turn_radius_m;
    const TrackPlace place{random.uniform(-150.0, 0.0), random.uniform(-150.0, 150.0)};
    const PlacedPath placed = placed_path(*path, centre.tail_curvature_per_m, place, 200.0);
    TimedPath own;
    own.start_time = centre.time_at(200.0);
    own.speed_mps = 20.0;
    own.path = placed.path;
    own.tail_curvature_per_m = placed.tail_curvature_per_m;
    for (const double pace : placed.paces) own.paces.push_back(pace);
    own.paces.push_back(placed.tail_pace);
    const double end_s = to_seconds(centre.end_time()) + 60.0;
    for (double t = 10.0; t < end_s; t += 1.7) {
      const Pose2 on_track =
          centre.pose_at_distance(centre.distance_at(at_seconds(t)) + place.ahead_m);
      const Vec2 there =
          on_track.position() + place.left_m * left_of(unit_vector(on_track.heading_rad));
      EXPECT_LT((own.pose_at(at_seconds(t)).position() - there).norm(), 1e-5) << i << " " << t;
    }
  }
}

TEST(SampledWays, AreLookedAtToTheirLastStep) {
  const auto straight = [](const Pose2& start) {
    TimedPath timed;
    timed.speed_mps = 20.0;
    timed.path.start = start;
    timed.path.segments.push_back({0.0, 100.0});
    return timed;
  };
  SampledWays ways{Instant{}, at_seconds(2.0)};
  ways.add(straight({0.0, 0.0, 0.0}));
  ways.add(straight({100.0, 5.0, kPi}));
  const double apart_m = std::hypot(20.0, 5.0);  // they have flown 40 m each
  EXPECT_NEAR(ways.closest(0, 1, Instant{}).apart_m, apart_m - SampledWays::kMissed_m, 1e-6);
}

TEST(PlanTrack, KeepsPlanesApartAndWithinTheirLimitsOnRandomTracks) {
  Random random{9};
  std::size_t planned_count = 0;
  for (int i = 0; i < 40; ++i) {
    TrackRequest request = request_of(random_track(random, i % 2 == 0), 2 + random.index(6));
    request.shape.kind = static_cast<ShapeKind>(random.index(4));
    request.shape.spacing_m = random.uniform(36.0, 60.0);
    const auto planned = plan_track(request);
    if (!planned) continue;
    ++planned_count;
    const auto& flights = planned->flights;
    for (const auto& flight : flights) {
      const TimedPath& timed = flight.timed;
      const Pose2 now = flight.plane.flies.pose_at(request.start);
      EXPECT_LT((timed.path.start.position() - now.position()).norm(), 1e-6);
      EXPECT_EQ(timed.paces.size(), timed.path.segments.size() + 1);
      EXPECT_LE(timed.path.curvature_max_per_m() * flight.plane.spec.planning_radius_m(),
                1.0 + 1e-6);
      double at_m = 0.0;
      for (const Segment& segment : timed.path.segments) {
        const double speed = timed.speed_at_distance(at_m + segment.length_m / 2.0);
        EXPECT_GE(speed, flight.plane.spec.speed_min_mps + 4.0 - 1e-6);
        EXPECT_LE(speed, flight.plane.spec.speed_max_mps - 4.0 + 1e-6);
        at_m += segment.length_m;
      }
    }
    const double end_s = to_seconds(planned->ends) + 100.0;
    for (double t = to_seconds(planned->joined); t < end_s; t += 0.31) {
      for (std::size_t a = 0; a < flights.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          const double apart_m = (flights[a].timed.pose_at(at_seconds(t)).position() -
                                  flights[b].timed.pose_at(at_seconds(t)).position())
                                     .norm();
          ASSERT_GE(apart_m, 32.0) << "run " << i << " at " << t;
          ASSERT_GE(apart_m, planned->least_separation_m);
        }
      }
    }
  }
  EXPECT_GE(planned_count, 25U);
}

class Refusal : public ::testing::Test {
 protected:
  static std::string why(const TrackRequest& request) {
    const auto planned = plan_track(request);
    return planned ? "planned" : planned.error().message;
  }
  static bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
  }
  TrackRequest request_ = request_of(
      {{{0, 0}, {6000, 0}, {6000, 3000}, {3000, 3000}, {3000, 6000}, {0, 6000}}, true, 300.0}, 5);
};

TEST_F(Refusal, NothingWhereAllIsWell) { EXPECT_EQ(why(request_), "planned"); }

TEST_F(Refusal, OfTurnsTooTightForWhoFliesInside) {
  request_.track.turn_radius_m = 140.0;
  for (TrackPlane& plane : request_.planes) plane.spec.speed_min_mps = 2.0;
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "would turn on") && has(said, "widen the track's turn_radius_m")) << said;
}

TEST_F(Refusal, OfSpeedsBeyondWhatWindLeaves) {
  request_.speed_mps = 24.0;
  const std::string fast = why(request_);
  EXPECT_TRUE(has(fast, "more than its speed_max_mps") && has(fast, "lower the speed")) << fast;
  request_.speed_mps = 16.0;
  const std::string slow = why(request_);
  EXPECT_TRUE(has(slow, "less than its speed_min_mps") && has(slow, "raise the speed")) << slow;
}

TEST_F(Refusal, OfPlacesTooNearEachOther) {
  request_.shape.kind = ShapeKind::column;
  request_.shape.spacing_m = 30.0;
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "in their places") && has(said, "raise the spacing")) << said;
}

TEST_F(Refusal, OfAHazardOnTheTrack) {
  request_.rules.hazards = {{{4}, {4500.0, 3000.0}, 100.0}};
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "hazard 4") && has(said, "lead the track around")) << said;
}

TEST_F(Refusal, OfRangeThatDoesNotLast) {
  for (TrackPlane& plane : request_.planes) plane.range_left_m = 15'000.0;
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "km left") && has(said, "fewer laps")) << said;
}

TEST_F(Refusal, OfOneHeightWhereSomebodyMightNotHear) {
  for (TrackPlane& plane : request_.planes) {
    plane.spec.height_m = 100.0;
    plane.flies.path.start = {100.0, 10.0, 0.0};
  }
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "at one height") && has(said, "heights of their own")) << said;
}

TEST_F(Refusal, OfTheHeightOfASilentPlane) {
  request_.silent = {request_.planes.back()};
  request_.planes.pop_back();
  EXPECT_EQ(why(request_), "planned");
  request_.silent[0].spec.height_m = request_.planes[1].spec.height_m;
  const std::string said = why(request_);
  EXPECT_TRUE(has(said, "vehicle 5 is silent") && has(said, "vehicle 2")) << said;
}

TEST(Reshape, SlidesOnAStraightPieceAndKeepsApart) {
  Random random{10};
  std::size_t slid = 0;
  for (int i = 0; i < 30; ++i) {
    TrackRequest request = request_of(random_track(random, true), 5);
    request.shape.kind = static_cast<ShapeKind>(random.index(4));
    const auto first = plan_track(request);
    if (!first) continue;
    request.start = first->joined + from_seconds(random.uniform(5.0, 100.0));
    request.shape.kind = static_cast<ShapeKind>(random.index(4));
    request.shape.spacing_m = random.uniform(36.0, 55.0);
    const auto second = plan_reshape(*first, request);
    if (!second) continue;
    ++slid;
    for (std::size_t a = 0; a < second->flights.size(); ++a) {
      const auto& flight = second->flights[a];
      const auto old =
          std::find_if(first->flights.begin(), first->flights.end(),
                       [&](const auto& f) { return f.plane.spec.id == flight.plane.spec.id; });
      const Pose2 before = old->timed.pose_at(request.start);
      EXPECT_LT((flight.timed.pose_at(request.start).position() - before.position()).norm(), 1e-5);
      // Once it has slid it is in its new place.
      const Instant later = second->joined + std::chrono::seconds{20};
      const Pose2 on_track =
          second->centre.pose_at_distance(second->centre.distance_at(later) + flight.place.ahead_m);
      const Vec2 there =
          on_track.position() + flight.place.left_m * left_of(unit_vector(on_track.heading_rad));
      EXPECT_LT((flight.timed.pose_at(later).position() - there).norm(), 1e-4);
    }
  }
  EXPECT_GE(slid, 15U);
}

TEST(Reshape, RefusesWithoutAStraightPieceAhead) {
  TrackRequest request = request_of(
      {{{0, 0}, {6000, 0}, {6000, 3000}, {3000, 3000}, {3000, 6000}, {0, 6000}}, true, 300.0}, 5);
  const auto first = plan_track(request);
  ASSERT_TRUE(first.ok()) << first.error().message;
  request.start = first->joined - std::chrono::seconds{1};
  EXPECT_FALSE(plan_reshape(*first, request).ok());
  request.start = first->ends - std::chrono::seconds{5};
  const auto late = plan_reshape(*first, request);
  ASSERT_FALSE(late.ok());
  EXPECT_NE(late.error().message.find("no straight piece"), std::string::npos);
}

}  // namespace
}  // namespace skein::formation
