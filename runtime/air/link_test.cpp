// SPDX-License-Identifier: Apache-2.0
#include "skein/air/link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "links_test.hpp"
#include "skein/base/random.hpp"

namespace skein::air {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Link, ATeamFindsItself) {
  for (const std::uint16_t count : std::vector<std::uint16_t>{2, 33, 128}) {
    Air air{count};
    air.loss = 0.1;
    for (std::uint16_t id = 0; id < count; ++id) air.add(id);
    EXPECT_TRUE(air.run_until(at_seconds(count <= 33 ? 2.0 : 5.0), [&] {
      return all_found(air, count);
    })) << count;

    const auto all_certified = [&] {
      for (std::size_t i = 0; i < count; ++i) {
        if (air.certified(i).size() != count - 1U) return false;
      }
      return true;
    };
    EXPECT_TRUE(air.run_until(air.now + 5s, all_certified)) << count;
  }
}

TEST(Link, WhatIsReliableArrivesOnceAndInOrderThoughHalfGetsLost) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Air air{seed};
    air.add(1);
    air.add(2);
    air.add(3);
    air.run(2s);
    air.loss = 0.5;
    for (int i = 0; i < 100; ++i) {
      air.say(0, kOrders, "m" + std::to_string(i));
      air.run(50ms);
    }
    air.run(10s);
    EXPECT_EQ(air.texts(1, kOrders, 1), numbered(0, 100)) << seed;
    EXPECT_EQ(air.texts(2, kOrders, 1), numbered(0, 100)) << seed;
    EXPECT_EQ(air.link(1).counts().lost, 0U);
  }
}

TEST(Link, TheLastOneIsRepairedThoughNothingFollows) {
  Air air;
  air.add(1);
  air.add(2);
  air.run(2s);
  air.loss = 1.0;
  air.say(0, kOrders, "last");
  air.run(10ms);
  air.loss = 0.0;
  air.run(1200ms);
  EXPECT_THAT(air.texts(1, kOrders, 1), ElementsAre("last"));
}

TEST(Link, ATeamOfWhichHalfIsLostLosesNothingForGood) {
  for (const Duration delay : {Duration{2ms}, Duration{100ms}}) {
    Air air;
    air.delay_max = delay;
    constexpr std::uint16_t kNodes = 16;
    for (std::uint16_t id = 0; id < kNodes; ++id) air.add(id);
    air.run(3s);
    air.loss = 0.5;
    for (int i = 0; i < 20; ++i) {
      for (std::uint16_t node = 0; node < kNodes; ++node) {
        air.say(node, kOrders, "m" + std::to_string(i));
      }
      air.run(1s);
    }
    air.run(16s);
    EXPECT_EQ(air.sum(&LinkCounts::lost), 0U);
    for (std::size_t to = 0; to < kNodes; ++to) {
      for (std::uint16_t of = 0; of < kNodes; ++of) {
        if (of == to) continue;
        EXPECT_EQ(air.texts(to, kOrders, of), numbered(0, 20)) << to << " of " << of;
      }
    }
  }
}

/// Where the way takes now longer and now less, what is overtaken is not what is lost.
TEST(Link, WhatOnlyComesLateIsHardlyAskedFor) {
  for (const double loss : {0.0, 0.02}) {
    Air air;
    air.loss = loss;
    air.delay_max = 100ms;
    constexpr std::uint16_t kNodes = 20;
    constexpr int kSaid = 600;
    for (std::uint16_t id = 0; id < kNodes; ++id) air.add(id);
    air.run(5s);
    Random random{1};
    for (int i = 0; i < kSaid; ++i) {
      for (std::uint16_t node = 0; node < kNodes; ++node) {
        if (random.chance(0.5)) air.say(node, kOrders, std::string(200, 'x'));
      }
      air.run(50ms);
    }
    air.run(5s);
    const double said = 0.5 * kSaid * kNodes;
    // Of a part that somebody has missed.
    const double needed = said * (1.0 - std::pow(1.0 - loss, kNodes - 1));
    EXPECT_LT(static_cast<double>(air.sum(&LinkCounts::repairs)), 1.3 * needed + 0.05 * said)
        << loss;
    EXPECT_EQ(air.sum(&LinkCounts::lost), 0U);
  }
}

TEST(Link, ALongSampleIsCutAndJoined) {
  Air air;
  air.loss = 0.3;
  air.add(1);
  air.add(2);
  air.run(2s);
  std::string text(Link::kSampleMax, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 26);
  air.say(0, kOrders, text);
  air.say(0, kOrders, "short");
  air.say(0, kMotion, text);
  air.run(5s);
  EXPECT_THAT(air.texts(1, kOrders, 1), ElementsAre(text, "short"));
  EXPECT_THAT(air.texts(1, kMotion, 1), ElementsAre(text));
  EXPECT_FALSE(air.link(0).send(kOrders, std::vector<std::uint8_t>(Link::kSampleMax + 1), air.now));
}

TEST(Link, WhatWasOvertakenIsNotToldAfterTheNewer) {
  Air air;
  air.add(1);
  const Author other{VehicleId{2}, InstanceId{7}};
  const auto hear = [&](std::uint64_t counter, std::uint16_t newest, const std::string& text) {
    const std::vector<std::uint8_t> said{text.begin(), text.end()};
    std::vector<std::uint8_t> content;
    write(content, Head{newest, 3, false});
    write(content, SampleFrame{kMotion, said});
    write(content, PartFrame{kOrders, newest, true, true, false, said});
    air.link(0).hear({other, counter, content}, content, air.now);
  };
  hear(5, 10, "first");
  hear(8, 12, "third");
  hear(6, 11, "second");
  EXPECT_THAT(air.texts(0, kMotion, 2), ElementsAre("first", "third"));
  EXPECT_THAT(air.texts(0, kOrders, 2), ElementsAre("first", "second", "third"));
}

TEST(Link, WhatIsReadyTogetherGoesTogether) {
  Air air;
  air.add(1);
  air.add(2);
  air.run(2s);
  const auto before = air.link(0).counts().datagrams;
  for (int i = 0; i < 10; ++i) air.say(0, kEvents, "m" + std::to_string(i));
  air.say(0, kMotion, "here");
  air.say(0, kOrders, "now");
  air.run(20ms);
  EXPECT_EQ(air.link(0).counts().datagrams - before, 1U);
  EXPECT_THAT(air.texts(1, kEvents, 1), numbered(0, 10));
}

TEST(Link, OneWhoCameLateHearsWhatIsSaidFromThenOn) {
  Air air;
  air.add(1);
  air.add(2);
  air.run(2s);
  air.say(0, kOrders, "before");
  air.run(1s);
  const auto late = air.add(3);
  ASSERT_TRUE(air.run_until(air.now + 1s, [&] { return all_found(air, 3); }));
  air.say(0, kOrders, "after");
  air.run(1s);
  EXPECT_THAT(air.texts(late, kOrders, 1), ElementsAre("after"));
}

TEST(Link, HalvesThatMeetAgainRepairTheLastSeconds) {
  Air air;
  air.add(1);
  air.add(2);
  air.run(2s);
  air.apart = [](auto, auto) { return true; };
  for (int i = 0; i < 10; ++i) {
    air.say(0, kOrders, "m" + std::to_string(i));
    air.run(1s);
  }
  air.apart = [](auto, auto) { return false; };
  air.run(2s);
  EXPECT_EQ(air.texts(1, kOrders, 1), numbered(0, 10));
  // What is older is gone, and nobody waits for it.
  air.apart = [](auto, auto) { return true; };
  for (int i = 10; i < 60; ++i) {
    air.say(0, kOrders, "m" + std::to_string(i));
    air.run(1s);
  }
  air.apart = [](auto, auto) { return false; };
  ASSERT_TRUE(
      air.run_until(air.now + 2s, [&] { return air.texts(1, kOrders, 1).back() == "m59"; }));
  const auto texts = air.texts(1, kOrders, 1);
  EXPECT_GE(texts.size(), 23U);
  EXPECT_LE(texts.size(), 27U);
}

TEST(Link, AnotherStartOfANodeIsAnotherAuthor) {
  Air air;
  air.add(1, 7);
  const auto other = air.add(2);
  air.run(2s);
  air.say(0, kOrders, "old");
  air.run(1s);
  air.remove(0);
  const auto anew = air.add(1, 8);
  air.run(1s);
  air.say(anew, kOrders, "new");
  air.run(1s);
  EXPECT_THAT(air.texts(other, kOrders, 1), ElementsAre("old", "new"));
  air.run(Link::kPeerFor);
  const std::vector<LinkPeer> only{{{VehicleId{1}, InstanceId{8}}, 1}};
  EXPECT_EQ(air.link(other).peers(air.now), only);
}

TEST(Link, ALimitIsKeptAndReportsGiveWayFirst) {
  Air air;
  const auto slow = air.add(1, 7, 1000.0);
  air.add(2);
  air.run(3s);
  const auto before = air.link(slow).counts().bytes;
  for (int i = 0; i < 300; ++i) {
    air.say(slow, kMotion, std::string(150, 'p'));
    air.say(slow, kEvents, std::string(100, 'e'));
    if (i % 10 == 0) air.say(slow, kOrders, "m" + std::to_string(i / 10));
    air.run(100ms);
  }
  EXPECT_LE(air.link(slow).counts().bytes - before, 31'000U + 1'300U);
  EXPECT_EQ(air.texts(1, kOrders, 1), numbered(0, 30));
  EXPECT_GT(air.texts(1, kMotion, 1).size(), 60U);
  EXPECT_LT(air.texts(1, kEvents, 1).size(), 30U);
  EXPECT_GT(air.link(slow).counts().gave_way, 0U);
  // Decisions do not wait for the others.
  for (const Heard& heard : air.heard(1)) {
    if (heard.channel != kOrders) continue;
    const double said = 3.0 + std::stod(heard.text.substr(1));
    EXPECT_LT(to_seconds(heard.at) - said, 0.05) << heard.text;
  }
}

TEST(Link, OneLossIsRepairedOnceForAll) {
  Air air;
  for (std::uint16_t id = 1; id <= 33; ++id) air.add(id);
  air.run(3s);
  air.loss = 1.0;
  air.say(0, kOrders, "to all");
  air.run(5ms);
  air.loss = 0.0;
  air.run(2s);
  for (std::size_t i = 1; i < 33; ++i) EXPECT_THAT(air.texts(i, kOrders, 1), ElementsAre("to all"));
  EXPECT_LE(air.link(0).counts().repairs, 3U);
}

TEST(Link, AnyBytesAreHeardWithoutHarm) {
  Random random{5};
  Air air;
  air.somebody_lies = true;
  air.add(1);
  air.add(2);
  std::vector<std::vector<std::uint8_t>> seen;
  for (int i = 0; i < 50; ++i) {
    air.say(0, kOrders, std::string(static_cast<std::size_t>(i) * 40, 'a'));
    air.run(20ms);
    if (const auto datagram = air.link(0).poll(air.now + 2s)) seen.push_back(*datagram);
  }
  ASSERT_THAT(seen, Not(IsEmpty()));
  const Author stranger{VehicleId{9}, InstanceId{1}};
  for (int i = 0; i < 100'000; ++i) {
    auto bytes = seen[random.index(seen.size())];
    for (int k = 0; k < 4; ++k) {
      bytes[random.index(bytes.size())] = static_cast<std::uint8_t>(random.index(256));
    }
    bytes.resize(random.index(bytes.size() + 1));
    air.link(1).hear({stranger, 0, bytes}, bytes, air.now);
    if (i % 100 == 0) air.run(10ms);
  }
  EXPECT_GT(air.link(1).counts().malformed, 0U);
  air.say(0, kOrders, "still");
  air.run(2s);
  EXPECT_EQ(air.texts(1, kOrders, 1).back(), "still");
}

TEST(Link, SameSeedsSayTheSame) {
  const auto run = [] {
    Air air{3};
    air.loss = 0.4;
    for (std::uint16_t id = 1; id <= 5; ++id) air.add(id);
    for (int i = 0; i < 50; ++i) {
      air.say(0, kOrders, "m" + std::to_string(i));
      air.run(30ms);
    }
    std::vector<std::pair<std::string, Instant>> heard;
    for (const Heard& h : air.heard(4)) heard.emplace_back(h.text, h.at);
    return heard;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace skein::air
