// SPDX-License-Identifier: Apache-2.0
// An elector leaves its coalition, its program starts anew, and it is awarded a task there again:
// what was said before that award must give nobody a majority.
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "skein/base/contains.hpp"
#include "team_test.hpp"

namespace skein::coalition {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kLeader{1};
constexpr VehicleId kRejoins{2};
constexpr VehicleId kOther{3};

bool names_who_rejoins(const Message& message) {
  const auto* renewal = std::get_if<LeaseRenewal>(&message);
  return renewal != nullptr && contains(renewal->electors, kRejoins);
}

bool says_that_it_leaves(const Message& message) {
  const auto* allegiance = std::get_if<Allegiance>(&message);
  return allegiance != nullptr && allegiance->follows == VehicleId{};
}

Duration late_word_of_leaving(const Message& message, VehicleId /*to*/) {
  return says_that_it_leaves(message) ? Duration{1500ms} : Duration{50ms};
}

/// Three vehicles with a delivery each, of which the second goes and comes back.
struct Rejoining {
  Rejoining() {
    team.task_takes = 20s;
    team.all_or_none = false;
    team.fault = [this](const Message& message, VehicleId to) {
      note(message);
      // The other elector does not hear that there are fewer.
      const bool heartbeat = std::holds_alternative<LeaseRenewal>(message);
      if (to == kOther && heartbeat && !names_who_rejoins(message)) return 0;
      return to == kRejoins && names_who_rejoins(message) ? copies_of_heartbeats : 1;
    };
  }

  /// It gives its delivery up on the very heartbeat that it answers by its leaving, and its program
  /// starts anew: nobody but the new one bids for it.
  void goes_and_comes_back() {
    ASSERT_TRUE(team.run_until([&] { return named_at.has_value(); }, 3s));
    team.run_for(500ms);
    team.unwilling = {kLeader, kOther};
    named_at.reset();
    ASSERT_TRUE(team.run_until([&] { return named_at.has_value(); }, 2s));
    team.vehicle(kRejoins.value).withdraw(Reason::task_failed, team.now);
    ASSERT_TRUE(team.run_until([&] { return has_left; }, 200ms));
    team.restart(kRejoins);
    team.run_for(1s);
    ASSERT_EQ(team.vehicle(kRejoins.value).state(), Participant::State::member);
    ASSERT_EQ(team.leader().round().number, 2U);
    team.run_for(1500ms);  // by now whatever was late is there
    team.unwilling.clear();
  }

  /// For less than cut_max.
  void loses_its_leader() {
    team.cut = [](VehicleId from, VehicleId to) { return (from == kLeader) != (to == kLeader); };
    team.run_for(45s);
    EXPECT_EQ(team.lease_conflicts, 0);
    for (const auto& [task, times] : team.flown) EXPECT_EQ(times, 1) << to_string(task);
  }

  void note(const Message& message) {
    if (names_who_rejoins(message)) named_at = team.now;
    const auto* renewal = std::get_if<LeaseRenewal>(&message);
    if (renewal != nullptr && renewal->round.coalition.leader == kLeader) stood = stands(*renewal);
    has_left = has_left || says_that_it_leaves(message);
    if (const auto* award = std::get_if<Award>(&message)) {
      if (award->continues != CoalitionId{}) succeeded_by.insert(award->round.coalition);
    }
  }

  Team team{3, site_with(3, 0)};
  std::optional<Instant> named_at;  ///< the newest heartbeat that names it as an elector
  bool has_left = false;
  bool stood = false;  ///< the coalition, by its founder's newest heartbeat
  std::set<CoalitionId> succeeded_by;
  int copies_of_heartbeats = 1;  ///< to it
};

TEST(Rejoining, TheLateWordOfAnEarlierStartThatItLeavesTakesNoVote) {
  Rejoining r;
  r.team.delay = late_word_of_leaving;
  r.goes_and_comes_back();
  r.loses_its_leader();
  EXPECT_EQ(r.succeeded_by.size(), 1U) << "two of three electors";
  EXPECT_EQ(r.team.flown.size(), 3U);
}

TEST(Rejoining, ALateHeartbeatOfBeforeItsAwardGivesNoVote) {
  Rejoining r;
  r.copies_of_heartbeats = 2;
  bool first = false;
  r.team.delay = [&](const Message& message, VehicleId to) {
    if (to != kRejoins || !names_who_rejoins(message)) return Duration{50ms};
    first = !first;
    return first ? Duration{50ms} : Duration{1500ms};
  };
  r.goes_and_comes_back();
  r.loses_its_leader();
  EXPECT_TRUE(r.succeeded_by.empty()) << "one of two electors";
}

/// What it had promised a claimant by its earlier start it does not know.
TEST(Rejoining, ALeaderHasNoVoteOfWhoHasStartedAnew) {
  Rejoining r;
  r.team.delay = late_word_of_leaving;
  r.goes_and_comes_back();
  EXPECT_TRUE(r.stood) << "with the other elector";
  r.team.silent = {kOther};
  r.team.run_for(r.team.params.lease + r.team.params.heartbeat);
  EXPECT_FALSE(r.stood);
  r.team.silent.clear();
  r.team.run_for(2 * r.team.params.heartbeat);
  EXPECT_TRUE(r.stood);
}

TEST(Rejoining, ASuccessorsElectorsAreThoseThatFollowedIt) {
  const ProtocolParams params;
  const InstanceId earlier{1};
  const InstanceId later{2};
  Instant now = Instant{} + 60s;
  Elector::Won won;
  won.plan.round = {{kLeader, earlier, 1}, 1};
  won.plan.site = site_with(3, 0);
  won.majority = 3;  // of five
  won.promised_from = now;
  std::uint8_t task = 0;
  for (const VehicleId vehicle : {kRejoins, kOther, VehicleId{4}}) {
    won.supporters.push_back({vehicle, earlier});
    won.plan.assignments.push_back(
        {{won.plan.site.id, TaskKind::deliver, task++}, vehicle, now + 60s});
  }
  const CoalitionId coalition{kRejoins, earlier, 1};
  Initiator successor{params, coalition, won, false, Vec2{}, now};
  for (const auto& [vehicle, instance] : won.supporters) {
    successor.on_confirmation({{coalition, 1}, vehicle, true, {}}, now);
  }
  const auto stands_after = [&](InstanceId instance) {
    successor.on_allegiance({coalition, kOther, instance, kRejoins, now}, now);
    now += params.heartbeat;
    successor.on_timeout(now);
    bool stood = false;
    while (const auto message = successor.poll_message()) {
      if (const auto* renewal = std::get_if<LeaseRenewal>(&*message)) stood = stands(*renewal);
    }
    return stood;
  };
  EXPECT_FALSE(stands_after(later));
  EXPECT_TRUE(stands_after(earlier));
}

}  // namespace
}  // namespace skein::coalition
