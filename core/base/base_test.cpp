// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "skein/base/angles.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/base/frames.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"
#include "skein/base/shortened.hpp"
#include "skein/base/time.hpp"

namespace skein {
namespace {

template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
static_assert(Subtractable<Position<MissionEnu>, Position<MissionEnu>>);
struct OtherFrame;
static_assert(!Subtractable<Position<MissionEnu>, Position<OtherFrame>>);

template <class C>
concept ReadsTime = requires {
  C::now();
};
static_assert(!ReadsTime<MissionTime>);

TEST(Time, SecondsRoundTripToTheNanosecond) {
  EXPECT_EQ(from_seconds(1.5).count(), 1'500'000'000);
  EXPECT_DOUBLE_EQ(to_seconds(at_seconds(101.44)), 101.44);
}

TEST(Atmosphere, HasTheStandardDensities) {
  // ISO 2533: density 1.2250 at the sea, 1.1117 at 1 km, 0.9093 at 3 km, 0.7364 at 5 km.
  EXPECT_NEAR(true_per_equivalent_airspeed(0.0), 1.0, 1e-12);
  EXPECT_NEAR(true_per_equivalent_airspeed(1000.0), std::sqrt(1.2250 / 1.1117), 3e-4);
  EXPECT_NEAR(true_per_equivalent_airspeed(3000.0), std::sqrt(1.2250 / 0.9093), 3e-4);
  EXPECT_NEAR(true_per_equivalent_airspeed(5000.0), std::sqrt(1.2250 / 0.7364), 3e-4);
  EXPECT_TRUE(std::isfinite(true_per_equivalent_airspeed(1e9)));
}

TEST(Angles, WrapKeepsTheDirectionAndTheInterval) {
  Random random{1};
  for (int i = 0; i < 10'000; ++i) {
    const double a = random.uniform(-100.0, 100.0);
    EXPECT_GT(wrap_pi(a), -kPi);
    EXPECT_LE(wrap_pi(a), kPi);
    EXPECT_GE(wrap_two_pi(a), 0.0);
    EXPECT_LT(wrap_two_pi(a), kTwoPi);
    EXPECT_NEAR(std::cos(wrap_pi(a)), std::cos(a), 1e-12);
    EXPECT_NEAR(std::sin(wrap_two_pi(a)), std::sin(a), 1e-12);
  }
  EXPECT_EQ(wrap_pi(-kPi), kPi);
}

TEST(Angles, CompassAndMathematicalHeadings) {
  EXPECT_NEAR(heading_from_compass_deg(90.0), 0.0, 1e-15);       // east
  EXPECT_NEAR(heading_from_compass_deg(0.0), kPi / 2.0, 1e-15);  // north
  EXPECT_NEAR(compass_deg_from_heading(kPi), 270.0, 1e-12);      // west
  for (int c = 0; c < 360; c += 7) {
    EXPECT_NEAR(compass_deg_from_heading(heading_from_compass_deg(c)), c, 1e-9);
  }
}

TEST(Angles, YawIsTheCompassInRadians) {
  for (int c = -180; c < 360; c += 7) {
    const double heading = heading_from_compass_deg(c);
    EXPECT_NEAR(yaw_from_heading(heading), wrap_pi(radians(c)), 1e-12);
    EXPECT_NEAR(heading_from_yaw(radians(c)), heading, 1e-12);
  }
}

TEST(Frames, NorthEastDownAndBack) {
  EXPECT_EQ(ned_from_enu({1.0, 2.0, 3.0}), Eigen::Vector3d(2.0, 1.0, -3.0));
  EXPECT_EQ(enu_from_ned({2.0, 1.0, -3.0}), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Random, FirstNumbersAreFixedForEver) {
  // xoshiro256++ with splitmix64(42): a change here would change every recorded mission.
  Random random{42};
  EXPECT_EQ(random.next(), 15021278609987233951ULL);
  EXPECT_EQ(random.next(), 5881210131331364753ULL);
}

TEST(Random, MomentsOfTheDistributions) {
  Random random{7};
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCount = 200'000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal(3.0, 2.0);
    sum += x;
    squares += x * x;
    EXPECT_LT(random.index(7), 7U);
  }
  const double mean = sum / kCount;
  EXPECT_NEAR(mean, 3.0, 0.03);
  EXPECT_NEAR(squares / kCount - mean * mean, 4.0, 0.06);
}

TEST(Frames, OriginOfTheBenchRoundTrips) {
  const auto origin = MissionOrigin::make({31.522062, 105.044327, 0.0});
  ASSERT_TRUE(origin);
  const Position<MissionEnu> p{3500.0, 2800.0, 300.0};
  const auto back = origin->to_enu(origin->to_wgs84(p));
  EXPECT_LT((back - p).norm(), 1e-6);
  EXPECT_FALSE(MissionOrigin::make({91.0, 0.0, 0.0}));
}

TEST(Geometry, AdvanceAgreesWithSmallSteps) {
  Random random{3};
  for (int i = 0; i < 200; ++i) {
    const Pose2 start{random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3, 3)};
    const double curvature = i % 5 == 0 ? 0.0 : random.uniform(-0.1, 0.1);
    const double length = random.uniform(0.0, 60.0);
    Pose2 p = start;
    constexpr int kSteps = 20'000;
    for (int k = 0; k < kSteps; ++k) {
      const double ds = length / kSteps;
      const double mid = p.heading_rad + curvature * ds / 2.0;
      p = {p.x_m + ds * std::cos(mid), p.y_m + ds * std::sin(mid), p.heading_rad + curvature * ds};
    }
    const Pose2 q = advance(start, curvature, length);
    EXPECT_NEAR(q.x_m, p.x_m, 1e-5);
    EXPECT_NEAR(q.y_m, p.y_m, 1e-5);
    EXPECT_NEAR(wrap_pi(q.heading_rad - p.heading_rad), 0.0, 1e-9);
  }
}

TEST(Geometry, DistanceToASegmentIsToItsNearestPoint) {
  const Vec2 a{1.0, 1.0};
  const Vec2 b{5.0, 1.0};
  EXPECT_EQ(distance_to_segment({3.0, -1.0}, a, b), 2.0);
  EXPECT_EQ(distance_to_segment({3.0, 1.0}, a, b), 0.0);
  EXPECT_EQ(distance_to_segment({8.0, 5.0}, a, b), 5.0) << "beyond its end";
  EXPECT_EQ(distance_to_segment({-2.0, -3.0}, a, b), 5.0);
  EXPECT_EQ(distance_to_segment({4.0, 5.0}, a, a), 5.0) << "a point";
}

TEST(Geometry, DistanceToPieceAgreesWithSampling) {
  Random random{5};
  for (int i = 0; i < 500; ++i) {
    const Pose2 start{random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3, 3)};
    const double curvature = i % 4 == 0 ? 0.0 : random.uniform(-0.2, 0.2);
    const double length = random.uniform(0.0, 50.0);
    const Vec2 point{random.uniform(-40, 40), random.uniform(-40, 40)};
    double least = 1e9;
    for (int k = 0; k <= 5000; ++k) {
      least = std::min(least,
                       (advance(start, curvature, length * k / 5000.0).position() - point).norm());
    }
    EXPECT_NEAR(distance_to_piece(point, start, curvature, length), least, 0.011);
  }
}

TEST(Shortened, IsNoLongerThanAsked) {
  EXPECT_EQ(shortened(Vec2{3.0, 4.0}, 5.0), Vec2(3.0, 4.0));
  EXPECT_TRUE(shortened(Vec2{6.0, -8.0}, 5.0).isApprox(Vec2(3.0, -4.0), 1e-15));
  EXPECT_EQ(shortened(Vec2{0.0, 0.0}, 0.0), Vec2(0.0, 0.0));
}

TEST(BoundedQueue, RefusesAndCountsWhenFull) {
  BoundedQueue<int> queue{2};
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_FALSE(queue.pop().has_value());
}

TEST(BoundedQueue, KeepsItsOrderAndLimitWhenItIsNeverEmptied) {
  BoundedQueue<int> queue{3};
  EXPECT_TRUE(queue.push(0));
  for (int i = 1; i < 1000; ++i) {
    EXPECT_TRUE(queue.push(2 * i - 1));
    EXPECT_TRUE(queue.push(2 * i));
    EXPECT_FALSE(queue.push(-1));
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.pop(), 2 * i - 2);
    EXPECT_EQ(queue.pop(), 2 * i - 1);
    EXPECT_FALSE(queue.empty());
  }
  EXPECT_EQ(queue.pop(), 1998);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace skein
