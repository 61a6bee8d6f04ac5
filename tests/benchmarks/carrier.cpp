// SPDX-License-Identifier: Apache-2.0
//
// What a process of its own costs a message on its way: from publish() of one node until another's
// could poll() it, both nodes with carriers, and both with Fast DDS in this process, by turns.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <semaphore>
#include <thread>
#include <vector>

#include "free_ports.hpp"
#include "skein/network/carrier_process.hpp"
#include "skein/network/node.hpp"

namespace skein::network {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMessages = 1000;
constexpr std::chrono::milliseconds kSpacing{10};

/// A vehicle that tells a ground station of itself.
class Pair {
 public:
  explicit Pair(bool isolated) {
    const auto ports = free_port_pairs(2);
    for (std::uint16_t id = 0; id < 2; ++id) {
      NodeConfig config;
      config.self = VehicleId{id};
      config.instance = InstanceId{1};
      config.role = id == 0 ? codec::Role::ground : codec::Role::vehicle;
      config.endpoint = {"127.0.0.1", ports[id]};
      const std::uint16_t other = id == 0 ? 1 : 0;
      config.peers = {{VehicleId{other}, {"127.0.0.1", ports[other]}}};
      config.seal =
          SealConfig{{.sender = config.self, .number = 1, .random = 5}, seal::EpochKey{.epoch = 1}};
      config.isolated = isolated;
      if (id == 0) config.on_received = [this] { arrived_.release(); };
      auto node = Node::open(config);
      if (!node) {
        std::fprintf(stderr, "%s\n", node.error().message.c_str());
        std::abort();
      }
      nodes_.at(id) = std::move(node).value();
    }
    while (nodes_[1]->peers().empty() || nodes_[0]->peers().empty()) {
      std::this_thread::sleep_for(kSpacing);
    }
  }

  void send_one() {
    const auto sent = Clock::now();
    nodes_[1]->publish(mission::Telemetry{});
    if (!arrived_.try_acquire_for(std::chrono::seconds{1})) return;  // best effort: lost
    took_us_.push_back(std::chrono::duration<double, std::micro>(Clock::now() - sent).count());
    while (nodes_[0]->poll()) continue;
  }

  [[nodiscard]] double quantile(double part) {
    std::sort(took_us_.begin(), took_us_.end());
    return took_us_.at(static_cast<std::size_t>(part * static_cast<double>(took_us_.size() - 1)));
  }
  [[nodiscard]] std::size_t arrived() const { return took_us_.size(); }

 private:
  std::counting_semaphore<kMessages> arrived_{0};
  std::array<std::unique_ptr<Node>, 2> nodes_;
  std::vector<double> took_us_;
};

void compare() {
  Pair here{false};
  Pair isolated{true};
  for (std::size_t i = 0; i < kMessages; ++i) {
    for (Pair* pair : {&here, &isolated}) {
      pair->send_one();
      std::this_thread::sleep_for(kSpacing);
    }
  }
  std::printf("%-28s %8s %10s %10s\n", "publish to poll", "arrived", "p50 us", "p99 us");
  std::printf("%-28s %8zu %10.0f %10.0f\n", "in this process", here.arrived(), here.quantile(0.5),
              here.quantile(0.99));
  std::printf("%-28s %8zu %10.0f %10.0f\n", "two processes of their own", isolated.arrived(),
              isolated.quantile(0.5), isolated.quantile(0.99));
  std::printf("%-28s %8s %10.2f %10.2f\n", "ratio", "", isolated.quantile(0.5) / here.quantile(0.5),
              isolated.quantile(0.99) / here.quantile(0.99));
}

}  // namespace
}  // namespace skein::network

int main(int argc, char** argv) {
  if (const auto status = skein::network::run_carrier(argc, argv)) return *status;
  skein::network::compare();
}
