// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/setup_book.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace skein::mission {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr VehicleId kSeven{7};
constexpr InstanceId kFirst{70};

Instant at(double seconds) { return Instant{} + from_seconds(seconds); }

SetupParams params(const std::string& latitude = "48.1", const std::string& lease = "15") {
  return {.common = {{"origin.latitude_deg", setup_hash(latitude)},
                     {"protocol.lease_s", setup_hash(lease)}}};
}

/// What vehicle 7 says at `sent`, by its own clock.
Setup of_seven(const SetupParams& params, Instant sent, InstanceId instance = kFirst) {
  SetupBook book{params, kSeven, instance, sent};
  return *book.poll_setup({}, sent);
}

TEST(SetupBook, TheKeyThatDiffersIsNamedOnce) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  book.on_setup(of_seven(params(), at(0)), at(0.1));
  EXPECT_EQ(book.difference(kSeven), nullptr);
  EXPECT_FALSE(book.poll_news());

  book.on_setup(of_seven(params("48.2"), at(5)), at(5.1));
  book.on_setup(of_seven(params("48.2"), at(10)), at(10.1));
  ASSERT_NE(book.difference(kSeven), nullptr);
  EXPECT_EQ(book.difference(kSeven)->keys, "origin.latitude_deg");
  EXPECT_EQ(book.poll_news(), EventBody{(event::SetupDiffers{kSeven, "origin.latitude_deg", 0.0})});
  EXPECT_FALSE(book.poll_news()) << "it is news once";

  book.on_setup(of_seven(params(), at(15), InstanceId{71}), at(15.1));
  EXPECT_EQ(book.difference(kSeven), nullptr);
  EXPECT_EQ(book.poll_news(), EventBody{event::SetupAgrees{kSeven}});
}

TEST(SetupBook, KeysOfOtherReleasesAreNotCompared) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  SetupParams newer = params();
  newer.common.push_back({"protocol.hops", setup_hash("3")});
  book.on_setup(of_seven(newer, at(0)), at(0.1));
  EXPECT_EQ(book.difference(kSeven), nullptr);
}

TEST(SetupBook, AClockThatIsAheadIsNoticedByBothSides) {
  SetupBook ground{params(), kGroundStation, {}, at(0)};
  SetupBook vehicle{params(), kSeven, kFirst, at(3)};
  ground.on_setup(*vehicle.poll_setup({}, at(3)), at(0.1));  // 3 s ahead, 0.1 s on the way
  ASSERT_NE(ground.difference(kSeven), nullptr);
  EXPECT_NEAR(ground.difference(kSeven)->clock_ahead_s, 2.9, 1e-9);
  EXPECT_THAT(text_of(*ground.difference(kSeven)), HasSubstr("2.9 s ahead"));

  const auto said = ground.poll_setup({}, at(0.2));
  ASSERT_TRUE(said);
  EXPECT_THAT(said->ahead, ElementsAre(kSeven));
  vehicle.on_setup(*said, at(3.3));
  ASSERT_NE(vehicle.difference(kGroundStation), nullptr);
  EXPECT_THAT(text_of(*vehicle.difference(kGroundStation)), HasSubstr("s behind"));
}

TEST(SetupBook, DelaysAreNotTakenForClocks) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  for (const double delay : {0.0, 0.4, 2.0, 30.0}) {
    const double sent = delay * 10.0;
    book.on_setup(of_seven(params(), at(sent + 0.45)), at(sent + delay));  // within the guard
  }
  EXPECT_EQ(book.difference(kSeven), nullptr);
}

TEST(SetupBook, AClockIsTrustedAgainAfterSeveralSetupsWithinTheGuard) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  book.on_setup(of_seven(params(), at(3)), at(0));
  for (int i = 1; i <= 2; ++i) book.on_setup(of_seven(params(), at(i)), at(i));
  EXPECT_NE(book.difference(kSeven), nullptr) << "those may have come late";
  book.on_setup(of_seven(params(), at(3)), at(3));
  EXPECT_EQ(book.difference(kSeven), nullptr);
}

TEST(SetupBook, SetupsThatWaitedWhileThisProgramStoodStillTellNothingOfTheClock) {
  SetupBook book{params(), kSeven, {}, at(0)};
  const auto ground = [](double sent) {
    auto setup = *SetupBook{params(), kGroundStation, kFirst, at(sent)}.poll_setup({}, at(sent));
    setup.time += from_seconds(3.9);  // ahead
    return setup;
  };
  book.on_setup(ground(1), at(1));
  for (const double sent : {5.0, 10.0, 15.0}) book.on_setup(ground(sent), at(20));
  EXPECT_NE(book.difference(kGroundStation), nullptr);
}

TEST(SetupBook, WhoIsNewIsToldAtOnce) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  ASSERT_TRUE(book.poll_setup({}, at(0)));
  EXPECT_FALSE(book.poll_setup({}, at(1.5)));
  book.on_setup(of_seven(params(), at(2)), at(2));
  EXPECT_LE(book.next_timeout(), at(2));
  EXPECT_TRUE(book.poll_setup({}, at(2)));
  EXPECT_EQ(book.next_timeout(), at(7));
}

TEST(SetupBook, InALargeTeamEachHasNoMoreToJudge) {
  SetupBook book{params(), kGroundStation, {}, at(0)};
  constexpr std::uint16_t kNodes = 4 * SetupBook::kTeam;
  for (std::uint16_t id = 1; id <= kNodes; ++id) {
    mission::Setup other = of_seven(params(), at(0));
    other.node = VehicleId{id};
    book.on_setup(other, at(0.1));
  }
  ASSERT_TRUE(book.poll_setup({}, at(1)));
  EXPECT_FALSE(book.poll_setup({}, at(20.9)));
  EXPECT_TRUE(book.poll_setup({}, at(21))) << "four times the nodes, four times the period";
  mission::Setup anew = of_seven(params(), at(22), InstanceId{71});
  book.on_setup(anew, at(22));
  EXPECT_FALSE(book.poll_setup({}, at(24.9)));
  EXPECT_TRUE(book.poll_setup({}, at(25))) << "sooner where somebody is new";
}

TEST(SetupBook, WhoDoesNotKnowTheOrdersAsksEverySecond) {
  SetupBook book{params(), kSeven, kFirst, at(100)};
  const auto setup = book.poll_setup({.known = false, .newest = 9}, at(100));
  ASSERT_TRUE(setup);
  EXPECT_FALSE(setup->knows_orders);
  EXPECT_EQ(setup->newest_order, 9U);
  EXPECT_EQ(book.next_timeout(), at(101));
}

TEST(SetupBook, TwoProgramsUnderOneNumberAreFoundByWhoHearsBoth) {
  SetupBook book{params(), {3}, InstanceId{30}, at(0)};
  book.on_setup(of_seven(params(), at(0), InstanceId{70}), at(0.1));
  book.on_setup(of_seven(params(), at(2), InstanceId{71}), at(2.1));
  EXPECT_EQ(book.difference(kSeven), nullptr) << "one that was started anew";
  book.on_setup(of_seven(params(), at(5), InstanceId{70}), at(5.1));
  ASSERT_NE(book.difference(kSeven), nullptr);
  EXPECT_EQ(text_of(*book.difference(kSeven)), "another program under its number");
  EXPECT_EQ(book.poll_news(),
            EventBody{(event::SetupDiffers{kSeven, "program under its number", 0.0})});
  for (double t = 7.0; t < 15.0; t += 5.0) {
    book.on_setup(of_seven(params(), at(t), InstanceId{71}), at(t + 0.1));
    book.on_setup(of_seven(params(), at(t + 3.0), InstanceId{70}), at(t + 3.1));
    (void)book.poll_setup({}, at(t + 3.2));
  }
  EXPECT_FALSE(book.poll_news()) << "it is news once";
  book.on_setup(of_seven(params(), at(33), InstanceId{70}), at(33.1));
  (void)book.poll_setup({}, at(40));
  EXPECT_EQ(book.difference(kSeven), nullptr) << "the other has ended";
  EXPECT_EQ(book.poll_news(), EventBody{event::SetupAgrees{kSeven}});
}

TEST(SetupBook, AnotherProgramUnderTheOwnNumberIsFound) {
  SetupBook book{params(), kSeven, kFirst, at(0)};
  book.on_setup(of_seven(params(), at(0)), at(0.1));
  EXPECT_EQ(book.difference(kSeven), nullptr) << "itself";
  book.on_setup(of_seven(params(), at(1), InstanceId{71}), at(1.1));
  ASSERT_NE(book.difference(kSeven), nullptr);
  EXPECT_TRUE(book.poll_news());
  (void)book.poll_setup({}, at(17));
  EXPECT_EQ(book.difference(kSeven), nullptr);
}

TEST(SetupBook, ManyKeysAreCounted) {
  SetupParams ours;
  SetupParams theirs;
  for (int i = 0; i < 40; ++i) {
    const std::string name = "protocol.a_long_name_" + std::to_string(i);
    ours.common.push_back({name, 1});
    theirs.common.push_back({name, 2});
  }
  SetupBook book{ours, kGroundStation, {}, at(0)};
  book.on_setup(of_seven(theirs, at(0)), at(0));
  ASSERT_NE(book.difference(kSeven), nullptr);
  EXPECT_THAT(book.difference(kSeven)->keys, HasSubstr(" more"));
  EXPECT_LE(book.difference(kSeven)->keys.size(), kTextMax);
}

}  // namespace
}  // namespace skein::mission
