// SPDX-License-Identifier: Apache-2.0
#include "relay_orbit.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"
#include "skein/base/random.hpp"

namespace skein::mission {
namespace {

constexpr double kReach_m = 400.0;

VehicleAgentConfig standing_by_config() {
  VehicleAgentConfig config = plane_config();
  config.protocol.relay_orbit_m = kReach_m;
  return config;
}

struct Relaying : PartsBench {
  explicit Relaying(const VehicleAgentConfig& config = standing_by_config()) : PartsBench{config} {}

  static coalition::Announcement call(std::uint16_t site, std::uint16_t leader = 7,
                                      double reward = 10.0) {
    coalition::Announcement announcement;
    announcement.round = {{{leader}, {1}, 1}, 1};
    announcement.site = test_site(site);
    announcement.site.position = {3000.0, 2000.0};
    announcement.tasks = tasks_after_survey(announcement.site);
    announcement.reward = reward;
    return announcement;
  }
  void hear(const coalition::Message& message) { relay.on_message(message, now); }
  void comes_to_nothing(const coalition::Announcement& call) {
    hear(call);
    hear(coalition::Cancel{call.round, {coalition::Reason::no_allocation}});
  }
  void stands(const coalition::Announcement& call) {
    coalition::Award award;
    award.round = call.round;
    award.site = call.site;
    hear(award);
    coalition::LeaseRenewal renewal;
    renewal.round = call.round;
    renewal.site = call.site.id;
    renewal.sent_at = now;
    renewal.lease_until = now + std::chrono::seconds{15};
    renewal.electors = {VehicleId{7}};
    hear(renewal);
  }

  RelayOrbit relay{ownship};
};

TEST(RelayPlace, IsTheNearestWithinReachAndNoneWhereTheVehicleIsWithin) {
  Random random{4};
  for (int i = 0; i < 1000; ++i) {
    const Vec2 site{random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3)};
    const Vec2 here{random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3)};
    const double reach_m = random.uniform(1.0, 3e3);
    const double away_m = (here - site).norm();
    const auto place = relay_place(here, site, reach_m);
    ASSERT_EQ(place.has_value(), away_m > reach_m);
    if (!place) continue;
    EXPECT_NEAR((*place - site).norm(), reach_m, 1e-6);
    EXPECT_NEAR((*place - here).norm(), away_m - reach_m, 1e-6);
  }
}

TEST(RelayOrbit, AFreeVehicleGoesWhereALeaderWhoseAttemptFailedReachesItAndStays) {
  Relaying r;
  const auto call = Relaying::call(1);
  r.hear(call);
  EXPECT_FALSE(r.relay.fly(r.now)) << "it may be enough that it bids";
  r.comes_to_nothing(call);
  ASSERT_TRUE(r.relay.fly(r.now));
  EXPECT_EQ(r.ownship.flight().stands_by(), SiteId{1});
  const auto number = r.ownship.flight().plan().number;
  for (double t = 1.0; t < 250.0; t += 1.0) {
    r.be_at(t);
    r.hear(call);
    ASSERT_TRUE(r.relay.fly(r.now));
    const double away_m =
        (r.ownship.flight().pose_at(r.now).position() - call.site.position).norm();
    const double orbit_m = 2.0 * r.ownship.spec().planning_radius_m();
    EXPECT_TRUE(t < 170.0 || away_m < kReach_m + orbit_m) << away_m << " at " << t;
  }
  EXPECT_EQ(r.ownship.flight().plan().number, number) << "it is planned once";
}

TEST(RelayOrbit, WhatWasHeardOnTheWayToAnotherTaskCountsWhenItIsDone) {
  Relaying r;
  auto call = Relaying::call(1);
  call.round.number = 2;
  r.hear(call);
  r.be_at(50.0);
  EXPECT_TRUE(r.relay.fly(r.now));
}

TEST(RelayOrbit, EndsWithTheNeed) {
  const auto call = Relaying::call(1);
  const auto ended_by = [&](const auto& news) {
    Relaying r;
    r.comes_to_nothing(call);
    EXPECT_TRUE(r.relay.fly(r.now));
    news(r);
    return !r.relay.fly(r.now);
  };
  EXPECT_FALSE(ended_by([](Relaying& /*r*/) {}));
  EXPECT_TRUE(ended_by([&](Relaying& r) { r.stands(call); })) << "the coalition stands";
  EXPECT_TRUE(ended_by([&](Relaying& r) { r.relay.close(call.site.id); }));
  EXPECT_TRUE(ended_by([&](Relaying& r) {
    r.hear(coalition::Cancel{call.round, {coalition::Reason::yields}});
  })) << "it is led later";
  EXPECT_TRUE(ended_by([&](Relaying& r) {
    coalition::LeaseRenewal last;
    last.site = call.site.id;
    last.closed = true;
    r.hear(last);
  })) << "the site is done";
  EXPECT_TRUE(ended_by([&](Relaying& r) {
    r.be_at(to_seconds(r.ownship.config().protocol.cut_max));
  })) << "its leader may be lost";
}

TEST(RelayOrbit, AnAwardThatNotAllConfirmEndsNothing) {
  Relaying r;
  auto call = Relaying::call(1);
  r.stands(call);
  call.round.number = 2;
  r.hear(call);
  coalition::Award award;
  award.round = call.round;
  award.site = call.site;
  r.hear(award);
  r.hear(coalition::Cancel{call.round, {coalition::Reason::not_confirmed}});
  coalition::LeaseRenewal renewal;  // of what is left of the first round's coalition
  renewal.round = call.round;
  renewal.site = call.site.id;
  renewal.lease_until = r.now + std::chrono::seconds{15};
  renewal.electors = {VehicleId{7}};
  r.hear(renewal);
  EXPECT_TRUE(r.relay.fly(r.now));
}

TEST(RelayOrbit, OfTwoLeadersAllStandByTheOneThatTheOtherGivesWayTo) {
  Relaying r;
  r.comes_to_nothing(Relaying::call(1, 7, 10.0));
  EXPECT_TRUE(r.relay.fly(r.now));
  r.comes_to_nothing(Relaying::call(2, 9, 20.0));
  EXPECT_TRUE(r.relay.fly(r.now));
  EXPECT_EQ(r.ownship.flight().stands_by(), SiteId{2}) << "the greater reward";
  r.comes_to_nothing(Relaying::call(1, 7, 10.0));
  r.comes_to_nothing(Relaying::call(3, 8, 20.0));
  EXPECT_TRUE(r.relay.fly(r.now));
  EXPECT_EQ(r.ownship.flight().stands_by(), SiteId{3}) << "then the lower id";
}

TEST(RelayOrbit, WhoCanDoNothingThereOrHasNotTheRangeSearchesOn) {
  Relaying carrier;
  carrier.ownship.use_load();
  carrier.comes_to_nothing(Relaying::call(1));
  EXPECT_FALSE(carrier.relay.fly(carrier.now)) << "its load is delivered";

  auto config = standing_by_config();
  config.vehicle.range_m = 3'000.0;
  Relaying tired{config};
  tired.comes_to_nothing(Relaying::call(1));
  EXPECT_FALSE(tired.relay.fly(tired.now)) << "it is 3.6 km away";

  Relaying off{plane_config()};
  off.comes_to_nothing(Relaying::call(1));
  EXPECT_FALSE(off.relay.fly(off.now)) << "unless configured";
}

TEST(RelayOrbit, KeepsClearOfHazards) {
  Random random{9};
  for (int i = 0; i < 200; ++i) {
    auto config = standing_by_config();
    for (std::uint16_t id = 1; id <= 4; ++id) {
      const double bearing = random.uniform(-kPi, kPi);
      const Vec2 centre = Vec2{3000.0, 2000.0} + random.uniform(0.0, 900.0) * unit_vector(bearing);
      config.hazards.push_back({HazardId{id}, centre, random.uniform(20.0, 120.0)});
    }
    Relaying r{config};
    r.comes_to_nothing(Relaying::call(1));
    ASSERT_TRUE(r.relay.fly(r.now));
    EXPECT_TRUE(r.ownship.way_is_open(r.now)) << i;
    r.be_at(200.0);
    for (double t = 200.0; t < 260.0; t += 0.2) {
      for (const Hazard& hazard : config.hazards) {
        const Vec2 at = r.ownship.flight().pose_at(at_seconds(t)).position();
        ASSERT_GT((at - hazard.centre).norm(), hazard.radius_m) << i << " at " << t;
      }
    }
  }
}

}  // namespace
}  // namespace skein::mission
