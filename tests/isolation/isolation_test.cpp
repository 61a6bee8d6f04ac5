// SPDX-License-Identifier: Apache-2.0
//
// A node whose network is carried by a process of its own, and what may befall that process.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "free_ports.hpp"
#include "hostile.hpp"
#include "processes.hpp"
#include "skein/codec/codec.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/team.hpp"
#include "skein/network/carrier_process.hpp"
#include "skein/network/node.hpp"

namespace skein::isolation {
namespace {

using network::Node;
using network::NodeConfig;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

constexpr std::uint64_t kMegabyte = 1'000'000;

/// Waits for a condition that another process brings about.
bool eventually(const std::function<bool()>& condition, seconds limit = seconds{60}) {
  const auto end = steady_clock::now() + limit;
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds{2});
  }
  return true;
}

class Socket {
 public:
  Socket() : descriptor_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    const timeval limit{60, 0};
    setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }
  ~Socket() { close(descriptor_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void send(const std::string& text, std::uint16_t port) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sendto(descriptor_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }
  [[nodiscard]] std::string receive() const {
    std::array<char, 4096> text{};
    const ssize_t size = recv(descriptor_, text.data(), text.size(), 0);
    return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }

 private:
  int descriptor_;
};

/// The ground station in this process, and vehicle 1 with a carrier; both sealed and signing.
class Isolation : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-isolation-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    ASSERT_TRUE(identity::make_team(folder_, std::vector{VehicleId{1}}, now_unix_s()).ok());
    const auto ports = network::free_port_pairs(2);
    for (std::uint16_t id = 0; id < 2; ++id) configs_.at(id) = config_of(VehicleId{id}, ports);
    configs_[1].isolated = true;
    configs_[1].transport_plugin = SKEIN_HOSTILE_TRANSPORT;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] NodeConfig config_of(VehicleId id, const std::vector<std::uint16_t>& ports) const {
    NodeConfig config;
    config.self = id;
    config.instance = InstanceId{(1ULL << 24U) + 5U};
    config.role = id == kGroundStation ? codec::Role::ground : codec::Role::vehicle;
    config.endpoint = {"127.0.0.1", ports.at(id.value)};
    const std::uint16_t other = id.value == 0 ? 1 : 0;
    config.peers = {{VehicleId{other}, {"127.0.0.1", ports.at(other)}}};
    config.seal = network::SealConfig{{.sender = id, .number = 1, .random = 5}, key(1)};
    const auto who =
        identity::Identity::open({identity::node_folder(folder_, id), {}}, now_unix_s());
    EXPECT_TRUE(who.ok());
    config.sign = network::SignConfig{who->signer(), who->own(), who->verifier()};
    return config;
  }
  static std::int64_t now_unix_s() {
    return std::chrono::duration_cast<seconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  }
  static seal::EpochKey key(std::uint8_t epoch) {
    seal::EpochKey made{.epoch = epoch};
    made.secret.fill(epoch);
    return made;
  }
  static std::unique_ptr<Node> open(const NodeConfig& config) {
    auto node = Node::open(config);
    EXPECT_TRUE(node.ok()) << node.error().message;
    return node ? std::move(node).value() : nullptr;
  }

  void open_both() {
    ground_ = open(configs_[0]);
    vehicle_ = open(configs_[1]);
    ASSERT_TRUE(ground_ && vehicle_);
    ASSERT_TRUE(
        eventually([&] { return ground_->peers().size() == 1 && vehicle_->peers().size() == 1; }));
    expect_talk();
  }

  [[nodiscard]] std::uint64_t restarts() const {
    return vehicle_->counters().at("carrier_restarts");
  }
  static std::vector<pid_t> carriers() { return children_of(getpid()); }
  void order(const std::string& what) const {
    socket_.send(std::string{kOrder} + what, configs_[1].endpoint.port);
  }

  /// Says something signed in both directions until each has heard the other.
  void expect_talk() {
    bool heard_vehicle = false;
    bool heard_ground = false;
    const auto talk = [&] {
      vehicle_->publish(mission::HazardReport{{HazardId{1}, {0.0, 0.0}, 1.0}});
      ground_->publish(mission::Command{VehicleId{1}, 1, mission::CommandKind::hold});
      while (ground_->poll()) heard_vehicle = true;
      while (vehicle_->poll()) heard_ground = true;
      return heard_vehicle && heard_ground;
    };
    EXPECT_TRUE(eventually(talk));
  }

  /// How long the two do not hear each other after that fault.
  milliseconds outage(const std::function<void()>& fault) {
    const std::uint64_t before = restarts();
    while (ground_->poll() || vehicle_->poll()) continue;
    const auto began = steady_clock::now();
    fault();
    EXPECT_TRUE(eventually([&] { return restarts() > before; }));
    while (ground_->poll() || vehicle_->poll()) continue;
    expect_talk();
    const auto took = std::chrono::duration_cast<milliseconds>(steady_clock::now() - began);
    std::printf("network back after %lld ms\n", static_cast<long long>(took.count()));
    const auto troubles = vehicle_->take_troubles();
    EXPECT_EQ(troubles.size(), 1U);
    for (const std::string& trouble : troubles) std::printf("%s\n", trouble.c_str());
    return took;
  }

  std::filesystem::path folder_;
  std::array<NodeConfig, 2> configs_;
  std::unique_ptr<Node> ground_;
  std::unique_ptr<Node> vehicle_;
  Socket socket_;
};

/// Alone on a quiet machine it is 0.1 to 0.5 s; on one without a processor to spare a hang is
/// judged after 10 s only (docs/decisions/034).
constexpr milliseconds kBackWithin{20'000};

TEST_F(Isolation, ACrashCostsTheNetworkForAMomentAndNothingElse) {
  ASSERT_NO_FATAL_FAILURE(open_both());
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(outage([&] { order(std::string{kCrash}); }), kBackWithin);
    // To the others it is still the same start of the same vehicle, and once.
    ASSERT_EQ(ground_->peers().size(), 1U);
    EXPECT_EQ(ground_->peers()[0],
              (network::Peer{VehicleId{1}, configs_[1].instance, codec::Role::vehicle}));
  }
  EXPECT_EQ(restarts(), 3U);
  const auto heard = ground_->counters();
  for (const char* name : {"signature_replayed", "signature_forged", "seal_replayed",
                           "seal_old_start", "seal_no_room"}) {
    EXPECT_EQ(heard.at(name), 0U) << name;
  }
}

TEST_F(Isolation, AStoppedCarrierIsReplaced) {
  ASSERT_NO_FATAL_FAILURE(open_both());
  ASSERT_EQ(carriers().size(), 1U);
  EXPECT_LT(outage([&] { kill(carriers()[0], SIGSTOP); }), kBackWithin);
  EXPECT_EQ(carriers().size(), 1U);
}

TEST_F(Isolation, AThreadThatHangsIsSeen) {
  ASSERT_NO_FATAL_FAILURE(open_both());
  // The thread that sends is the one that hangs: as an agent's would, words go on coming. A single
  // one may have been sent before the order was heard.
  const auto hang = [&] {
    const std::uint64_t before = restarts();
    order(std::string{kHang});
    EXPECT_TRUE(eventually([&] {
      vehicle_->publish(mission::Telemetry{});
      return restarts() > before;
    }));
  };
  EXPECT_LT(outage(hang), kBackWithin);
}

TEST_F(Isolation, ALeakEndsTheCarrierAndTakesNothingOfTheAgent) {
  if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes: memory is not limited";
  ASSERT_NO_FATAL_FAILURE(open_both());
  const std::uint64_t before = resident_bytes(getpid());
  EXPECT_LT(outage([&] { order(std::string{kLeak}); }), kBackWithin);
  EXPECT_LT(resident_bytes(getpid()), before + 5 * kMegabyte);
}

TEST_F(Isolation, WhoTakesTheCarrierOverGetsNoFurther) {
  if (kSanitized) GTEST_SKIP() << "sanitizers open files for what they report";
  const auto attempts_at = [&](const NodeConfig& config) {
    const auto folder = folder_.string();
    // Left to the programs that this one starts, as by a library that forgets O_CLOEXEC.
    const int inherited = ::open((folder + "/there").c_str(), O_RDWR | O_CREAT, 0600);
    EXPECT_EQ(ftruncate(inherited, kInheritedBytes), 0);
    const auto node = open(config);
    order(std::string{kEscape} + " " + std::to_string(getpid()) + " " + folder);
    std::istringstream report{socket_.receive()};
    std::map<std::string, int> errors;
    std::string name;
    int error = 0;
    while (report >> name >> error) errors[name] = error;
    EXPECT_EQ(errors.size(), 18U);
    close(inherited);
    return errors;
  };
  const auto confined = attempts_at(configs_[1]);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "there"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "made"));
  for (const auto& [name, error] : confined) {
    EXPECT_EQ(error, name == "plain-memory" ? 0 : EPERM) << name;
  }
  // In this process the same attempts are not refused: they would have told of it.
  configs_[1].isolated = false;
  for (const auto& [name, error] : attempts_at(configs_[1])) EXPECT_NE(error, EPERM) << name;
}

TEST_F(Isolation, TheCarrierHasNoRights) {
  vehicle_ = open(configs_[1]);
  ASSERT_EQ(carriers().size(), 1U);
  const auto status = status_of(carriers()[0]);
  for (const char* set : {"CapInh", "CapPrm", "CapEff", "CapAmb"}) {
    EXPECT_EQ(status.at(set), "0000000000000000") << set;
  }
  EXPECT_EQ(status.at("NoNewPrivs"), "1");
  if (!kSanitized) {
    EXPECT_EQ(status.at("Seccomp"), "2");
  }
  EXPECT_TRUE(vehicle_->take_troubles().empty()) << "it could give up all of its rights";
}

TEST_F(Isolation, ANewKeyOutlivesACrash) {
  ASSERT_NO_FATAL_FAILURE(open_both());
  vehicle_->change_key(key(2), Duration{});
  ground_->change_key(key(2), Duration{});
  expect_talk();
  EXPECT_LT(outage([&] { kill(carriers()[0], SIGKILL); }), kBackWithin);
  EXPECT_EQ(vehicle_->epoch(), 2);
}

TEST_F(Isolation, NothingIsLeftOfANodeThatIsClosed) {
  ASSERT_NO_FATAL_FAILURE(open_both());
  const auto before = carriers();
  ASSERT_EQ(before.size(), 1U);
  vehicle_.reset();
  EXPECT_TRUE(carriers().empty());
  EXPECT_TRUE(eventually([&] { return ground_->peers().empty(); })) << "it took its leave";
}

TEST_F(Isolation, WhyItCannotStartIsSaid) {
  const auto other = open(configs_[0]);
  configs_[1].endpoint = configs_[0].endpoint;
  configs_[1].peers.clear();
  const auto in_use = Node::open(configs_[1]);
  ASSERT_FALSE(in_use.ok());
  EXPECT_THAT(in_use.error().message, testing::HasSubstr("is already in use"));
  configs_[1].transport_plugin = "/nonexistent/libradio.so";
  configs_[1].endpoint.port = network::free_port_pairs(1)[0];
  const auto missing = Node::open(configs_[1]);
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message, testing::HasSubstr("cannot load the transport"));
  EXPECT_TRUE(carriers().empty());
}

}  // namespace
}  // namespace skein::isolation

int main(int argc, char** argv) {
  if (const auto status = skein::network::run_carrier(argc, argv)) return *status;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
