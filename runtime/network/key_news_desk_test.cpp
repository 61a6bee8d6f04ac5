// SPDX-License-Identifier: Apache-2.0
#include "key_news_desk.hpp"

#include <gtest/gtest.h>

#include "skein/identity/key_change.hpp"

namespace skein::network {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr VehicleId kSelf{0x0102};
constexpr VehicleId kMember{7};

Bytes change(std::uint8_t salt) { return {identity::kChangeMark, 1, 2, salt}; }

TEST(KeyNewsDesk, TellsEachMemberItsOwnUntilItIsHeardUnderTheNewKey) {
  KeyNewsDesk desk{kSelf};
  EXPECT_FALSE(desk.has_any());
  Instant now{};
  EXPECT_FALSE(desk.due(kMember, 1, now));
  desk.tell({{kMember, 2, change(9)}});
  ASSERT_TRUE(desk.has_any());
  const auto first = desk.due(kMember, 1, now);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, (Bytes{identity::kChangeMark, 1, 2, 9, 1, 2}));
  EXPECT_EQ(key_news_sender(*first), kSelf);
  EXPECT_FALSE(desk.due(kMember, 1, now)) << "not with every datagram";
  EXPECT_FALSE(desk.due({8}, 1, now)) << "of no use to others";
  now += KeyNewsDesk::kAgain;
  EXPECT_TRUE(desk.due(kMember, 0, now));
  now += KeyNewsDesk::kAgain;
  EXPECT_FALSE(desk.due(kMember, 2, now));
  desk.tell({});
  EXPECT_FALSE(desk.has_any());
}

TEST(KeyNewsDesk, KeepsOfWhatItHearsLittleAndEachOnce) {
  KeyNewsDesk desk{kSelf};
  for (int round = 0; round < 3; ++round) {
    for (std::uint8_t i = 0; i < 100; ++i) {
      Bytes datagram = change(i);
      datagram.insert(datagram.end(), {0, 3});
      ASSERT_TRUE(is_key_news(datagram));
      desk.hear(datagram);
    }
  }
  for (std::uint8_t i = 0; i < KeyNewsDesk::kHeardMax; ++i) EXPECT_EQ(desk.take(), change(i));
  EXPECT_FALSE(desk.take());
}

TEST(KeyNewsDesk, KnowsNewsByItsMarkAndSize) {
  EXPECT_FALSE(is_key_news({}));
  EXPECT_FALSE(is_key_news(Bytes{identity::kChangeMark, 0, 1}));
  EXPECT_FALSE(is_key_news(Bytes{'R', 'T', 'P', 'S', 2, 3}));
  EXPECT_FALSE(is_key_news(Bytes(identity::kChangeBytesMax + 3, identity::kChangeMark)));
  EXPECT_FALSE(key_news_sender(Bytes{'R', 'T', 'P', 'S', 2, 3}));
}

}  // namespace
}  // namespace skein::network
