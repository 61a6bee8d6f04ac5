// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/elector.hpp"

#include <gtest/gtest.h>

#include <variant>
#include <vector>

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kLeader{1};
constexpr VehicleId kSelf{2};
constexpr VehicleId kOther{3};
constexpr VehicleId kFourth{4};
const CoalitionId kCoalition{kLeader, InstanceId{1}, 1};

/// An elector that has promised to follow its leader.
struct Follower {
  explicit Follower(const std::vector<VehicleId>& electors = {kLeader, kSelf, kOther, kFourth}) {
    Award award;
    award.round = {kCoalition, 1};
    elector.accepted(award);
    LeaseRenewal renewal;
    renewal.round = award.round;
    renewal.electors = electors;
    now += 1s;
    renewal.sent_at = now;
    elector.on_lease_renewal(renewal, now);
  }

  Elector elector{{}, kSelf, InstanceId{1}};
  Instant now{};
};

/// One of three, whose leader has fallen silent, and which has claimed the lead.
struct Claimant : Follower {
  explicit Claimant(const std::vector<VehicleId>& electors = {kLeader, kSelf, kOther})
      : Follower{electors} {
    now += 20s;
    elector.on_timeout(now);
  }
  void is_followed(Instant claimed_at) {
    elector.on_allegiance({kCoalition, kOther, InstanceId{1}, kSelf, claimed_at}, now);
  }
};

TEST(Elector, WinsWithAMajority) {
  Claimant c;
  c.is_followed(c.now);
  ASSERT_TRUE(c.elector.poll_won());
}

TEST(Elector, HalfOfFourIsNoMajority) {
  Claimant c{{kLeader, kSelf, kOther, kFourth}};
  c.is_followed(c.now);
  c.now += 2s;
  c.elector.on_timeout(c.now);
  EXPECT_FALSE(c.elector.poll_won()) << "two of four";
  c.is_followed(c.now);
  c.elector.on_allegiance({kCoalition, kFourth, InstanceId{1}, kSelf, c.now}, c.now);
  EXPECT_TRUE(c.elector.poll_won()) << "three of four";
}

/// The lost leader's leases end a lease after the heartbeat that was answered, by clocks that
/// differ by a guard: until then nobody claims, and nobody follows who does.
TEST(Elector, KeepsItsPromiseForALeaseAndAGuard) {
  const ProtocolParams params;
  const auto claims = [](Elector& elector) {
    bool claimed = false;
    while (const auto message = elector.poll_message()) {
      claimed = claimed || std::holds_alternative<LeadershipClaim>(*message);
    }
    return claimed;
  };
  const auto follows = [](Elector& elector) {
    VehicleId whom;
    while (const auto message = elector.poll_message()) {
      if (const auto* said = std::get_if<Allegiance>(&*message)) whom = said->follows;
    }
    return whom;
  };
  Follower claimant;
  const Instant over = claimant.now + params.lease + params.clock_guard;
  claimant.elector.on_timeout(over - Duration{1});
  EXPECT_FALSE(claims(claimant.elector));
  claimant.elector.on_timeout(over);
  EXPECT_TRUE(claims(claimant.elector));

  Follower follower;
  EXPECT_EQ(follows(follower.elector), kLeader);
  follower.elector.on_claim({kCoalition, kOther, over}, over - Duration{1});
  EXPECT_EQ(follows(follower.elector), VehicleId{}) << "it says nothing";
  follower.elector.on_claim({kCoalition, kOther, over}, over);
  EXPECT_EQ(follows(follower.elector), kOther);
  // And so it follows the claimant, who is lost in turn.
  const Instant again = over + params.lease + params.clock_guard;
  follower.elector.on_claim({kCoalition, kFourth, again}, again - Duration{1});
  EXPECT_EQ(follows(follower.elector), VehicleId{});
  follower.elector.on_claim({kCoalition, kFourth, again}, again);
  EXPECT_EQ(follows(follower.elector), kFourth);
}

TEST(Elector, WhoMayNotLeadAnyMoreDoesNotWin) {
  Claimant before;
  before.elector.set_may_lead(false);
  before.is_followed(before.now);
  EXPECT_FALSE(before.elector.poll_won());

  Claimant after;  // it has won, and nobody has asked yet
  after.is_followed(after.now);
  after.elector.set_may_lead(false);
  EXPECT_FALSE(after.elector.poll_won());
}

TEST(Elector, WhoHasLeftItsCoalitionDoesNotLeadIt) {
  Claimant c;
  c.is_followed(c.now);
  c.elector.leave();
  EXPECT_FALSE(c.elector.poll_won());
}

/// Not so who has followed another: to be counted no more could give the lost leader a majority.
TEST(Elector, SaysThatItFollowsNobodyWhenItIsCancelled) {
  Follower follower;
  (void)follower.elector.poll_message();  // to follow its leader
  follower.elector.cancelled();
  const auto said = follower.elector.poll_message();
  ASSERT_TRUE(said);
  const auto& left = std::get<Allegiance>(*said);
  EXPECT_EQ(left.coalition, kCoalition);
  EXPECT_EQ(left.follows, VehicleId{});
  EXPECT_EQ(left.acknowledges, follower.now);

  Claimant strayed;
  while (strayed.elector.poll_message()) {
  }
  strayed.elector.cancelled();
  EXPECT_FALSE(strayed.elector.poll_message());
}

TEST(Elector, NobodyAnswersAClaimThatIsStillToCome) {
  Claimant c;
  c.is_followed(c.now + 24h);
  EXPECT_FALSE(c.elector.poll_won());
  EXPECT_EQ(c.elector.bad_messages(), 1U);
}

}  // namespace
}  // namespace skein::coalition
