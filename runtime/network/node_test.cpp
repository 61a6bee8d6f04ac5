// SPDX-License-Identifier: Apache-2.0
#include "skein/network/node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <thread>
#include <variant>

#include "free_ports.hpp"
#include "skein/codec/codec.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/team.hpp"
#include "skein/random_messages/random_messages.hpp"

namespace skein::network {
namespace {

using codec::info;
using codec::kMessageKinds;
using codec::random_message;
using codec::Role;
using codec::Topic;
using codec::topic_of;

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

/// Waits for a condition that another thread or process brings about.
bool eventually(const std::function<bool()>& condition, seconds limit = seconds{60}) {
  const auto end = steady_clock::now() + limit;
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds{2});
  }
  return true;
}

/// Configurations of a fleet on loopback that knows itself: ids 1 to n, node 0 is the ground.
std::vector<NodeConfig> fleet(std::size_t vehicles) {
  std::random_device device;
  const auto ports = free_port_pairs(vehicles + 1);
  std::vector<NodeConfig> all(vehicles + 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].self = VehicleId{static_cast<std::uint16_t>(i)};
    all[i].instance = InstanceId{(std::uint64_t{device()} << 32U) | device()};
    all[i].role = i == 0 ? Role::ground : Role::vehicle;
    all[i].endpoint = {"127.0.0.1", ports[i]};
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k != i) {
        all[i].peers.push_back({VehicleId{static_cast<std::uint16_t>(k)}, {"127.0.0.1", ports[k]}});
      }
    }
  }
  return all;
}

std::unique_ptr<Node> open(const NodeConfig& config) {
  auto node = Node::open(config);
  EXPECT_TRUE(node.ok()) << node.error().message;
  return std::move(node).value();
}

std::string bytes_of(const mission::Message& message) {
  const auto bytes = codec::encode(message).value();
  return {bytes.begin(), bytes.end()};
}

std::vector<std::string> some_of_every_kind(Role writer, std::uint64_t seed,
                                            std::vector<mission::Message>& messages) {
  Random random{seed};
  std::vector<std::string> encoded;
  for (std::size_t i = 0; i < 2 * kMessageKinds; ++i) {
    auto message = random_message(i, random);
    const Topic topic = topic_of(message);
    const Role reader = writer == Role::ground ? Role::vehicle : Role::ground;
    if (!info(topic).writers.has(writer) || !info(topic).readers.has(reader)) continue;
    // Best effort promises nothing, and only the last of a burst is kept: one is enough.
    if (!info(topic).reliable && i >= kMessageKinds) {
      continue;
    }
    // A grant needs an operator's approval.
    if (auto* decision = std::get_if<mission::Authorisation>(&message)) decision->granted = false;
    encoded.push_back(bytes_of(message));
    messages.push_back(std::move(message));
  }
  std::sort(encoded.begin(), encoded.end());
  return encoded;
}

/// The next `count` messages at the node, encoded and sorted, if they come from `sender`.
std::vector<std::string> take(Node& node, std::size_t count, VehicleId sender) {
  std::vector<std::string> encoded;
  eventually([&] {
    while (auto received = node.poll()) {
      EXPECT_EQ(received->sender, sender);
      encoded.push_back(bytes_of(received->message));
    }
    return encoded.size() >= count;
  });
  std::sort(encoded.begin(), encoded.end());
  return encoded;
}

TEST(Node, VehicleAndGroundExchangeEveryMessage) {
  const auto configs = fleet(1);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(
      eventually([&] { return ground->peers().size() == 1 && vehicle->peers().size() == 1; }));
  EXPECT_EQ(ground->peers()[0].id, VehicleId{1});
  EXPECT_EQ(ground->peers()[0].instance, configs[1].instance);
  EXPECT_EQ(vehicle->peers()[0].role, Role::ground);

  std::vector<mission::Message> messages;
  const auto from_vehicle = some_of_every_kind(Role::vehicle, 1, messages);
  for (const auto& m : messages) EXPECT_TRUE(vehicle->publish(m));
  EXPECT_EQ(take(*ground, from_vehicle.size(), VehicleId{1}), from_vehicle);

  messages.clear();
  const auto from_ground = some_of_every_kind(Role::ground, 2, messages);
  for (const auto& m : messages) EXPECT_TRUE(ground->publish(m));
  EXPECT_EQ(take(*vehicle, from_ground.size(), VehicleId{0}), from_ground);
  EXPECT_EQ(ground->counters().at("received"), from_vehicle.size());
}

TEST(Node, TheLongestMessageArrives) {
  formation::Change change;
  change.stages = formation::kStagesMax;
  for (std::uint16_t id = 1; id <= formation::kMoversMax; ++id) {
    change.movers.push_back({VehicleId{id}, {}, 0});
    change.movers.back().points.assign(formation::kMoverPointsMax, Vec3::Zero());
  }
  const auto configs = fleet(1);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(
      eventually([&] { return ground->peers().size() == 1 && vehicle->peers().size() == 1; }));
  ASSERT_TRUE(ground->publish(change));
  EXPECT_EQ(take(*vehicle, 1, VehicleId{0}), std::vector<std::string>{bytes_of(change)});
}

TEST(Node, OneSendersProtocolMessagesKeepTheirOrder) {
  const auto configs = fleet(2);
  const auto a = open(configs[1]);
  const auto b = open(configs[2]);
  ASSERT_TRUE(eventually([&] { return a->peers().size() == 1 && b->peers().size() == 1; }));
  std::uint32_t expected = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    coalition::Cancel m;
    m.round.number = i;
    ASSERT_TRUE(a->publish(coalition::Message{m}));
    if (i % 32 != 31) continue;  // half of what the writer keeps
    ASSERT_TRUE(eventually([&] {
      while (auto r = b->poll()) {
        const auto& c = std::get<coalition::Cancel>(std::get<coalition::Message>(r->message));
        EXPECT_EQ(c.round.number, expected++);
      }
      return expected == i + 1;
    }));
  }
  EXPECT_FALSE(a->poll());  // not its own
}

TEST(Node, ExchangesWithAnotherProcess) {
  const auto configs = fleet(1);
  std::fflush(nullptr);
  const pid_t child = fork();  // before this process has a node, hence threads
  if (child == 0) {
    // The ground answers every hazard report with a command of the hazard's number.
    auto node = Node::open(configs[0]);
    if (!node) _exit(2);
    const bool done = eventually([&] {
      while (auto r = (*node)->poll()) {
        const auto* report = std::get_if<mission::HazardReport>(&r->message);
        if (report == nullptr) continue;
        (*node)->publish(mission::Command{VehicleId{1}, report->hazard.id.value});
        if (report->hazard.id == HazardId{99}) return true;
      }
      return false;
    });
    _exit(done ? 0 : 1);
  }
  const auto node = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return !node->peers().empty(); }));
  // The other side may still be matching: what it does not hear now it is told again.
  ASSERT_TRUE(eventually([&] {
    node->publish(mission::HazardReport{{HazardId{7}, {1.0, 2.0}, 3.0}});
    std::this_thread::sleep_for(milliseconds{20});
    while (auto r = node->poll()) {
      const auto* command = std::get_if<mission::Command>(&r->message);
      if (command != nullptr && command->number == 7) return true;
    }
    return false;
  }));
  node->publish(mission::HazardReport{{HazardId{99}, {1.0, 2.0}, 3.0}});
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(Node, TwelveFindEachOther) {
  const auto configs = fleet(11);
  const auto start = steady_clock::now();
  std::vector<std::unique_ptr<Node>> nodes;
  nodes.reserve(configs.size());
  for (const auto& c : configs) nodes.push_back(open(c));
  EXPECT_TRUE(eventually([&] {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](const auto& n) { return n->peers().size() == nodes.size() - 1; });
  }));
  const auto took = std::chrono::duration_cast<milliseconds>(steady_clock::now() - start);
  std::printf("12 nodes matched after %lld ms\n", static_cast<long long>(took.count()));
}

TEST(Node, TwoProcessesWithOneIdAreBothSeen) {
  auto configs = fleet(2);
  configs[2].self = VehicleId{1};
  configs[1].peers.pop_back();  // the two do not know of each other
  configs[2].peers.resize(1);
  const auto ground = open(configs[0]);
  const auto one = open(configs[1]);
  const auto other = open(configs[2]);
  ASSERT_TRUE(eventually([&] { return ground->peers().size() == 2; }));
  const auto peers = ground->peers();
  EXPECT_EQ(peers[0].id, VehicleId{1});
  EXPECT_EQ(peers[1].id, VehicleId{1});
  EXPECT_NE(peers[0].instance, peers[1].instance);
}

TEST(Node, FullQueueDropsAndCounts) {
  auto configs = fleet(1);
  configs[0].queue_limit = 3;
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(
      eventually([&] { return ground->peers().size() == 1 && vehicle->peers().size() == 1; }));
  for (std::uint16_t i = 0; i < 10; ++i) {
    EXPECT_TRUE(vehicle->publish(mission::HazardReport{{HazardId{i}, {0.0, 0.0}, 1.0}}));
  }
  EXPECT_TRUE(eventually([&] { return ground->counters().at("dropped_full") == 7; }));
  EXPECT_EQ(ground->counters().at("received"), 3U);
}

TEST(Node, RefusesToSendWhatItMustNot) {
  const auto configs = fleet(1);
  const auto vehicle = open(configs[1]);
  EXPECT_FALSE(vehicle->publish(mission::Authorisation{}));
  EXPECT_EQ(vehicle->counters().at("publish_refused_role"), 1U);
  mission::Telemetry broken;
  broken.state.x_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(vehicle->publish(broken));
  EXPECT_EQ(vehicle->counters().at("publish_refused_value"), 1U);
}

TEST(Node, PublishingDoesNotWaitForASilentReader) {
  const auto configs = fleet(2);
  // The reader goes last: Fast DDS 2.9 may hang where one goes for which samples still wait
  // (docs/decisions/034).
  const auto b = open(configs[2]);
  const auto a = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return a->peers().size() == 1; }));
  for (int i = 0; i < 2000; ++i) a->publish(coalition::Message{coalition::Cancel{}});
  EXPECT_EQ(a->counters().at("published") + a->counters().at("publish_failed"), 2000U);
  EXPECT_LT(a->counters().at("publish_failed"), 200U);
}

std::string refusal(const NodeConfig& config) {
  auto node = Node::open(config);
  EXPECT_FALSE(node.ok());
  return node.ok() ? "" : node.error().message;
}

TEST(Node, SaysWhatIsWrongWithItsConfiguration) {
  const auto configs = fleet(2);
  const auto other = open(configs[2]);
  auto c = configs[1];
  c.endpoint = configs[2].endpoint;
  c.peers.pop_back();
  EXPECT_THAT(refusal(c), HasSubstr(std::to_string(c.endpoint.port) + " is already in use"));
  c = configs[1];
  c.endpoint.port = static_cast<std::uint16_t>(configs[2].endpoint.port + 1);
  c.peers.pop_back();
  EXPECT_THAT(refusal(c), HasSubstr(std::to_string(c.endpoint.port) + " is already in use"));
  c = configs[1];
  c.peers.push_back(c.peers[0]);
  EXPECT_THAT(refusal(c), HasSubstr("peer 0 is listed twice"));
  c = configs[1];
  c.peers[0].id = c.self;
  EXPECT_THAT(refusal(c), HasSubstr("is this node itself"));
  c = configs[1];
  c.peers[0].endpoint.port = static_cast<std::uint16_t>(c.endpoint.port + 1);
  EXPECT_THAT(refusal(c), HasSubstr("shares a port"));
  c = configs[1];
  c.peers[1].endpoint.address = "localhost";
  EXPECT_THAT(refusal(c), HasSubstr("'localhost' is no IPv4 address"));
  c = configs[1];
  c.endpoint.address = "192.0.2.1";  // reserved for documentation
  EXPECT_THAT(refusal(c), HasSubstr("no network interface"));
  c = configs[1];
  c.transport_plugin = "/nonexistent/libradio.so";
  EXPECT_THAT(refusal(c), HasSubstr("cannot load the transport"));
}

seal::EpochKey key(std::uint8_t epoch) {
  seal::EpochKey made{.epoch = epoch};
  made.secret.fill(static_cast<std::uint8_t>(100 + epoch));
  return made;
}

std::vector<NodeConfig> sealed_fleet(std::size_t vehicles) {
  auto configs = fleet(vehicles);
  for (NodeConfig& config : configs) {
    config.seal =
        SealConfig{.start = {.sender = config.self, .number = 1, .random = 5}, .key = key(1)};
  }
  return configs;
}

bool know_each_other(const Node& a, const Node& b) {
  return a.peers().size() == 1 && b.peers().size() == 1;
}

/// Messages of every kind from the ground station arrive at the vehicle as they were.
void expect_exchange(Node& ground, Node& vehicle, std::uint64_t seed) {
  std::vector<mission::Message> messages;
  const auto sent = some_of_every_kind(Role::ground, seed, messages);
  for (const auto& message : messages) EXPECT_TRUE(ground.publish(message));
  EXPECT_EQ(take(vehicle, sent.size(), kGroundStation), sent);
}

TEST(SealedNode, ExchangesAsAnyOther) {
  const auto configs = sealed_fleet(1);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
  expect_exchange(*ground, *vehicle, 3);
  for (const Node* node : {ground.get(), vehicle.get()}) {
    const auto counts = node->counters();
    EXPECT_GT(counts.at("seal_opened"), 0U);
    EXPECT_EQ(counts.at("seal_forged") + counts.at("seal_misformed"), 0U);
  }
}

TEST(SealedNode, GoesOnWhileKeysChangeOneAfterTheOther) {
  const auto configs = sealed_fleet(1);
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
  vehicle->change_key(key(2), seconds{3600});
  expect_exchange(*ground, *vehicle, 4);  // the ground station still seals with the old one
  ground->change_key(key(2), Duration{});
  expect_exchange(*ground, *vehicle, 5);
}

/// Nodes 0 (the ground station), 1 and 2 with keys of a mission of their own.
class SigningNodes : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-node-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    const std::vector vehicles{VehicleId{1}, VehicleId{2}};
    ASSERT_TRUE(identity::make_team(folder_, vehicles, now_unix_s()).ok());
    configs_ = sealed_fleet(2);
    for (NodeConfig& config : configs_) {
      config.instance = InstanceId{(1ULL << 24U) + 5U};
      config.sign = keys_of(config.self);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] SignConfig keys_of(VehicleId node) const {
    const auto who =
        identity::Identity::open({identity::node_folder(folder_, node), {}}, now_unix_s());
    EXPECT_TRUE(who.ok());
    return {who->signer(), who->own(), who->verifier()};
  }
  static std::int64_t now_unix_s() {
    return std::chrono::duration_cast<seconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  }

  std::filesystem::path folder_;
  std::vector<NodeConfig> configs_;
};

TEST_F(SigningNodes, ExchangeAsAnyOther) {
  const auto ground = open(configs_[0]);
  const auto vehicle = open(configs_[1]);
  ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
  expect_exchange(*ground, *vehicle, 6);
  EXPECT_EQ(vehicle->counters().at("signature_missing"), 0U);
  mission::Authorisation grant;
  grant.granted = true;
  EXPECT_TRUE(ground->publish(grant));
  EXPECT_TRUE(eventually([&] { return vehicle->counters().at("signature_missing") == 1; }))
      << "which no operator has approved";
  EXPECT_FALSE(vehicle->poll());
}

TEST_F(SigningNodes, WhoHasCapturedAVehicleDecidesForNobodyElse) {
  const auto vehicle = open(configs_[1]);
  {
    const auto ground = open(configs_[0]);
    ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
    expect_exchange(*ground, *vehicle, 7);
  }
  // With the team's key and the keys of vehicle 2, in the ground station's name.
  NodeConfig captured = configs_[0];
  captured.instance = InstanceId{(2ULL << 24U) + 5U};
  captured.seal->start.number = 2;
  captured.sign = keys_of({2});
  const auto insider = open(captured);
  ASSERT_TRUE(eventually([&] { return !insider->peers().empty(); }));
  const auto counted = [&vehicle](const char* name) { return vehicle->counters().at(name); };
  ASSERT_TRUE(eventually([&] {
    insider->publish(mission::Command{{1}, 77, mission::CommandKind::hold});
    insider->publish(mission::Authorisation{});
    return counted("signature_forged") > 10;
  }));
  captured.sign.reset();
  captured.instance = InstanceId{(3ULL << 24U) + 5U};
  captured.seal->start.number = 3;
  captured.endpoint = captured.peers.back().endpoint;  // vehicle 2 is not there
  captured.peers.pop_back();
  const auto unsigned_one = open(captured);
  ASSERT_TRUE(eventually([&] {
    unsigned_one->publish(mission::Command{{1}, 77, mission::CommandKind::hold});
    return counted("signature_missing") > 10;
  }));
  EXPECT_FALSE(vehicle->poll()) << "nothing of it is heard";
}

TEST_F(SigningNodes, WhatIsNotHeededIsCountedAndNotJudged) {
  std::atomic<bool> heeds{false};
  configs_[1].heeds = [&heeds](const mission::Message& message) {
    return heeds || !std::holds_alternative<mission::Command>(message);
  };
  const auto vehicle = open(configs_[1]);
  const auto counted = [&vehicle](const char* name) { return vehicle->counters().at(name); };
  const mission::Command hold{{1}, 77, mission::CommandKind::hold};
  constexpr std::uint64_t kUnheeded = 5;
  {
    const auto ground = open(configs_[0]);
    ASSERT_TRUE(eventually([&] { return know_each_other(*ground, *vehicle); }));
    for (std::uint64_t i = 0; i < kUnheeded; ++i) EXPECT_TRUE(ground->publish(hold));
    ASSERT_TRUE(eventually([&] { return counted("unheeded") == kUnheeded; }));
  }
  EXPECT_EQ(counted("received"), 0U);
  ASSERT_TRUE(eventually([&] { return vehicle->peers().empty(); }));
  // The first that the same instance signs would be a replay, had its window gone on.
  heeds = true;
  configs_[0].seal->start.number = 2;
  {
    const auto again = open(configs_[0]);
    ASSERT_TRUE(eventually([&] { return know_each_other(*again, *vehicle); }));
    EXPECT_TRUE(again->publish(hold));
    ASSERT_TRUE(eventually([&] { return counted("received") == 1; }));
    EXPECT_EQ(vehicle->poll().value().sender, kGroundStation);
  }
  ASSERT_TRUE(eventually([&] { return vehicle->peers().empty(); }));
  // And one in the ground station's name is forged for who heeds it, and nothing for who does not.
  NodeConfig captured = configs_[0];
  captured.instance = InstanceId{(3ULL << 24U) + 5U};
  captured.seal->start.number = 3;
  captured.sign = keys_of({2});
  const auto insider = open(captured);
  ASSERT_TRUE(eventually([&] { return know_each_other(*insider, *vehicle); }));
  heeds = false;
  EXPECT_TRUE(insider->publish(hold));
  ASSERT_TRUE(eventually([&] { return counted("unheeded") == kUnheeded + 1; }));
  EXPECT_EQ(counted("signature_forged"), 0U);
  heeds = true;
  EXPECT_TRUE(insider->publish(hold));
  EXPECT_TRUE(eventually([&] { return counted("signature_forged") == 1; }));
  EXPECT_EQ(counted("signature_replayed") + counted("signature_missing"), 0U);
}

TEST(SealedNode, HearsNobodyInClearOrOfAnotherTeam) {
  auto configs = sealed_fleet(3);
  configs[2].seal.reset();
  configs[3].seal->key = key(1);
  configs[3].seal->key.secret[0] ^= 1U;
  const auto ground = open(configs[0]);
  const auto vehicle = open(configs[1]);
  const auto in_clear = open(configs[2]);
  const auto foreign = open(configs[3]);
  ASSERT_TRUE(eventually([&] {
    const auto counts = ground->counters();
    return know_each_other(*ground, *vehicle) && counts.at("seal_not_sealed") > 5 &&
           counts.at("seal_forged") > 5;
  }));
  EXPECT_TRUE(in_clear->peers().empty());
  EXPECT_TRUE(foreign->peers().empty());
  EXPECT_EQ(ground->peers().at(0).id, VehicleId{1});
}

}  // namespace
}  // namespace skein::network
