// SPDX-License-Identifier: Apache-2.0
#include "skein/air/link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::air {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint8_t kOrders = 0;
constexpr std::uint8_t kMotion = 1;
constexpr std::uint8_t kEvents = 2;
const std::vector<Channel> kChannels{{.reliable = true, .urgency = Urgency::decision, .kept = 64},
                                     {.reliable = false, .urgency = Urgency::motion, .kept = 1},
                                     {.reliable = true, .urgency = Urgency::report, .kept = 200}};

struct Heard {
  std::uint8_t channel;
  Author author;
  std::string text;
  Instant at;
};

/// Links in virtual time, which hear each other but for what gets lost.
class Air {
 public:
  explicit Air(std::uint64_t seed = 1) : random_{seed} {}

  double loss = 0.0;
  Duration delay_max = 2ms;
  std::function<bool(std::size_t, std::size_t)> apart = [](auto, auto) { return false; };
  Instant now{};

  std::size_t add(std::uint16_t id, std::uint64_t instance = 7,
                  std::optional<double> bytes_per_s = {}) {
    auto node = std::make_unique<Node>(*this);
    LinkConfig config;
    config.self = {VehicleId{id}, InstanceId{instance}};
    config.role = static_cast<std::uint8_t>(id % 3);
    config.channels = kChannels;
    config.certificate = std::vector<std::uint8_t>(200, static_cast<std::uint8_t>(id));
    config.bytes_per_s = bytes_per_s;
    config.seed = random_.next();
    node->self = config.self;
    node->link = std::make_unique<Link>(config, *node, now);
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }
  void remove(std::size_t node) { nodes_[node]->link.reset(); }
  void say(std::size_t node, std::uint8_t channel, const std::string& text) {
    EXPECT_TRUE(nodes_[node]->link->send(channel, {text.begin(), text.end()}, now));
  }
  Link& link(std::size_t node) { return *nodes_[node]->link; }
  std::vector<Heard>& heard(std::size_t node) { return nodes_[node]->heard; }
  std::set<Author>& certified(std::size_t node) { return nodes_[node]->certified; }
  std::vector<std::string> texts(std::size_t node, std::uint8_t channel, std::uint16_t of) {
    std::vector<std::string> all;
    for (const Heard& h : heard(node)) {
      if (h.channel == channel && h.author.node.value == of) all.push_back(h.text);
    }
    return all;
  }

  void run(Duration time) {
    run_until(now + time, [] { return false; });
  }
  bool run_until(Instant end, const std::function<bool()>& done) {
    while (!done()) {
      Instant next = flying_.empty() ? Instant::max() : flying_.begin()->first;
      for (const auto& node : nodes_) {
        if (node->link) next = std::min(next, node->link->due());
      }
      if (next > end) {
        now = end;
        return done();
      }
      now = std::max(now, next);
      step();
    }
    return true;
  }

 private:
  struct Node final : LinkSink {
    explicit Node(Air& in) : air{in} {}
    Air& air;
    Author self;
    std::unique_ptr<Link> link;
    std::vector<Heard> heard;
    std::set<Author> certified;
    void on_sample(std::uint8_t channel, const Author& author,
                   std::span<const std::uint8_t> bytes) override {
      heard.push_back({channel, author, {bytes.begin(), bytes.end()}, air.now});
    }
    void on_certificate(const Author& author, std::span<const std::uint8_t> bytes) override {
      EXPECT_TRUE(bytes.size() == 200U || author.node == VehicleId{9});  // 9 says anything
      certified.insert(author);
    }
  };
  struct Flying {
    Author from;
    std::size_t to;
    std::vector<std::uint8_t> bytes;
  };

  void step() {
    while (!flying_.empty() && flying_.begin()->first <= now) {
      const Flying flying = std::move(flying_.begin()->second);
      flying_.erase(flying_.begin());
      Node& to = *nodes_[flying.to];
      if (to.link) to.link->hear(flying.from, flying.bytes, now);
    }
    for (std::size_t from = 0; from < nodes_.size(); ++from) {
      if (!nodes_[from]->link) continue;
      int said = 0;
      while (const auto datagram = nodes_[from]->link->poll(now)) {
        ASSERT_LE(datagram->size(), 1200U);
        ASSERT_LT(++said, 1000);
        spread(from, *datagram);
      }
      ASSERT_GT(nodes_[from]->link->due(), now);
    }
  }
  void spread(std::size_t from, const std::vector<std::uint8_t>& datagram) {
    for (std::size_t to = 0; to < nodes_.size(); ++to) {
      if (to == from || apart(from, to) || random_.chance(loss)) continue;
      const Duration delay{static_cast<std::int64_t>(random_.uniform(0.1, 1.0) *
                                                     static_cast<double>(delay_max.count()))};
      flying_.emplace(now + delay, Flying{nodes_[from]->self, to, datagram});
    }
  }

  Random random_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::multimap<Instant, Flying> flying_;
};

bool all_found(Air& air, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (air.link(i).peers(air.now).size() != count - 1) return false;
  }
  return true;
}

std::vector<std::string> numbered(int first, int end) {
  std::vector<std::string> all;
  for (int i = first; i < end; ++i) all.push_back("m" + std::to_string(i));
  return all;
}

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

TEST(Link, ALongSampleIsCutAndJoined) {
  Air air;
  air.loss = 0.3;
  air.add(1);
  air.add(2);
  air.run(2s);
  std::string text(14'429, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 26);
  air.say(0, kOrders, text);
  air.say(0, kOrders, "short");
  air.say(0, kMotion, text);
  air.run(5s);
  EXPECT_THAT(air.texts(1, kOrders, 1), ElementsAre(text, "short"));
  EXPECT_THAT(air.texts(1, kMotion, 1), ElementsAre(text));
  EXPECT_FALSE(air.link(0).send(kOrders, std::vector<std::uint8_t>(64'001), air.now));
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
    air.link(1).hear(stranger, bytes, air.now);
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
