// SPDX-License-Identifier: Apache-2.0
// Messages whose values are within their limits, and make no sense.
#include <gtest/gtest.h>

#include "skein/coalition/initiator.hpp"
#include "skein/coalition/participant.hpp"

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kLeader{1};
constexpr VehicleId kMember{2};
const CoalitionId kCoalition{kLeader, InstanceId{1}, 1};

Site one_delivery() {
  Site site;
  site.id = SiteId{1};
  site.deliveries.resize(1);
  return site;
}

Bid good_bid(const Round& round, VehicleId bidder) {
  Bid bid;
  bid.round = round;
  bid.bidder = bidder;
  bid.speed_mps = 20.0;
  bid.planning_radius_m = 60.0;
  return bid;
}

TEST(Values, ABidWithoutSpeedOrTurnRadiusIsNone) {
  Initiator leader{{}, kCoalition, one_delivery(), {}, {0.0, 0.0}, Instant{}};
  Bid still = good_bid(leader.round(), {3});
  still.speed_mps = 0.0;
  Bid pivot = good_bid(leader.round(), {4});
  pivot.planning_radius_m = 0.0;
  Bid tiny = good_bid(leader.round(), {5});
  tiny.speed_mps = 1e-300;
  for (const Bid& bid : {still, pivot, tiny, good_bid(leader.round(), kMember)}) {
    leader.on_bid(bid, Instant{} + 10ms);
  }
  EXPECT_EQ(leader.tally().bad_messages, 3U);
  leader.on_timeout(Instant{} + 1s);
  const auto output = leader.poll_output();
  ASSERT_TRUE(output);
  const auto* wanted = std::get_if<Initiator::AllocationWanted>(&*output);
  ASSERT_NE(wanted, nullptr);
  ASSERT_EQ(wanted->bids.size(), 1U);
  EXPECT_EQ(wanted->bids.front().bidder, kMember);
}

Announcement call(Instant now) {
  Announcement message;
  message.round = {kCoalition, 1};
  message.site = one_delivery();
  message.tasks = {{{1}, TaskKind::deliver, 0}};
  message.announced_at = now;
  message.bids_until = now + 400ms;
  message.formed_at = now + 1400ms;
  return message;
}

TEST(Values, AnAnnouncementOfAnotherTimeKeepsNobodyWaiting) {
  Participant member{{}, kMember, InstanceId{1}};
  Announcement reversed = call(Instant{} + 5s);
  reversed.formed_at = reversed.bids_until - 1ms;
  Announcement later = call(Instant{} + 24h);
  for (const Announcement& message : {reversed, later}) {
    member.on_announcement(message, Instant{} + 5s);
    EXPECT_FALSE(member.poll_output());
  }
  EXPECT_EQ(member.tally().bad_messages, 2U);
  member.on_announcement(call(Instant{} + 5s), Instant{} + 5s);
  EXPECT_TRUE(member.poll_output());
}

/// With a clock guard longer than the first lease a copy comes in time for a bid.
TEST(Values, ALateCopyOfItsOwnRoundIsNothingNewToWhoAwaitsASuccessor) {
  ProtocolParams params;
  params.clock_guard = 60s;
  Participant member{params, kMember, InstanceId{1}};
  const Announcement announcement = call(Instant{});
  member.on_announcement(announcement, Instant{});
  ASSERT_TRUE(member.poll_output());
  member.bid(announcement, good_bid(announcement.round, kMember), Instant{});
  Award award;
  award.round = announcement.round;
  award.site = announcement.site;
  award.formed_at = announcement.formed_at;
  award.assignments = {{announcement.tasks.front(), kMember, Instant{} + 40s}};
  award.lease_until = Instant{} + 3s;
  member.on_award(award, Instant{} + 500ms);
  ASSERT_TRUE(member.poll_output());
  member.accept(Instant{} + 500ms);
  LeaseRenewal renewal;
  renewal.round = award.round;
  renewal.members = {kMember};
  renewal.electors = {kLeader, kMember, {3}};
  renewal.sent_at = Instant{} + 1s;
  renewal.lease_until = Instant{} + 4s;
  member.on_lease_renewal(renewal, Instant{} + 1s);
  member.on_timeout(Instant{} + 5s);
  ASSERT_EQ(member.state(), Participant::State::orphaned);
  while (member.poll_output()) {
  }
  member.on_announcement(announcement, Instant{} + 6s);
  EXPECT_FALSE(member.poll_output());
  // Of whoever leads the site now it is.
  Announcement other = call(Instant{} + 6s);
  other.round.coalition.leader = {3};
  member.on_announcement(other, Instant{} + 6s);
  EXPECT_TRUE(member.poll_output());
}

}  // namespace
}  // namespace skein::coalition
