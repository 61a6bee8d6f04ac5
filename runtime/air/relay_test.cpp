// SPDX-License-Identifier: Apache-2.0
#include "relay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "frames.hpp"
#include "links_test.hpp"
#include "neighbours.hpp"
#include "skein/base/random.hpp"

namespace skein::air {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint8_t kHops = 8;
constexpr std::uint8_t kHopsInTheField = 16;  ///< the widest of the teams below has 10

Author of(std::uint16_t node, std::uint64_t instance = 1) {
  return {VehicleId{node}, InstanceId{instance}};
}

/// Who hears whom, and who is reached at all.
class Graph {
 public:
  explicit Graph(std::size_t count) : count_{count}, hears_(count * count) {}
  void join(std::size_t a, std::size_t b) {
    hears_[a * count_ + b] = hears_[b * count_ + a] = true;
  }
  [[nodiscard]] bool joined(std::size_t a, std::size_t b) const { return hears_[a * count_ + b]; }
  [[nodiscard]] std::vector<std::size_t> component(std::size_t of) const {
    std::vector<std::size_t> reached{of};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (std::size_t to = 0; to < count_; ++to) {
        if (joined(reached[i], to) && !std::ranges::count(reached, to)) reached.push_back(to);
      }
    }
    std::ranges::sort(reached);
    return reached;
  }

 private:
  std::size_t count_;
  std::vector<bool> hears_;
};

Graph chain(std::size_t count) {
  Graph graph{count};
  for (std::size_t i = 0; i + 1 < count; ++i) graph.join(i, i + 1);
  return graph;
}

/// As the team of scenarios/coalition-32.yaml: 32 in 8 by 7 km that hear 1,500 m far.
Graph in_the_field(std::uint64_t seed) {
  Random random{seed};
  std::array<std::pair<double, double>, 32> at;
  for (auto& [x, y] : at) {
    x = random.uniform(0.0, 8000.0);
    y = random.uniform(0.0, 7000.0);
  }
  Graph graph{at.size()};
  for (std::size_t a = 0; a < at.size(); ++a) {
    for (std::size_t b = a + 1; b < at.size(); ++b) {
      if (std::hypot(at[a].first - at[b].first, at[a].second - at[b].second) <= 1500.0) {
        graph.join(a, b);
      }
    }
  }
  return graph;
}

/// A team of `count` that passes on, with ids from 0.
class Team : public Air {
 public:
  Team(const Graph& graph, std::size_t count, std::uint64_t seed = 1, std::uint8_t hops = kHops)
      : Air{seed} {
    hops_max = hops;
    over(graph);
    for (std::size_t i = 0; i < count; ++i) add(static_cast<std::uint16_t>(i));
  }
  void over(const Graph& graph) {
    apart = [graph](std::size_t a, std::size_t b) { return !graph.joined(a, b); };
  }
  bool found(const std::vector<std::size_t>& members) {
    return std::ranges::all_of(members, [&](std::size_t i) {
      return link(i).peers(now).size() == members.size() - 1 &&
             certified(i).size() >= members.size() - 1;
    });
  }
};

TEST(Relay, WhatIsReliableReachesTheEndOfAChainOnceAndInOrderThoughAFifthGetsLostAtEachHop) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Graph graph = chain(9);
    Team team{graph, 9, seed};
    ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found(graph.component(0)); }));
    team.run(1s);
    team.loss = 0.2;
    for (int i = 0; i < 60; ++i) {
      team.say(0, kOrders, "m" + std::to_string(i));
      team.say(8, kOrders, "m" + std::to_string(i));
      team.run(200ms);
    }
    EXPECT_TRUE(team.run_until(team.now + 14s, [&] {
      return team.texts(8, kOrders, 0).size() == 60 && team.texts(0, kOrders, 8).size() == 60;
    })) << seed;
    for (std::size_t i = 0; i < 9; ++i) {
      for (const std::uint16_t of : std::vector<std::uint16_t>{0, 8}) {
        if (i == of) continue;
        EXPECT_EQ(team.texts(i, kOrders, of), numbered(0, 60)) << seed << " " << i;
      }
    }
    EXPECT_EQ(team.sum(&LinkCounts::lost), 0U);
  }
}

TEST(Relay, WhereAllHearAllNothingIsPassedOn) {
  Graph graph{32};
  for (std::size_t a = 0; a < 32; ++a) {
    for (std::size_t b = 0; b < a; ++b) graph.join(a, b);
  }
  Team team{graph, 32};
  ASSERT_TRUE(team.run_until(at_seconds(2.0), [&] { return team.found(graph.component(0)); }));
  team.run(1s);
  const auto before = team.sum(&LinkCounts::passed_on);
  for (int i = 0; i < 100; ++i) {
    for (std::size_t node = 0; node < 32; ++node) {
      if (i % 5 == 0) team.say(node, kMotion, "here");
      if (i % 10 == 0) team.say(node, kOrders, "m" + std::to_string(i / 10));
    }
    team.run(100ms);
  }
  EXPECT_EQ(team.texts(31, kOrders, 0), numbered(0, 10));
  EXPECT_EQ(team.sum(&LinkCounts::passed_on), before);
}

TEST(Relay, ATeamInTheFieldHearsAllWithLessThanFlooding) {
  std::uint64_t passed = 0;
  std::uint64_t flooded = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Graph graph = in_the_field(seed);
    Team team{graph, 32, seed, kHopsInTheField};
    team.run(4s);
    std::size_t largest = 0;
    for (std::size_t i = 0; i < 32; ++i) {
      if (graph.component(i).size() > graph.component(largest).size()) largest = i;
      EXPECT_TRUE(team.found(graph.component(i))) << seed << " " << i;
    }
    const auto members = graph.component(largest);
    const auto before = team.passed_on(largest);
    for (int i = 0; i < 20; ++i) {
      team.say(largest, kOrders, "m" + std::to_string(i));
      team.run(20ms);
    }
    team.run(300ms);
    passed += team.passed_on(largest) - before;
    flooded += 20 * (members.size() - 1);
    for (const std::size_t i : members) {
      if (i == largest) continue;
      EXPECT_EQ(team.texts(i, kOrders, static_cast<std::uint16_t>(largest)), numbered(0, 20));
    }
  }
  RecordProperty("passed_on", std::to_string(passed));
  RecordProperty("flooding", std::to_string(flooded));
  EXPECT_LT(passed, flooded * 6 / 10);
}

TEST(Relay, HalvesThatMeetBecomeOneTeam) {
  Graph graph{16};
  for (std::size_t i = 0; i < 16; ++i) {
    if (i % 8 < 7) graph.join(i, i + 1);
    if (i % 8 < 6) graph.join(i, i + 2);
  }
  Team team{graph, 16, 1, kHopsInTheField};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found(graph.component(0)); }));
  team.run(10s);
  EXPECT_TRUE(team.found(graph.component(8)));
  graph.join(7, 8);
  team.over(graph);
  EXPECT_FALSE(team.found(graph.component(0)));
  const Instant met = team.now;
  while (team.now < met + 2s && !team.found(graph.component(0))) {
    for (std::size_t i = 0; i < 16; ++i) team.say(i, kMotion, "here");
    team.run(500ms);
  }
  EXPECT_TRUE(team.found(graph.component(0)));
  team.say(0, kOrders, "all");
  team.run(500ms);
  EXPECT_THAT(team.texts(15, kOrders, 0), ElementsAre("all"));
}

TEST(Relay, WhoJoinsIsKnownToAllAndKnowsThem) {
  Graph graph = chain(8);
  Team team{graph, 7};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2, 3, 4, 5, 6}); }));
  team.run(10s);
  team.add(700);
  EXPECT_TRUE(team.run_until(team.now + 2s, [&] { return team.found(graph.component(0)); }));
  EXPECT_EQ(team.certified(7).size(), 7U);
}

TEST(Relay, WhatIsSaidAgainForItsPartsBringsNobodyBackWhoIsGone) {
  const Graph graph = chain(4);
  Team team{graph, 4};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2, 3}); }));
  team.run(10s);
  const auto hear_0 = [&](std::size_t node) {
    const auto peers = team.link(node).peers(team.now);
    return std::ranges::any_of(peers, [](const LinkPeer& p) { return p.author.node.value == 0; });
  };
  // What 0 says last is lost between 1 and 2.
  const Instant split = team.now;
  team.apart = [graph](std::size_t a, std::size_t b) { return !graph.joined(a, b) || a + b == 3; };
  team.say(0, kMotion, "here");
  team.say(0, kOrders, "last");
  team.run(100ms);
  ASSERT_THAT(team.texts(1, kMotion, 0), ElementsAre("here"));
  team.remove(0);
  team.run(2s);
  team.over(graph);
  ASSERT_TRUE(team.run_until(team.now + 3s, [&] { return !team.texts(3, kOrders, 0).empty(); }));
  for (const std::size_t node : {2U, 3U}) {
    EXPECT_THAT(team.texts(node, kOrders, 0), ElementsAre("last"));
    EXPECT_THAT(team.texts(node, kMotion, 0), IsEmpty());
  }
  team.run(split + Link::kPeerFor + 500ms - team.now);
  EXPECT_FALSE(hear_0(2) || hear_0(3));
}

TEST(Relay, MotionIsPassedOnOnceASecond) {
  const Graph graph = chain(3);
  Team team{graph, 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  team.run(1s);
  for (int i = 0; i < 100; ++i) {
    team.say(0, kMotion, "m" + std::to_string(i));
    team.run(100ms);
  }
  EXPECT_EQ(team.texts(1, kMotion, 0).size(), 100U);
  EXPECT_GE(team.texts(2, kMotion, 0).size(), 9U);
  EXPECT_LE(team.texts(2, kMotion, 0).size(), 12U);
}

TEST(Relay, NobodyAsksForWhatComesOverOthers) {
  const Graph graph = chain(3);
  Team team{graph, 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  team.run(1s);
  for (int i = 0; i < 300; ++i) {
    team.say(0, kOrders, "m" + std::to_string(i));
    team.run(7ms);
  }
  team.run(1s);
  EXPECT_EQ(team.texts(2, kOrders, 0), numbered(0, 300));
  EXPECT_EQ(team.sum(&LinkCounts::repairs), 0U);
}

TEST(Relay, ALimitIsKeptAndOwnDecisionsGoFirst) {
  const Graph graph = chain(3);
  Team team{graph, 1};
  const auto relay = team.add(1, 7, 1500.0);
  team.add(2);
  ASSERT_TRUE(team.run_until(at_seconds(5.0), [&] { return team.found({0, 1, 2}); }));
  team.run(2s);
  const auto before = team.link(relay).counts().bytes;
  for (int i = 0; i < 200; ++i) {
    team.say(0, kEvents, std::string(400, 'e'));
    if (i % 10 == 0) team.say(relay, kOrders, "m" + std::to_string(i / 10));
    team.run(100ms);
  }
  EXPECT_LE(team.link(relay).counts().bytes - before, 30'000U + 3'000U);
  EXPECT_EQ(team.texts(2, kOrders, 1), numbered(0, 20));
  EXPECT_GT(team.texts(2, kEvents, 0).size(), 10U);
  EXPECT_GT(team.link(relay).counts().gave_way, 0U);
}

TEST(Relay, AFullDatagramIsPassedOn) {
  const Graph graph = chain(3);
  Team team{graph, 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  team.run(1s);
  const std::string text(20'000, 'x');
  team.say(0, kOrders, text);
  team.run(1s);
  EXPECT_THAT(team.texts(2, kOrders, 0), ElementsAre(text));
}

TEST(Relay, AnotherStartOverOthersIsAnotherAuthor) {
  const Graph graph = chain(4);
  Team team{graph, 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  const auto far = team.add(3, 7);
  ASSERT_TRUE(team.run_until(team.now + 2s, [&] { return team.found({0, 1, 2, 3}); }));
  team.say(far, kOrders, "old");
  team.run(1s);
  team.remove(far);
  const auto anew = [&] {
    team.apart = [](std::size_t a, std::size_t b) {
      const auto place = [](std::size_t node) { return node == 4 ? 3 : static_cast<int>(node); };
      return std::abs(place(a) - place(b)) != 1;
    };
    return team.add(3, 8);
  }();
  team.run(2s);
  team.say(anew, kOrders, "new");
  team.run(1s);
  EXPECT_THAT(team.texts(0, kOrders, 3), ElementsAre("old", "new"));
}

TEST(Relay, WhatIsForgedOrMangledOnTheWayDoesNoHarm) {
  const Graph graph = chain(3);
  Team team{graph, 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  team.somebody_lies = true;
  const Author stranger{VehicleId{9}, InstanceId{1}};
  Random random{3};
  const auto write_to_one = [&](const Frame& frame) {
    std::vector<std::uint8_t> content;
    write(content, Head{});
    write(content, frame);
    return content;
  };
  // One that no author has sealed, one cut short, and one in one.
  std::vector<std::uint8_t> forged(100, 0xFF);
  team.forge(1, stranger, write_to_one(PassedOnFrame{false, 3, forged}));
  team.run(10ms);
  EXPECT_EQ(team.refused(1), 1U);
  auto cut = write_to_one(PassedOnFrame{false, 3, forged});
  cut.pop_back();
  team.forge(1, stranger, cut);
  team.run(10ms);
  EXPECT_EQ(team.link(1).counts().malformed, 1U);
  auto within = sealed(stranger, 99, write_to_one(SampleFrame{kMotion, forged}));
  for (std::uint32_t i = 0; i < 50; ++i) {
    within = sealed(stranger, 100 + i, write_to_one(PassedOnFrame{false, 3, within}));
  }
  team.forge(1, stranger, write_to_one(PassedOnFrame{false, 3, within}));
  team.run(100ms);
  EXPECT_THAT(team.texts(1, kMotion, 9), IsEmpty());
  for (int i = 0; i < 20'000; ++i) {
    auto content = write_to_one(
        PassedOnFrame{false, 3,
                      sealed({VehicleId{8}, InstanceId{1}}, 1000U + static_cast<std::uint32_t>(i),
                             write_to_one(HearingFrame{false, VehicleId{3}, forged}))});
    for (int k = 0; k < 3; ++k) {
      content[random.index(content.size())] = static_cast<std::uint8_t>(random.index(256));
    }
    team.forge(1, stranger, content);
    if (i % 50 == 0) team.run(10ms);
  }
  team.say(0, kOrders, "still");
  team.run(2s);
  EXPECT_THAT(team.texts(2, kOrders, 0), ElementsAre("still"));
}

TEST(Relay, WhoIsStartedAgainSoonHearsTheOthersAsSoon) {
  Team team{chain(3), 3};
  ASSERT_TRUE(team.run_until(at_seconds(4.0), [&] { return team.found({0, 1, 2}); }));
  team.apart = [](std::size_t a, std::size_t b) {
    const auto place = [](std::size_t node) { return node > 2 ? 0 : static_cast<int>(node); };
    return std::abs(place(a) - place(b)) != 1;
  };
  std::size_t end = 0;
  for (std::uint64_t start = 8; start < 20; ++start) {
    for (int i = 0; i < 10 + static_cast<int>(start % 7); ++i) {
      team.say(2, kMotion, "here");
      team.run(100ms);
    }
    team.remove(end);
    end = team.add(0, start);
    const Instant since = team.now;
    while (team.texts(end, kMotion, 2).empty()) {
      ASSERT_LT(team.now - since, 700ms) << start;
      team.say(2, kMotion, "here");
      team.run(100ms);
    }
  }
}

TEST(Relay, HowFarOthersAreIsToldOfAllThoughADatagramDoesNotHoldThem) {
  constexpr std::uint16_t kAuthors = 200;
  struct Deaf final : LinkSink {
    std::optional<Opened> open(std::span<const std::uint8_t> /*datagram*/) override { return {}; }
    void on_sample(std::uint8_t /*channel*/, const Author& /*author*/,
                   std::span<const std::uint8_t> /*bytes*/) override {}
    void on_certificate(const Author& /*author*/,
                        std::span<const std::uint8_t> /*bytes*/) override {}
  } sink;
  LinkConfig config;
  config.self = of(1);
  config.channels = kChannels;
  config.hops_max = kHops;
  Instant now{};
  Link link{config, sink, now};
  std::uint16_t said = 0;
  const auto hear = [&](const Author& author, const std::optional<Frame>& frame) {
    std::vector<std::uint8_t> content;
    write(content, Head{++said, 0, false});
    if (frame) write(content, *frame);
    link.hear({author, said, content}, content, now);
  };
  const std::vector<std::uint8_t> us{1};
  std::set<Author> told;
  while (now < at_seconds(4.0)) {
    hear(of(2), HearingFrame{false, VehicleId{1}, us});
    for (std::uint16_t id = 10; id < 10 + kAuthors; ++id) hear(of(id), std::nullopt);
    const Instant end = now + 500ms;
    for (; link.due() <= end; now = std::max(now, link.due())) {
      while (const auto datagram = link.poll(now)) {
        std::span<const std::uint8_t> rest{*datagram};
        ASSERT_TRUE(read_head(rest));
        while (const auto frame = read_frame(rest)) {
          if (const auto* newest = std::get_if<NewestFrame>(&*frame)) told.insert(newest->author);
          if (rest.empty()) break;
        }
      }
    }
    now = end;
  }
  EXPECT_EQ(told.size(), kAuthors);
}

TEST(Relay, WhatCouldNotBeHadIsCounted) {
  Team team{chain(2), 2};
  team.run(3s);
  team.apart = [](auto, auto) { return true; };
  for (int i = 0; i < 30; ++i) {
    team.say(0, kOrders, "m" + std::to_string(i));
    team.run(1s);
  }
  team.over(chain(2));
  team.run(2s);
  EXPECT_EQ(team.link(1).counts().lost, 30 - team.texts(1, kOrders, 0).size());
  EXPECT_GT(team.link(1).counts().lost, 0U);
}

/// That node says that it hears these.
void say_hears(Neighbours& to, std::uint16_t node, const std::vector<std::uint16_t>& others) {
  Neighbours its{VehicleId{node}};
  for (const std::uint16_t other : others) (void)its.heard(of(other), Instant{});
  its.tell_hearing([&](const HearingFrame& frame) { (void)to.on_hearing(VehicleId{node}, frame); });
}

TEST(Neighbours, AnotherStartOfANodeHasYetToSayWhomItHears) {
  Neighbours ours{VehicleId{1}};
  EXPECT_TRUE(ours.heard(of(2, 7), Instant{}));
  say_hears(ours, 2, {1, 3});
  EXPECT_FALSE(ours.heard(of(2, 7), at_seconds(1.0)));
  EXPECT_TRUE(ours.hears(VehicleId{2}, VehicleId{3}));
  EXPECT_FALSE(ours.heard(of(2, 8), at_seconds(2.0)));
  EXPECT_FALSE(ours.hears(VehicleId{2}, VehicleId{3}));
  EXPECT_EQ(ours.listeners(), 0U);
  const std::vector<std::uint8_t> bits{1};
  EXPECT_TRUE(ours.on_hearing(VehicleId{2}, {false, VehicleId{1}, bits})) << "it hears us anew";
}

// As who has captured one may claim: half of them heard the datagram as we did, but for one that
// it is for; the others are reached by nobody.
TEST(Neighbours, HoweverManyIdsAreClaimedADatagramCostsLittle) {
  constexpr std::uint16_t kTransmitter = 1;
  constexpr std::uint16_t kSelf = 2;
  Neighbours ours{VehicleId{kSelf}};
  (void)ours.heard(of(kTransmitter), Instant{});
  std::vector<std::uint16_t> rivals;
  for (std::uint16_t id = 1000; id < 5000; ++id) {
    if (!ours.heard(of(id), Instant{})) break;
    if (id % 2 == 0) rivals.push_back(id);
  }
  EXPECT_EQ(rivals.size(), (Neighbours::kMax - 1) / 2 + 1);
  std::vector<std::uint16_t> scattered{kSelf};  // in as many windows as it may have
  for (std::uint16_t id = 10'000; id < 50'000; id += 500) scattered.push_back(id);
  const std::vector<std::uint16_t> audience{1001, 1003, 1005};
  auto all_rivals = rivals;
  all_rivals.insert(all_rivals.begin(), kSelf);
  for (const std::uint16_t id : audience) say_hears(ours, id, all_rivals);
  for (const std::uint16_t id : rivals) say_hears(ours, id, {kTransmitter});
  const auto uncovered = ours.without(VehicleId{kTransmitter});
  ASSERT_EQ(uncovered.size(), audience.size());
  const std::size_t before = ours.looks();
  EXPECT_FALSE(ours.has_better(VehicleId{kTransmitter}, uncovered));
  EXPECT_LE(ours.looks() - before, Neighbours::kLooksMax + 3 * Neighbours::kMax);
  // Of more windows than it may have only the first are taken.
  say_hears(ours, 1007, scattered);
  EXPECT_TRUE(ours.hears(VehicleId{1007}, VehicleId{10'000}));
  EXPECT_FALSE(ours.hears(VehicleId{1007}, VehicleId{49'500}));
}

TEST(Neighbours, WhoReachesMoreOrHasTheSmallerIdGoesFirst) {
  Neighbours ours{VehicleId{5}};
  for (std::uint16_t id = 1; id < 9; ++id) (void)ours.heard(of(id), Instant{});
  say_hears(ours, 7, {4, 5});
  const std::vector<VehicleId> audience{VehicleId{7}};
  EXPECT_FALSE(ours.has_better(VehicleId{1}, audience)) << "4 did not hear it";
  say_hears(ours, 4, {1});
  EXPECT_TRUE(ours.has_better(VehicleId{1}, audience)) << "4 has the smaller id";
  say_hears(ours, 7, {5, 6});
  say_hears(ours, 6, {1});
  EXPECT_FALSE(ours.has_better(VehicleId{1}, audience)) << "6 has the greater id";
  say_hears(ours, 8, {6});
  EXPECT_TRUE(ours.has_better(VehicleId{1}, audience)) << "6 reaches 8, too";
}

TEST(Neighbours, SayWhomTheyHearInABitEach) {
  Neighbours many{VehicleId{5000}};
  Neighbours reader{VehicleId{1}};
  (void)reader.heard(of(5000), Instant{});
  for (std::uint16_t id = 10; id < 1010; ++id) (void)many.heard(of(id), Instant{});
  (void)many.heard(of(65'535), Instant{});
  std::size_t bytes = 0;
  many.tell_hearing([&](const HearingFrame& frame) {
    bytes += size_of(frame);
    std::vector<std::uint8_t> written;
    write(written, frame);
    std::span<const std::uint8_t> rest{written};
    (void)reader.on_hearing(VehicleId{5000}, std::get<HearingFrame>(read_frame(rest).value()));
  });
  EXPECT_LE(bytes, 135U);
  for (std::uint16_t id = 0; id < 2000; ++id) {
    EXPECT_EQ(reader.hears(VehicleId{5000}, VehicleId{id}), id >= 10 && id < 1010) << id;
  }
  EXPECT_TRUE(reader.hears(VehicleId{5000}, VehicleId{65'535}));
}

}  // namespace
}  // namespace skein::air
