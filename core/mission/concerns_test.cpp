// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/concerns.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

constexpr VehicleId kLeader{1};
constexpr VehicleId kMember{2};
constexpr VehicleId kOther{3};
constexpr coalition::CoalitionId kCoalition{kLeader, InstanceId{9}, 1};
constexpr coalition::Round kRound{kCoalition, 1};

bool is_for(const coalition::Message& message, VehicleId vehicle) {
  return concerns(Message{message}, vehicle);
}

TEST(Concerns, WhatMembersTellTheirLeaderIsForTheLeader) {
  coalition::Bid bid;
  bid.round = kRound;
  bid.bidder = kMember;
  coalition::Confirmation confirmation;
  confirmation.round = kRound;
  confirmation.member = kMember;
  coalition::MemberStatus status;
  status.round = kRound;
  status.member = kMember;
  status.tasks.push_back({TaskId{}, coalition::TaskState::started, Instant{}});
  for (const coalition::Message& message :
       {coalition::Message{bid}, coalition::Message{confirmation}, coalition::Message{status}}) {
    EXPECT_TRUE(is_for(message, kLeader));
    EXPECT_FALSE(is_for(message, kOther));
  }
}

TEST(Concerns, WhatIsDoneIsForAll) {
  coalition::MemberStatus status;
  status.round = kRound;
  status.member = kMember;
  status.tasks.push_back({TaskId{}, coalition::TaskState::done, Instant{}});
  EXPECT_TRUE(is_for(status, kOther));
  status.tasks[0].state = coalition::TaskState::unknown;
  EXPECT_TRUE(is_for(status, kOther));
}

TEST(Concerns, AnAllegianceIsForWhoIsFollowedAndWhoLed) {
  coalition::Allegiance allegiance;
  allegiance.coalition = kCoalition;
  allegiance.elector = VehicleId{4};
  allegiance.follows = kMember;
  EXPECT_TRUE(is_for(allegiance, kLeader));
  EXPECT_TRUE(is_for(allegiance, kMember));
  EXPECT_FALSE(is_for(allegiance, kOther));
}

TEST(Concerns, AllElseIsForAll) {
  coalition::Announcement announcement;
  announcement.round = kRound;
  EXPECT_TRUE(is_for(announcement, kOther));
  EXPECT_TRUE(concerns(Message{Command{}}, kOther));
  EXPECT_TRUE(concerns(Message{Authorisation{}}, kOther));
  EXPECT_TRUE(concerns(Message{mission::Setup{}}, kOther));
}

}  // namespace
}  // namespace skein::mission
