// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/elector.hpp"

#include <gtest/gtest.h>

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kLeader{1};
constexpr VehicleId kSelf{2};
constexpr VehicleId kOther{3};
const CoalitionId kCoalition{kLeader, InstanceId{1}, 1};

/// One of three electors, whose leader has fallen silent, and which has claimed the lead.
struct Claimant {
  Claimant() {
    Award award;
    award.round = {kCoalition, 1};
    elector.accepted(award);
    LeaseRenewal renewal;
    renewal.round = award.round;
    renewal.electors = {kLeader, kSelf, kOther};
    now += 1s;
    renewal.sent_at = now;
    elector.on_lease_renewal(renewal, now);
    now += 20s;
    elector.on_timeout(now);
  }
  void is_followed(Instant claimed_at) {
    elector.on_allegiance({kCoalition, kOther, InstanceId{1}, kSelf, claimed_at}, now);
  }

  Elector elector{{}, kSelf, InstanceId{1}};
  Instant now{};
};

TEST(Elector, WinsWithAMajority) {
  Claimant c;
  c.is_followed(c.now);
  ASSERT_TRUE(c.elector.poll_won());
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

TEST(Elector, NobodyAnswersAClaimThatIsStillToCome) {
  Claimant c;
  c.is_followed(c.now + 24h);
  EXPECT_FALSE(c.elector.poll_won());
  EXPECT_EQ(c.elector.bad_messages(), 1U);
}

}  // namespace
}  // namespace skein::coalition
