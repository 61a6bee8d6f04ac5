// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/may_say.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

constexpr VehicleId kSelf{3};
constexpr VehicleId kOther{4};
const coalition::Round kRound{{kSelf, InstanceId{9}, 1}, 2};

/// Who of the vehicle, another and the ground station may say it.
struct Sayers {
  bool self, other, ground;
  friend bool operator==(const Sayers&, const Sayers&) = default;
};
Sayers of(const Message& message) {
  return {may_say(message, kSelf), may_say(message, kOther), may_say(message, kGroundStation)};
}

constexpr Sayers kItself{true, false, false};
constexpr Sayers kItselfOrGround{true, false, true};
constexpr Sayers kGroundOnly{false, false, true};

TEST(MaySay, AVehicleSpeaksForItself) {
  Telemetry telemetry;
  telemetry.vehicle = kSelf;
  EXPECT_EQ(of(telemetry), kItself);
  MissionEvent event;
  event.vehicle = kSelf;
  EXPECT_EQ(of(event), kItself);
  event.vehicle = kGroundStation;  // which has events of its own
  EXPECT_EQ(of(event), kGroundOnly);
  FormationStatus status;
  status.vehicle = kSelf;
  EXPECT_EQ(of(status), kItself);
  PlanReport plan;
  plan.vehicle = kSelf;
  EXPECT_EQ(of(plan), kItself);
  Health health;
  health.vehicle = kSelf;
  EXPECT_EQ(of(health), kItself);
  Preflight preflight;
  preflight.vehicle = kSelf;
  EXPECT_EQ(of(preflight), kItself);
}

TEST(MaySay, DecisionsAreSigned) {
  EXPECT_TRUE(is_signed(Command{}));
  EXPECT_TRUE(is_signed(Authorisation{}));
  EXPECT_TRUE(is_signed(Route{}));
  EXPECT_TRUE(is_signed(coalition::Message{coalition::Award{}}));
  EXPECT_TRUE(is_signed(coalition::Message{coalition::Bid{}}));
  EXPECT_TRUE(is_signed(mission::Setup{}));
  EXPECT_FALSE(is_signed(Telemetry{}));
}

TEST(MaySay, ALeaderSpeaksForItsRounds) {
  coalition::Award award;
  award.round = kRound;
  EXPECT_EQ(of(coalition::Message{award}), kItself);
  EXPECT_EQ(of(coalition::Message{coalition::Cancel{kRound, {}}}), kItself);
  AuthorisationRequest request;
  request.round = kRound;
  EXPECT_EQ(of(request), kItself);
}

TEST(MaySay, TheGroundStationPassesOnWhatLeadersAnnounceAndRenew) {
  coalition::Announcement announcement;
  announcement.round = kRound;
  EXPECT_EQ(of(coalition::Message{announcement}), kItselfOrGround);
  coalition::LeaseRenewal renewal;
  renewal.round = kRound;
  EXPECT_EQ(of(coalition::Message{renewal}), kItselfOrGround);
}

TEST(MaySay, AMemberSpeaksForItself) {
  coalition::Bid bid;
  bid.round = {{kOther, {}, 1}, 1};
  bid.bidder = kSelf;
  EXPECT_EQ(of(coalition::Message{bid}), kItself);
  EXPECT_EQ(of(coalition::Message{coalition::Confirmation{bid.round, kSelf, true, {}}}), kItself);
  EXPECT_EQ(of(coalition::Message{coalition::MemberStatus{bid.round, kSelf, {}}}), kItself);
  // The ground station says of deliveries that they are over, as a member of its own number.
  EXPECT_EQ(of(coalition::Message{coalition::MemberStatus{bid.round, kGroundStation, {}}}),
            kGroundOnly);
  coalition::LeadershipClaim claim;
  claim.claimant = kSelf;
  EXPECT_EQ(of(coalition::Message{claim}), kItself);
  coalition::Allegiance allegiance;
  allegiance.elector = kSelf;
  EXPECT_EQ(of(coalition::Message{allegiance}), kItself);
}

TEST(MaySay, OrdersAreTheGroundStations) {
  EXPECT_EQ(of(Command{kSelf, 1, CommandKind::hold}), kGroundOnly);
  EXPECT_EQ(of(Authorisation{kRound, SiteId{1}, true, "x", {}}), kGroundOnly);
  EXPECT_EQ(of(formation::Change{}), kGroundOnly);
}

TEST(MaySay, SensorsAndTheGroundStationTellOfSitesAndHazards) {
  EXPECT_EQ(of(HazardReport{}), kGroundOnly);
  EXPECT_EQ(of(SiteReport{}), kGroundOnly);
  EXPECT_TRUE(may_say(HazardReport{}, kSensors));
  EXPECT_TRUE(may_say(SiteReport{}, kSensors));
  EXPECT_FALSE(may_say(Command{kSelf, 1, CommandKind::hold}, kSensors));
}

}  // namespace
}  // namespace skein::mission
