// SPDX-License-Identifier: Apache-2.0
// A leader's side to the moment: how far it leases, and from when on a task is another's.
#include "skein/coalition/initiator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "team_test.hpp"

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;
using ::testing::SizeIs;

constexpr VehicleId kSelf{1};
constexpr VehicleId kFirst{2};
constexpr VehicleId kSecond{3};
constexpr InstanceId kStart{1};
const CoalitionId kCoalition{kSelf, kStart, 1};
constexpr Duration kTick{1};

/// A leader whose tasks are all others'.
struct Leader {
  explicit Leader(std::size_t deliveries, std::size_t assessments = 0)
      : self{params, kCoalition, site_with(deliveries, assessments), {}, {}, now} {}

  void hears_bid(VehicleId bidder, std::uint32_t round, InstanceId program = kStart) {
    Bid bid;
    bid.round = {kCoalition, round};
    bid.bidder = bidder;
    bid.instance = program;
    bid.speed_mps = 20.0;
    bid.planning_radius_m = 60.0;
    self.on_bid(bid, now);
  }
  /// What it wants allocated when the time for bids is over.
  std::optional<Initiator::AllocationWanted> bids_close() {
    now = self.announcement().bids_until;
    self.on_timeout(now);
    return newest<Initiator::AllocationWanted>();
  }
  void awards(const std::vector<VehicleId>& owners) {
    std::vector<TaskAssignment> assignments;
    for (std::size_t i = 0; i < owners.size(); ++i) {
      assignments.push_back({task(i), owners[i], now + 60s});
    }
    self.allocated(self.round(), std::move(assignments), now);
  }
  void hears_confirmation(VehicleId member, std::uint32_t round) {
    self.on_confirmation({{kCoalition, round}, member, true, {}}, now);
  }
  /// In its first round, of those.
  void stands(const std::vector<VehicleId>& owners) {
    for (const VehicleId owner : owners) hears_bid(owner, 1);
    ASSERT_TRUE(bids_close());
    awards(owners);
    for (const VehicleId owner : owners) hears_confirmation(owner, 1);
    ASSERT_EQ(self.state(), Initiator::State::executing);
  }
  void hears_allegiance(VehicleId elector, Instant acknowledges) {
    self.on_allegiance({kCoalition, elector, kStart, kSelf, acknowledges}, now);
  }
  /// Its next heartbeat.
  LeaseRenewal renews() {
    (void)newest_message<LeaseRenewal>();
    now += params.heartbeat;
    self.on_timeout(now);
    return newest_message<LeaseRenewal>().value_or(LeaseRenewal{});
  }
  [[nodiscard]] static TaskId task(std::size_t i) {
    return {SiteId{1}, TaskKind::deliver, static_cast<std::uint8_t>(i)};
  }

  template <class Output>
  std::optional<Output> newest() {
    std::optional<Output> found;
    while (const auto output = self.poll_output()) {
      if (const auto* wanted = std::get_if<Output>(&*output)) found = *wanted;
    }
    return found;
  }
  template <class Kind>
  std::optional<Kind> newest_message() {
    std::optional<Kind> found;
    while (const auto message = self.poll_message()) {
      if (const auto* wanted = std::get_if<Kind>(&*message)) found = *wanted;
    }
    return found;
  }

  ProtocolParams params;
  Instant now = Instant{} + 100s;
  Initiator self;
};

TEST(Initiator, ATaskIsAnothersOnlyAGuardAfterItsLease) {
  Leader leader{1};
  leader.stands({kFirst});
  const Instant lease_until = leader.newest_message<Award>()->lease_until;
  const Instant given_up = lease_until + leader.params.clock_guard;
  leader.self.on_timeout(given_up - kTick);
  EXPECT_FALSE(leader.newest<Initiator::TaskLost>());
  leader.self.on_timeout(given_up);
  EXPECT_TRUE(leader.newest<Initiator::TaskLost>());
}

TEST(Initiator, AwardsToTheProgramThatHasBid) {
  Leader leader{2};
  leader.hears_bid(kFirst, 1, {8});
  leader.hears_bid(kSecond, 1, {9});
  ASSERT_TRUE(leader.bids_close());
  leader.awards({kSecond, kFirst});
  EXPECT_EQ(leader.newest_message<Award>()->programs, (std::vector<InstanceId>{{9}, {8}}));
}

TEST(Initiator, KnowsWhatMayBeHeldAfterItIsClosed) {
  Leader leader{2};
  leader.stands({kFirst, kSecond});
  const Instant over = leader.newest_message<Award>()->lease_until + leader.params.clock_guard;
  const Round round{kCoalition, 1};
  leader.self.on_status({round, kSecond, {{Leader::task(1), TaskState::started, leader.now}}},
                        leader.now);
  auto held = leader.self.outstanding();
  ASSERT_EQ(held.size(), 2U);
  EXPECT_EQ(held[0].until, over);
  EXPECT_FALSE(held[0].maybe_flown);
  EXPECT_TRUE(held[1].maybe_flown);
  EXPECT_EQ(held[1].owner, kSecond);
  EXPECT_EQ(held[1].round, round);
  leader.self.on_status({round, kSecond, {{Leader::task(1), TaskState::done, leader.now}}},
                        leader.now);
  EXPECT_EQ(leader.self.outstanding().size(), 1U);
}

/// Two of three choose another leader where they have not heard that this one is closed; one does
/// not.
TEST(Initiator, KnowsWhoMayChooseAnotherLeaderAfterItIsClosed) {
  Leader pair{1};
  pair.stands({kFirst});
  EXPECT_FALSE(pair.self.electorate().may_choose());
  Leader leader{2};
  EXPECT_FALSE(leader.self.electorate().may_choose()) << "nobody follows it yet";
  leader.stands({kFirst, kSecond});
  const Instant heard = leader.renews().sent_at;
  leader.hears_allegiance(kFirst, heard);
  leader.self.close({Reason::held_by_operator}, leader.now);
  auto electorate = leader.self.electorate();
  EXPECT_TRUE(electorate.may_choose());
  EXPECT_EQ(electorate.others.size(), 2U) << "not the leader itself";
  EXPECT_EQ(electorate.promised_until, heard + leader.params.lease);
  EXPECT_EQ(electorate.until, electorate.promised_until + leader.params.cut_max);

  const InstanceId program = electorate.others.at(kFirst).instance;
  const Instant awarded = leader.newest_message<Award>()->awarded_at;
  const Instant now = heard + 2 * kTick;
  electorate.on_allegiance({kCoalition, kFirst, program, {}, awarded}, now);
  electorate.on_allegiance({kCoalition, kFirst, InstanceId{99}, {}, heard}, now);
  electorate.on_allegiance({kCoalition, kFirst, program, kSecond, heard}, now);
  electorate.on_allegiance({kCoalition, kFirst, program, {}, now + kTick}, now);
  electorate.on_allegiance({{kFirst, {1}, 1}, kFirst, program, {}, heard}, now);
  EXPECT_TRUE(electorate.may_choose()) << "none of these is its word for this coalition";
  electorate.on_allegiance({kCoalition, kFirst, program, {}, heard}, now);
  EXPECT_FALSE(electorate.may_choose());
}

/// A renewal reaches as far as half of the electors have promised, and no further.
TEST(Initiator, LeasesNoFurtherThanItsElectorsPromise) {
  Leader leader{2};
  leader.stands({kFirst, kSecond});
  EXPECT_EQ(leader.renews().lease_until, Instant{}) << "nobody has answered yet";
  const Instant answered = leader.now;
  leader.hears_allegiance(kFirst, answered);
  EXPECT_EQ(leader.renews().lease_until, answered + leader.params.lease);
  EXPECT_EQ(leader.renews().lease_until, answered + leader.params.lease);
  const Instant again = leader.now;
  leader.hears_allegiance(kFirst, again);
  EXPECT_EQ(leader.renews().lease_until, again + leader.params.lease);
}

TEST(Initiator, NeedsHalfOfFiveElectorsBesidesItself) {
  Leader leader{4};
  const std::vector<VehicleId> others{kFirst, kSecond, VehicleId{4}, VehicleId{5}};
  leader.stands(others);
  (void)leader.renews();
  leader.hears_allegiance(kFirst, leader.now);
  EXPECT_EQ(leader.renews().lease_until, Instant{}) << "two of five";
  leader.hears_allegiance(kSecond, leader.now);
  EXPECT_GT(leader.renews().lease_until, leader.now) << "three of five";
}

TEST(Initiator, ABidIsOfItsRound) {
  Leader leader{1};
  ASSERT_TRUE(leader.bids_close());
  leader.self.allocation_failed(leader.self.round(), "nobody bids", leader.now);
  leader.now += leader.params.monitoring_interval;
  leader.self.on_timeout(leader.now);
  ASSERT_EQ(leader.self.round().number, 2U);
  leader.hears_bid(kFirst, 1);  // late
  leader.hears_bid(kSecond, 2);
  const auto wanted = leader.bids_close();
  ASSERT_TRUE(wanted);
  ASSERT_THAT(wanted->bids, SizeIs(1));
  EXPECT_EQ(wanted->bids[0].bidder, kSecond);
}

TEST(Initiator, AConfirmationIsOfItsRound) {
  Leader leader{1};
  leader.hears_bid(kFirst, 1);
  ASSERT_TRUE(leader.bids_close());
  leader.awards({kFirst});
  leader.now += 3s;
  leader.self.on_timeout(leader.now);  // nobody has confirmed
  ASSERT_EQ(leader.self.state(), Initiator::State::monitoring);
  leader.now += leader.params.first_lease() + leader.params.monitoring_interval;
  leader.self.on_timeout(leader.now);
  ASSERT_EQ(leader.self.round().number, 2U);
  leader.hears_bid(kFirst, 2);
  ASSERT_TRUE(leader.bids_close());
  leader.awards({kFirst});
  leader.hears_confirmation(kFirst, 1);  // late
  EXPECT_EQ(leader.self.state(), Initiator::State::awarding);
  leader.hears_confirmation(kFirst, 2);
  EXPECT_EQ(leader.self.state(), Initiator::State::executing);
}

/// One task is lost and given away anew; then the owner of the other says that its own failed, by
/// the round that it has it from.
TEST(Initiator, WhatAnOwnerOfAnEarlierRoundGivesBackIsOpen) {
  Leader leader{2};
  leader.stands({kFirst, kSecond});
  const Round first = leader.self.round();
  const auto gives_back = [&](VehicleId owner, std::size_t task) {
    leader.self.on_status({first, owner, {{Leader::task(task), TaskState::failed, leader.now}}},
                          leader.now);
  };
  (void)leader.renews();
  leader.hears_allegiance(kFirst, leader.now);
  leader.hears_allegiance(kSecond, leader.now);
  gives_back(kFirst, 0);
  ASSERT_TRUE(leader.newest<Initiator::TaskLost>());
  (void)leader.renews();
  ASSERT_EQ(leader.self.round().number, 2U) << "the other flies on";
  gives_back(kSecond, 1);
  const auto lost = leader.newest<Initiator::TaskLost>();
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->assignment.task, Leader::task(1));
}

/// A late word of the round before would make of what is planned something that is begun.
TEST(Initiator, WhatWasBegunInAnEarlierRoundIsNotBegunInThisOne) {
  for (const std::uint32_t said_in : {1U, 2U}) {
    Leader leader{1};
    leader.stands({kFirst});
    const auto says = [&](std::uint32_t round, TaskState state) {
      leader.self.on_status({{kCoalition, round}, kFirst, {{Leader::task(0), state, leader.now}}},
                            leader.now);
    };
    (void)leader.renews();
    leader.hears_allegiance(kFirst, leader.now);
    says(1, TaskState::failed);
    (void)leader.renews();
    ASSERT_EQ(leader.self.round().number, 2U);
    leader.hears_bid(kFirst, 2);
    ASSERT_TRUE(leader.bids_close());
    leader.awards({kFirst});
    const auto award = leader.newest_message<Award>();
    ASSERT_TRUE(award);
    leader.hears_confirmation(kFirst, 2);
    says(said_in, TaskState::started);
    leader.self.on_timeout(award->lease_until + leader.params.clock_guard);
    const auto unknown = leader.newest<Initiator::TaskUnknown>();
    EXPECT_EQ(unknown.has_value(), said_in == 2U);
  }
}

/// Both would take what is awarded to their number.
TEST(Initiator, TwoProgramsThatBidUnderOneNumberAreAwardedNothing) {
  Leader leader{1};
  leader.hears_bid(kFirst, 1);
  leader.hears_bid(kSecond, 1);
  leader.hears_bid(kFirst, 1, InstanceId{2});
  auto wanted = leader.bids_close();
  ASSERT_TRUE(wanted);
  ASSERT_EQ(wanted->bids.size(), 1U);
  EXPECT_EQ(wanted->bids.front().bidder, kSecond);

  leader.self.allocation_failed(leader.self.round(), "too few", leader.now);
  leader.now += leader.params.monitoring_interval;
  leader.self.on_timeout(leader.now);
  leader.hears_bid(kFirst, 2, InstanceId{2});
  wanted = leader.bids_close();
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->bids.size(), 1U) << "one of them is gone, or it had started anew";
}

/// In an air that is slower than configured every round would end before its bids are there.
TEST(Initiator, BidsThatCameAfterARoundHadFailedGiveTheNextOneLonger) {
  Leader leader{2};
  const Duration configured = leader.params.message_delay;
  for (const Duration late : {50ms, 600ms, 20'000ms}) {
    const Instant announced = leader.now;
    leader.hears_bid(kFirst, leader.self.round().number);
    ASSERT_TRUE(leader.bids_close());
    const Duration window = leader.now - announced;
    leader.self.allocation_failed(leader.self.round(), "too few", leader.now);
    const Instant again = leader.now + leader.params.monitoring_interval;
    leader.now += late;
    leader.hears_bid(kSecond, leader.self.round().number - 1);
    EXPECT_EQ(2 * leader.self.params().message_delay, window) << "that is of an earlier round";
    leader.hears_bid(kFirst, leader.self.round().number);
    EXPECT_EQ(2 * leader.self.params().message_delay, window) << "a copy of what was in time";
    leader.hears_bid(kSecond, leader.self.round().number);
    EXPECT_GT(2 * leader.self.params().message_delay, window);
    const Duration took = leader.now - announced;
    if (late < 1s) {
      EXPECT_GT(2 * leader.self.params().message_delay, took) << "it would be in time now";
    }
    leader.now = std::max(leader.now, again);
    leader.self.on_timeout(leader.now);
    const Announcement& next = leader.self.announcement();
    EXPECT_EQ(next.bids_until, leader.now + 2 * leader.self.params().message_delay);
    EXPECT_GT(next.formed_at, next.bids_until);
  }
  EXPECT_GT(leader.self.params().message_delay, 2 * configured);
  EXPECT_LT(leader.params.first_lease() + 4 * (leader.self.params().message_delay - configured),
            leader.params.lease)
      << "a lease reaches beyond the award";
}

TEST(Initiator, BidsThatCameWhileItsPlannerFoundNoPlanGiveTheNextRoundLonger) {
  Leader leader{2};
  ASSERT_TRUE(leader.bids_close());
  leader.now += 300ms;
  leader.hears_bid(kFirst, 1);
  const Duration before = leader.self.params().message_delay;
  leader.self.allocation_failed(leader.self.round(), "too few", leader.now);
  EXPECT_GT(leader.self.params().message_delay, before);

  Leader forms{1};
  forms.hears_bid(kFirst, 1);
  ASSERT_TRUE(forms.bids_close());
  forms.now += 300ms;
  forms.hears_bid(kSecond, 1);
  forms.awards({kFirst});
  EXPECT_EQ(forms.self.params().message_delay, before) << "nothing was wrong";
}

/// Its delivery failed and was awarded again, for later: who assesses waits for it at its gate. An
/// owner whose bids come too late would otherwise be asked in round after round, at once.
TEST(Initiator, AnAssessmentIsNotLateBeforeADeliveryThatWasAwardedAgain) {
  Leader leader{1, 1};
  const TaskId delivery = Leader::task(0);
  const TaskId assessment{SiteId{1}, TaskKind::assess, 0};
  const Instant begin = leader.now;
  const auto award = [&](std::vector<TaskAssignment> assignments) {
    leader.self.allocated(leader.self.round(), std::move(assignments), leader.now);
  };
  const auto is_heard_until = [&](Instant end) {
    while (leader.now < end) {
      (void)leader.renews();
      for (const VehicleId member : {kFirst, kSecond}) leader.hears_allegiance(member, leader.now);
    }
  };
  for (const VehicleId member : {kFirst, kSecond}) leader.hears_bid(member, 1);
  ASSERT_TRUE(leader.bids_close());
  award({{delivery, kFirst, begin + 20s}, {assessment, kSecond, begin + 30s}});
  for (const VehicleId member : {kFirst, kSecond}) leader.hears_confirmation(member, 1);
  ASSERT_EQ(leader.self.state(), Initiator::State::executing);
  is_heard_until(begin + 3s);
  const MemberStatus failed{{kCoalition, 1}, kFirst, {{delivery, TaskState::failed, leader.now}}};
  leader.self.on_status(failed, leader.now);
  leader.self.on_timeout(leader.now);
  ASSERT_EQ(leader.self.round().number, 2U);
  leader.hears_bid(kFirst, 2);
  ASSERT_TRUE(leader.bids_close());
  award({{delivery, kFirst, begin + 60s}});
  leader.hears_confirmation(kFirst, 2);
  ASSERT_EQ(leader.self.state(), Initiator::State::executing);

  is_heard_until(begin + 62s);
  EXPECT_EQ(leader.self.round().number, 2U) << "it waits for its delivery";
  const MemberStatus done{{kCoalition, 2}, kFirst, {{delivery, TaskState::done, begin + 60s}}};
  leader.self.on_status(done, leader.now);
  is_heard_until(begin + 80s);
  EXPECT_GE(leader.self.round().number, 3U) << "now it is late";
}

}  // namespace
}  // namespace skein::coalition
