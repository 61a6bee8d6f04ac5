// SPDX-License-Identifier: Apache-2.0
//
// A live mission of processes, and on its network somebody without keys, or with those of a
// vehicle.
#include "intruder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/identity/identity.hpp"
#include "skein/network/node.hpp"
#include "skein/random_messages/random_messages.hpp"

namespace skein::intruder {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::uint16_t kVehicles = 6;
constexpr std::uint16_t kIntrudersPort = 42'420;
constexpr std::array kNobodysPorts{kIntrudersPort, std::uint16_t{42'440}};

std::string text_of(const fs::path& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

/// What it says of the ground station's, which would end the mission if anybody heard it.
std::vector<mission::Message> forged_orders(Random& random) {
  mission::Command hold;
  hold.number = std::numeric_limits<decltype(hold.number)>::max();
  hold.kind = mission::CommandKind::hold;
  mission::Command home = hold;
  home.kind = mission::CommandKind::return_home;
  mission::HazardReport hazard;
  hazard.hazard.id = HazardId{9};
  hazard.hazard.radius_m = 50'000.0;
  std::vector<mission::Message> all{hold, home, hazard};
  for (std::size_t kind = 0; kind < codec::kMessageKinds; ++kind) {
    all.push_back(codec::random_message(kind, random));
  }
  return all;
}

/// How the team speaks.
enum class By : std::uint8_t { air, dds };

class Intruder : public testing::TestWithParam<By> {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }

  void start_mission() {
    fs::create_directories(folder_);
    std::vector<std::string> words{std::string{SKEIN_PROGRAMS} + "/skein-hil",
                                   "run",
                                   std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml",
                                   "--headless",
                                   "--out",
                                   run().string()};
    if (GetParam() == By::dds) words.emplace_back("--dds");
    auto started = hil::ChildProcess::start(words, folder_ / "log", {});
    ASSERT_TRUE(started.ok()) << started.error().message;
    mission_.emplace(std::move(started).value());
    const auto last = run() / ("vehicle-" + std::to_string(kVehicles) + ".yaml");
    while (!fs::exists(last) || !configuration::load_vehicle_config(last.string()).ok()) {
      ASSERT_FALSE(mission_->ended()) << text_of(folder_ / "log");
      std::this_thread::sleep_for(20ms);
    }
    for (std::uint16_t id = 1; id <= kVehicles; ++id) {
      const auto file = run() / ("vehicle-" + std::to_string(id) + ".yaml");
      const auto config = configuration::load_vehicle_config(file.string());
      ASSERT_TRUE(config.ok()) << config.error().message;
      domain_ = config->network.domain_id;
      nodes_.push_back({VehicleId{id}, {config->network.address, config->network.port}});
    }
    const auto ground = configuration::load_ground_config((run() / "ground.yaml").string());
    ASSERT_TRUE(ground.ok()) << ground.error().message;
    nodes_.push_back({kGroundStation, {ground->network.address, ground->network.port}});
    group_ = {ground->network.air.group, ground->network.port};
  }

  /// Where a node of that id meets the team.
  void meet(network::NodeConfig& config, std::uint16_t port) const {
    config.domain = domain_;
    config.endpoint = {"127.0.0.1", port};
    if (GetParam() == By::air) {
      config.air.emplace(network::AirConfig{group_, {}});
      return;
    }
    for (const auto& node : nodes_) {
      if (node.id != config.self) config.peers.push_back(node);
    }
  }

  /// A node that says it is `as`, as any program of ours without keys would be.
  [[nodiscard]] std::unique_ptr<network::Node> join(VehicleId as, std::uint16_t port) const {
    network::NodeConfig config;
    config.self = as;
    config.instance = InstanceId{as.value + 1U};
    config.role = as == kGroundStation ? codec::Role::ground : codec::Role::vehicle;
    meet(config, port);
    auto opened = network::Node::open(config);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    return opened ? std::move(opened).value() : nullptr;
  }

  /// A node in the ground station's name, by whoever has captured that vehicle with its keys.
  [[nodiscard]] std::unique_ptr<network::Node> join_as_ground_with_keys_of(
      VehicleId captured) const {
    const auto file = run() / ("vehicle-" + std::to_string(captured.value) + ".yaml");
    const auto theirs = configuration::load_vehicle_config(file.string());
    EXPECT_TRUE(theirs.ok());
    const auto who = identity::Identity::open({theirs->network.keys, {}}, std::time(nullptr));
    EXPECT_TRUE(who.ok()) << who.error().message;
    constexpr std::uint32_t kRandom = 0x77;
    network::NodeConfig config;
    config.self = kGroundStation;
    config.instance = InstanceId{(1ULL << 24U) | kRandom};  // its first start, too
    config.role = codec::Role::ground;
    meet(config, kIntrudersPort);
    config.seal = network::SealConfig{{kGroundStation, 1, kRandom}, who->epoch_key()};
    config.sign = network::SignConfig{who->signer(), who->own(), who->verifier()};
    auto opened = network::Node::open(config);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    return opened ? std::move(opened).value() : nullptr;
  }

  /// Twice to every node: to both of its ports, or to all at once.
  void send_to_all(const std::function<Bytes(VehicleId)>& make) const {
    if (GetParam() == By::air) {
      for (const VehicleId as : {kGroundStation, VehicleId{1}}) socket_.send(make(as), group_);
      return;
    }
    for (const auto& node : nodes_) {
      for (const int port : {0, 1}) {
        const VehicleId as = node.id == kGroundStation ? VehicleId{1} : kGroundStation;
        socket_.send(make(as), {node.endpoint.address,
                                static_cast<std::uint16_t>(node.endpoint.port + port)});
      }
    }
  }

  fs::path folder_ = fs::temp_directory_path() / ("skein_intruder_" + std::to_string(::getpid()));
  std::optional<hil::ChildProcess> mission_;
  std::uint32_t domain_ = 0;
  std::vector<network::PeerConfig> nodes_;
  network::Endpoint group_;
  Socket socket_;
};

INSTANTIATE_TEST_SUITE_P(By, Intruder, testing::Values(By::air, By::dds),
                         [](const auto& by) { return by.param == By::air ? "Air" : "Dds"; });

/// The number after these words in that log.
std::uint64_t number_in(const fs::path& log, const std::string& words) {
  const std::string text = text_of(log);
  const auto at = text.find(words);
  return at == std::string::npos ? 0 : std::stoull(text.substr(at + words.size()));
}

bool is_of_the_team(const network::Peer& peer) {
  constexpr std::uint64_t kOursMax = 3;  // as join() numbers them
  return peer.instance.value > kOursMax;
}

TEST_P(Intruder, WithoutKeysChangesNothingAndIsCounted) {
  ASSERT_NO_FATAL_FAILURE(start_mission());
  const auto ground = join(kGroundStation, kNobodysPorts[0]);
  const auto vehicle = join({2}, kNobodysPorts[1]);
  Random random{20261123};
  const auto orders = forged_orders(random);
  std::uint64_t sent = 0;
  std::size_t met = 0;
  while (!mission_->ended()) {
    for (const auto& order : orders) {
      for (network::Node* node : {ground.get(), vehicle.get()}) node->publish(order);
    }
    send_to_all(killing_statistics);
    send_to_all(deafening_heartbeat);
    send_to_all([&](VehicleId as) { return forged_seal(as, random); });
    send_to_all([&](VehicleId) { return forged_news(random); });
    send_to_all([&](VehicleId) { return noise(random); });
    sent += 10;
    for (const network::Node* node : {ground.get(), vehicle.get()}) {
      const auto peers = node->peers();  // on the air the two meet each other
      met = std::max(met, static_cast<std::size_t>(std::ranges::count_if(peers, is_of_the_team)));
    }
    std::this_thread::sleep_for(20ms);  // some 500 datagrams a second to each node
  }
  EXPECT_TRUE(mission_->clean()) << *mission_->ended() << text_of(folder_ / "log");
  EXPECT_EQ(met, 0U) << "nobody of the team met it";
  EXPECT_GT(sent, 5000U);
  for (std::uint16_t id = 0; id <= kVehicles; ++id) {
    const auto log = run() / (id == 0 ? "ground.log" : "vehicle-" + std::to_string(id) + ".log");
    EXPECT_GT(number_in(log, "datagrams of strangers "), sent / 2) << log;
  }
}

TEST_P(Intruder, WithAVehiclesKeysDecidesNothingForTheGroundStation) {
  ASSERT_NO_FATAL_FAILURE(start_mission());
  const auto insider = join_as_ground_with_keys_of({kVehicles});
  Random random{20261124};
  auto orders = forged_orders(random);
  mission::Setup elsewhere;  // as if the ground station ran with something that nobody has
  elsewhere.node = kGroundStation;
  elsewhere.knows_orders = true;
  elsewhere.items = {{1, 1}, {2, 2}};
  orders.emplace_back(elsewhere);
  std::size_t met = 0;
  std::uint64_t rounds = 0;
  while (!mission_->ended()) {
    for (const auto& order : orders) insider->publish(order);
    ++rounds;
    met = std::max(met, insider->peers().size());
    while (insider->poll()) continue;
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_TRUE(mission_->clean()) << *mission_->ended() << text_of(folder_ / "log");
  // On the air also the ground station and the bench.
  EXPECT_GE(met, kVehicles) << "it is of the team, as far as the network can tell";
  for (std::uint16_t id = 1; id <= kVehicles; ++id) {
    const auto log = run() / ("vehicle-" + std::to_string(id) + ".log");
    EXPECT_GT(number_in(log, "decisions unproven "), rounds) << log;
  }
}

}  // namespace
}  // namespace skein::intruder
