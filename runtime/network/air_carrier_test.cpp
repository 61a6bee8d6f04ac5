// SPDX-License-Identifier: Apache-2.0
#include "air_carrier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "air_socket.hpp"
#include "free_ports.hpp"
#include "skein/codec/codec.hpp"
#include "skein/identity/identity.hpp"
#include "skein/network/node.hpp"
#include "skein/random_messages/random_messages.hpp"
#include "skein/seal/header.hpp"

namespace skein::network {
namespace {

using namespace std::chrono_literals;
using codec::Role;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

seal::EpochKey key(std::uint8_t epoch) {
  seal::EpochKey made{.epoch = epoch};
  made.secret.fill(static_cast<std::uint8_t>(100 + epoch));
  return made;
}

/// A team on a group of its own; node 0 is the ground station.
std::vector<NodeConfig> team(std::size_t vehicles, bool sealed) {
  std::vector<NodeConfig> all(vehicles + 1);
  const std::uint16_t port = free_port_pairs(1).front();
  for (std::size_t i = 0; i < all.size(); ++i) {
    NodeConfig& config = all[i];
    config.self = VehicleId{static_cast<std::uint16_t>(i)};
    config.instance = InstanceId{100 + i};
    config.role = i == 0 ? Role::ground : Role::vehicle;
    config.endpoint = {"127.0.0.1", 0};
    config.air = AirConfig{{"239.255.83.1", port}, {}};
    if (!sealed) continue;
    config.seal = SealConfig{{.sender = config.self, .number = 1, .random = 5}, key(1)};
    config.instance = identity::instance_of(config.seal->start);
  }
  return all;
}

std::unique_ptr<Node> open(const NodeConfig& config) {
  auto node = Node::open(config);
  EXPECT_TRUE(node.ok()) << node.error().message;
  return std::move(node).value();
}

bool know_each_other(const Node& a, const Node& b) {
  return a.peers().size() == 1 && b.peers().size() == 1;
}

std::string bytes_of(const mission::Message& message) {
  const auto bytes = codec::encode(message).value();
  return {bytes.begin(), bytes.end()};
}

/// Of every kind that `writer` says and the other reads, one.
std::vector<mission::Message> one_of_each(Role writer) {
  const Role reader = writer == Role::ground ? Role::vehicle : Role::ground;
  Random random{9};
  std::vector<mission::Message> all;
  for (std::size_t kind = 0; kind < codec::kMessageKinds; ++kind) {
    auto message = codec::random_message(kind, random);
    const auto& topic = codec::info(codec::topic_of(message));
    if (topic.writers.has(writer) && topic.readers.has(reader)) all.push_back(std::move(message));
  }
  return all;
}

void expect_exchange(Node& from, Node& to, Role writer) {
  std::vector<std::string> sent;
  for (const auto& message : one_of_each(writer)) {
    sent.push_back(bytes_of(message));
    EXPECT_TRUE(from.publish(message));
  }
  std::vector<std::string> heard;
  EXPECT_TRUE(eventually([&] {
    while (const auto received = to.poll()) heard.push_back(bytes_of(received->message));
    return heard.size() >= sent.size();
  }));
  EXPECT_THAT(heard, UnorderedElementsAreArray(sent));
}

TEST(AirCarrier, VehicleAndGroundExchangeEveryMessage) {
  for (const bool sealed : {false, true}) {
    const auto configs = team(1, sealed);
    const auto ground = open(configs[0]);
    const auto vehicle = open(configs[1]);
    ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); })) << sealed;
    EXPECT_THAT(vehicle->peers(),
                ElementsAre(Peer{kGroundStation, configs[0].instance, Role::ground}));
    expect_exchange(*ground, *vehicle, Role::ground);
    expect_exchange(*vehicle, *ground, Role::vehicle);
  }
}

TEST(AirCarrier, TheLongestMessageArrives) {
  formation::Change change;
  change.stages = formation::kStagesMax;
  for (std::uint16_t id = 1; id <= formation::kMoversMax; ++id) {
    change.movers.push_back({VehicleId{id}, {}, 0});
    change.movers.back().points.assign(formation::kMoverPointsMax, Vec3::Zero());
  }
  const auto configs = team(1, true);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
  ASSERT_TRUE(ground->publish(change));
  std::optional<mission::Message> heard;
  ASSERT_TRUE(eventually([&] {
    if (auto received = vehicle->poll()) heard = received->message;
    return heard.has_value();
  }));
  EXPECT_EQ(bytes_of(*heard), bytes_of(change));
}

TEST(AirCarrier, WhatIsNotForAVehicleIsNotHeardByIt) {
  const auto configs = team(2, true);
  const auto ground = open(configs[0]);
  const auto one = open(configs[1]);
  const auto other = open(configs[2]);
  ASSERT_TRUE(eventually([&] {
    return ground->peers().size() == 2 && one->peers().size() == 2 && other->peers().size() == 2;
  }));
  one->publish(mission::MissionEvent{.vehicle = VehicleId{1}});
  one->publish(coalition::Message{coalition::Cancel{}});
  std::vector<codec::Topic> heard;
  ASSERT_TRUE(eventually([&] {
    while (const auto received = other->poll()) heard.push_back(codec::topic_of(received->message));
    return !heard.empty();
  }));
  EXPECT_THAT(heard, ElementsAre(codec::Topic::coalition));
  EXPECT_TRUE(eventually([&] { return ground->counters().at("received") == 2; }));
}

TEST(AirCarrier, OtherTeamsAreNotHeard) {
  auto configs = team(2, true);
  configs[2].seal->key = key(7);
  const auto ground = open(configs[0]);
  const auto member = open(configs[1]);
  const auto stranger = open(configs[2]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *member); }));
  ASSERT_TRUE(eventually([&] { return ground->counters().at("seal_unknown_epoch") > 0; }));
  EXPECT_TRUE(stranger->peers().empty());
  auto clear = team(2, false);
  for (auto& config : clear) config.air->group = configs[0].air->group;
  clear[1].domain = 5;
  const auto here = open(clear[0]);
  const auto there = open(clear[1]);
  const auto also_here = open(clear[2]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*here, *also_here); }));
  EXPECT_TRUE(there->peers().empty());
  EXPECT_THAT(ground->peers(), ElementsAre(Peer{VehicleId{1}, configs[1].instance, Role::vehicle}));
}

TEST(AirCarrier, TheKeyChangesInFlight) {
  const auto configs = team(1, true);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
  vehicle->change_key(key(2), 60s);
  expect_exchange(*ground, *vehicle, Role::ground);
  // Who has not changed is told of it, since it is heard under the older key.
  vehicle->tell({{kGroundStation, 2, {identity::kChangeMark, 1, 2, 3}}});
  std::optional<std::vector<std::uint8_t>> news;
  ASSERT_TRUE(eventually([&] {
    news = ground->take_key_news();
    return news.has_value();
  }));
  EXPECT_THAT(*news, ElementsAre(identity::kChangeMark, 1, 2, 3));
  ground->change_key(key(2), 60s);
  expect_exchange(*vehicle, *ground, Role::vehicle);
}

TEST(AirCarrier, WhoIsBetweenPassesOnWhatTheOthersSay) {
  for (const bool sealed : {false, true}) {
    auto configs = team(2, sealed);
    for (NodeConfig& config : configs) {
      config.air->hops_max = 8;
      config.transport_plugin = SKEIN_CHAIN_RADIO;
    }
    const auto ground = open(configs[0]);
    const auto between = open(configs[1]);
    const auto far = open(configs[2]);
    ASSERT_TRUE(eventually([&] {
      return ground->peers().size() == 2 && between->peers().size() == 2 &&
             far->peers().size() == 2;
    })) << sealed;
    EXPECT_THAT(far->peers(), Contains(Peer{kGroundStation, configs[0].instance, Role::ground}));
    expect_exchange(*ground, *far, Role::ground);
    expect_exchange(*far, *ground, Role::vehicle);
    EXPECT_GT(between->counters().at("air_passed_on"), 0U);
    EXPECT_EQ(far->counters().at("air_passed_on"), 0U);
    if (!sealed) continue;
    EXPECT_EQ(far->counters().at("seal_replayed"), 0U);
    EXPECT_EQ(far->counters().at("seal_forged"), 0U);
  }
}

TEST(HeardClear, WhoWasSilentLongestGivesWay) {
  constexpr std::uint64_t kMax = air::Link::kAuthorsMax;
  HeardClear heard;
  const auto author = [](std::uint64_t start) {
    return air::Author{VehicleId{1}, InstanceId{start}};
  };
  for (std::uint64_t start = 0; start < kMax; ++start) {
    EXPECT_TRUE(heard.is_first(author(start), 5));
  }
  EXPECT_FALSE(heard.is_first(author(0), 5)) << "and is no longer the one";
  EXPECT_TRUE(heard.is_first(author(kMax), 5)) << "one more";
  EXPECT_FALSE(heard.is_first(author(kMax), 5));
  EXPECT_FALSE(heard.is_first(author(0), 5));
  EXPECT_FALSE(heard.is_first(author(2), 5));
  EXPECT_TRUE(heard.is_first(author(1), 5)) << "is forgotten";
}

TEST(AirCarrier, TheKeyChangesOverTwoHops) {
  auto configs = team(2, true);
  for (NodeConfig& config : configs) {
    config.air->hops_max = 8;
    config.transport_plugin = SKEIN_CHAIN_RADIO;
  }
  const auto ground = open(configs[0]);
  const auto between = open(configs[1]);
  const auto far = open(configs[2]);
  const auto all_found = [&] {
    return ground->peers().size() == 2 && between->peers().size() == 2 && far->peers().size() == 2;
  };
  ASSERT_TRUE(eventually(all_found));
  const std::vector<std::uint8_t> change{identity::kChangeMark, 1, 2, 3};
  const auto tell_others = [&](Node& from, VehicleId self) {
    std::vector<KeyNews> news;
    for (const NodeConfig& other : configs) {
      if (other.self != self) news.push_back({other.self, 2, change});
    }
    from.change_key(key(2), 60s);
    from.tell(news);
  };
  const auto is_told = [&](Node& node) {
    return eventually([&] { return node.take_key_news() == change; });
  };
  tell_others(*ground, configs[0].self);
  ASSERT_TRUE(is_told(*between));
  EXPECT_FALSE(far->take_key_news()) << "out of the ground station's reach";
  expect_exchange(*far, *ground, Role::vehicle);  // under the old key, for its time
  const auto exchanged = std::chrono::steady_clock::now();
  tell_others(*between, configs[1].self);
  ASSERT_TRUE(is_told(*far)) << "by who is between";
  far->change_key(key(2), 0s);
  // The old key is gone for it: what arrives was sealed with the new one.
  expect_exchange(*ground, *far, Role::ground);
  // What need not arrive goes beyond a hop every 0.9 s at most, of each kind.
  ASSERT_TRUE(eventually([&] { return std::chrono::steady_clock::now() - exchanged > 1s; }));
  expect_exchange(*far, *ground, Role::vehicle);
  EXPECT_EQ(far->counters().at("seal_forged") + far->counters().at("seal_replayed"), 0U);
}

/// Who hears a group, and says again what it has heard.
class Recorder {
 public:
  explicit Recorder(const NodeConfig& like)
      : socket_{AirSocket::open(like.air->group, like.endpoint.address).value()} {}
  /// The next so many datagrams that `node` says.
  std::vector<std::vector<std::uint8_t>> record(VehicleId node, std::size_t count) {
    std::vector<std::vector<std::uint8_t>> heard;
    EXPECT_TRUE(eventually([&] {
      socket_.receive([&](std::span<const std::uint8_t> datagram) {
        const auto header = seal::read_header(datagram);
        if (header && header->from.sender == node && heard.size() < count) {
          heard.emplace_back(datagram.begin(), datagram.end());
        }
      });
      return heard.size() == count;
    }));
    return heard;
  }
  void say(const std::vector<std::vector<std::uint8_t>>& datagrams) {
    for (const auto& datagram : datagrams) EXPECT_TRUE(socket_.send(datagram));
  }

 private:
  AirSocket socket_;
};

TEST(AirCarrier, WhatItSaidBeforeItsRestartIsNoTwinAndATwinIsHeard) {
  auto configs = team(1, true);
  NodeConfig& config = configs[1];
  Recorder recorder{config};
  std::vector<std::vector<std::uint8_t>> former;
  {
    const auto before = open(config);
    former = recorder.record(config.self, 3);
  }
  ++config.seal->start.number;
  config.instance = identity::instance_of(config.seal->start);
  const auto anew = open(config);
  NodeConfig copy = config;
  ++copy.seal->start.random;
  copy.instance = identity::instance_of(copy.seal->start);
  std::vector<Peer> peers;
  recorder.say(former);
  const auto twin = open(copy);
  ASSERT_TRUE(eventually([&] {
    peers = anew->peers();
    return std::ranges::count(peers, copy.instance, &Peer::instance) == 1;
  }));
  EXPECT_THAT(peers, ElementsAre(Peer{config.self, copy.instance, Role::vehicle}));
  EXPECT_EQ(anew->counters().at("seal_old_start"), 0U);
}

TEST(AirCarrier, SaysWhatIsWrong) {
  auto config = team(1, true)[0];
  const auto refusal = [&] {
    const auto node = Node::open(config);
    return node.ok() ? std::string{} : node.error().message;
  };
  config.endpoint.address = "192.0.2.1";
  EXPECT_THAT(refusal(), HasSubstr("cannot be joined from 192.0.2.1"));
  config.endpoint.address = "127.0.0.1";
  config.transport_plugin = "/nonexistent/libradio.so";
  EXPECT_THAT(refusal(), HasSubstr("cannot load the transport"));
}

}  // namespace
}  // namespace skein::network
