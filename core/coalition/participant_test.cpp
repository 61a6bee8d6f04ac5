// SPDX-License-Identifier: Apache-2.0
// A member's side to the moment: until when it owns a task, and what counts for that.
#include "skein/coalition/participant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <variant>

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kLeader{1};
constexpr VehicleId kSelf{2};
const CoalitionId kCoalition{kLeader, InstanceId{1}, 1};
const TaskId kTask{SiteId{1}, TaskKind::deliver, 0};
constexpr Duration kTick{1};

/// The newest output of that kind since the last look.
template <class Output>
std::optional<Output> newest(Participant& member) {
  std::optional<Output> found;
  while (const auto output = member.poll_output()) {
    if (const auto* wanted = std::get_if<Output>(&*output)) found = *wanted;
  }
  return found;
}

/// Who bids in a round, and is awarded a task.
struct Member {
  void is_called(std::uint32_t round) {
    call.round = {kCoalition, round};
    call.announced_at = now;
    call.bids_until = now + 2 * params.message_delay;
    call.formed_at = now + params.formation_time();
    call.tasks = {kTask};
    self.on_announcement(call, now);
  }
  void bids() {
    const auto wanted = newest<Participant::BidWanted>(self);
    ASSERT_TRUE(wanted);
    self.bid(wanted->announcement, Bid{}, now);
  }
  void is_awarded() {
    award.round = call.round;
    award.awarded_at = now;
    award.lease_until = now + params.first_lease();
    award.assignments = {{kTask, kSelf, now + 60s}};
    self.on_award(award, now);
  }
  void is_member_of(std::uint32_t round) {
    is_called(round);
    bids();
    is_awarded();
    ASSERT_TRUE(newest<Participant::AwardReceived>(self));
    self.accept(now);
    ASSERT_EQ(self.state(), Participant::State::member);
  }
  [[nodiscard]] LeaseRenewal renewal(std::uint32_t round, Instant sent_at) const {
    LeaseRenewal renewal;
    renewal.round = {kCoalition, round};
    renewal.members = {kSelf};
    renewal.sent_at = sent_at;
    renewal.lease_until = award.lease_until + 10s;
    return renewal;
  }
  [[nodiscard]] bool owns_until(Instant end) const {
    return self.holds(kTask, now, end) && !self.holds(kTask, now, end + kTick);
  }

  ProtocolParams params;
  Participant self{params, kSelf, InstanceId{1}};
  Announcement call;
  Award award;
  Instant now = Instant{} + 100s;
};

TEST(Participant, OwnsATaskUntilItsLeaseEndsAndNoLonger) {
  Member m;
  m.is_member_of(1);
  const Instant end = m.award.lease_until;
  EXPECT_TRUE(m.owns_until(end));
  (void)newest<Participant::LeaseEnded>(m.self);
  m.self.on_timeout(end - kTick);
  EXPECT_FALSE(newest<Participant::LeaseEnded>(m.self));
  m.self.on_timeout(end);
  EXPECT_TRUE(newest<Participant::LeaseEnded>(m.self));
  EXPECT_FALSE(m.self.holds(kTask, end, end));
}

/// It has it flown, so who assesses waits for that.
TEST(Participant, WhatAnotherLeaderTakesForFlownPerhapsIsNotOverWhereItsOwnDoesNot) {
  Member m;
  m.is_member_of(1);
  const TaskId delivery{kTask.site, TaskKind::deliver, 7};
  LeaseRenewal other = m.renewal(1, m.now);
  other.round.coalition.leader = VehicleId{9};
  other.unknown = {delivery};
  m.self.on_lease_renewal(other, m.now);
  EXPECT_TRUE(m.self.over(delivery));
  LeaseRenewal own = m.renewal(1, m.now + 1s);
  own.site = kTask.site;
  own.unknown = {delivery};
  m.self.on_lease_renewal(own, m.now + 1s);
  EXPECT_TRUE(m.self.over(delivery)) << "its own leader takes it so, too";
  own = m.renewal(1, m.now + 2s);
  own.site = kTask.site;
  m.self.on_lease_renewal(own, m.now + 2s);
  EXPECT_FALSE(m.self.over(delivery));

  m.self.on_lease_renewal(other, m.now + 3s);
  own = m.renewal(1, m.now + 4s);
  own.site = kTask.site;
  own.done = {delivery};
  m.self.on_lease_renewal(own, m.now + 4s);
  ASSERT_TRUE(m.self.over(delivery)) << "it has been flown meanwhile";
  EXPECT_EQ(m.self.over(delivery)->since, m.now + 4s);
}

/// In slow air its leader gives a round longer than it would itself.
TEST(Participant, WaitsForItsAwardAsLongAsItsLeaderTakesForARound) {
  for (const Duration takes : {Duration{1400ms}, Duration{3s}, Duration{9min}}) {
    Member m;
    m.is_called(1);
    m.call.round.number = 2;
    m.call.formed_at = m.now + takes;
    m.self.on_announcement(m.call, m.now);
    m.bids();
    const Instant until = m.call.formed_at + std::min(takes, m.params.lease);
    m.self.on_timeout(until - kTick);
    EXPECT_EQ(m.self.state(), Participant::State::bidding);
    m.self.on_timeout(until);
    EXPECT_EQ(m.self.state(), Participant::State::free);
  }
}

/// So it knows soon that nobody holds what it awarded.
TEST(Participant, TellsALeaderThatLeadsAgainLaterWhatItHasGivenUp) {
  for (const Reason why : {Reason::held_by_operator, Reason::site_withdrawn}) {
    Member m;
    m.is_member_of(1);
    while (m.self.poll_message()) {
    }
    m.self.on_cancel({m.call.round, {why}}, m.now);
    m.now += m.params.heartbeat;
    m.self.on_timeout(m.now);
    std::optional<TaskState> told;
    while (const auto message = m.self.poll_message()) {
      if (const auto* status = std::get_if<MemberStatus>(&*message)) {
        told = status->tasks.front().state;
      }
    }
    const bool is_led_again = why == Reason::held_by_operator;
    EXPECT_EQ(told, is_led_again ? std::optional{TaskState::failed} : std::nullopt);
  }
}

TEST(Participant, AnAwardThatComesAfterItsLeaseIsNone) {
  Member m;
  m.is_called(1);
  m.bids();
  m.award.round = m.call.round;
  m.award.awarded_at = m.now;
  m.award.lease_until = m.now + 1s;
  m.award.assignments = {{kTask, kSelf, m.now + 60s}};
  m.self.on_award(m.award, m.award.lease_until);
  const auto released = newest<Participant::Released>(m.self);
  ASSERT_TRUE(released);
  EXPECT_EQ(released->why.reason, Reason::award_too_late);
  EXPECT_TRUE(m.self.free());
}

TEST(Participant, AnAwardToAnotherProgramOfItsNumberIsNotItsOwn) {
  Member m;
  m.is_called(1);
  m.bids();
  m.award.programs = {InstanceId{2}};
  m.is_awarded();
  const auto released = newest<Participant::Released>(m.self);
  ASSERT_TRUE(released);
  EXPECT_EQ(released->why.reason, Reason::not_needed);
  EXPECT_TRUE(m.self.free());
  m.award.programs = {InstanceId{1}};
  m.is_member_of(2);
}

TEST(Participant, ARenewalProlongsTheLeasesOfItsRound) {
  Member m;
  m.is_member_of(2);
  m.self.on_lease_renewal(m.renewal(1, m.now + 1s), m.now + 1s);
  EXPECT_TRUE(m.owns_until(m.award.lease_until)) << "of an earlier round";
  m.self.on_lease_renewal(m.renewal(2, m.award.awarded_at), m.now + 1s);
  EXPECT_TRUE(m.owns_until(m.award.lease_until)) << "said no later than the award";
  m.self.on_lease_renewal(m.renewal(2, m.award.awarded_at + kTick), m.now + 1s);
  EXPECT_TRUE(m.owns_until(m.award.lease_until + 10s));
}

TEST(Participant, ARenewalThatDoesNotNameItProlongsNothing) {
  Member m;
  m.is_member_of(1);
  LeaseRenewal renewal = m.renewal(1, m.now + 1s);
  renewal.members = {VehicleId{3}};
  m.self.on_lease_renewal(renewal, m.now + 1s);
  EXPECT_TRUE(m.owns_until(m.award.lease_until));
}

/// By the leader's clock it may still be time.
TEST(Participant, BidsAsLongAsTheLeaderMayTakeIt) {
  const ProtocolParams params;
  for (const Duration late : {params.clock_guard - kTick, params.clock_guard}) {
    Member m;
    m.call.round = {kCoalition, 1};
    m.call.bids_until = m.now + 400ms;
    m.call.formed_at = m.now + 1s;
    m.call.tasks = {kTask};
    m.self.on_announcement(m.call, m.call.bids_until + late);
    EXPECT_EQ(newest<Participant::BidWanted>(m.self).has_value(), late < params.clock_guard);
  }
}

}  // namespace
}  // namespace skein::coalition
