// SPDX-License-Identifier: Apache-2.0
//
// How long a team takes to find each other, sealed and in clear by turns: one process a node, all
// started at once, until the last has found the last. Where there are fewer processors than nodes
// it is the processors' time that is compared.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "free_ports.hpp"
#include "skein/network/node.hpp"

namespace skein::network {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kVehicles = 32;
constexpr std::size_t kNodes = kVehicles + 1;  // and a ground station
constexpr std::chrono::milliseconds kLook{20};

NodeConfig config_of(std::uint16_t id, const std::vector<std::uint16_t>& ports, bool sealed) {
  NodeConfig config;
  config.self = VehicleId{id};
  config.instance = InstanceId{1};
  config.role = id == 0 ? codec::Role::ground : codec::Role::vehicle;
  config.endpoint = {"127.0.0.1", ports[id]};
  for (std::uint16_t other = 0; other < kNodes; ++other) {
    if (other != id) config.peers.push_back({VehicleId{other}, {"127.0.0.1", ports[other]}});
  }
  if (sealed) {
    config.seal =
        SealConfig{{.sender = config.self, .number = 1, .random = 5}, seal::EpochKey{.epoch = 1}};
  }
  return config;
}

/// Writes a byte when it has found all others, and stays to be found.
[[noreturn]] void be_node(const NodeConfig& config, int found) {
  const auto node = Node::open(config);
  if (!node) {
    std::fprintf(stderr, "%s\n", node.error().message.c_str());
    std::_Exit(1);
  }
  while (node.value()->peers().size() < kNodes - 1) std::this_thread::sleep_for(kLook);
  if (::write(found, "f", 1) != 1) std::_Exit(1);
  for (;;) ::pause();
}

double seconds_to_find(bool sealed) {
  const auto ports = free_port_pairs(kNodes);
  std::array<int, 2> found{};
  if (::pipe(found.data()) != 0) std::abort();
  const auto begin = Clock::now();
  std::vector<pid_t> nodes;
  for (std::uint16_t id = 0; id < kNodes; ++id) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::close(found[0]);
      be_node(config_of(id, ports, sealed), found[1]);
    }
    nodes.push_back(child);
  }
  ::close(found[1]);
  for (std::size_t done = 0; done < kNodes; ++done) {
    char byte = 0;
    if (::read(found[0], &byte, 1) != 1) std::abort();  // all have ended
  }
  const double took = std::chrono::duration<double>(Clock::now() - begin).count();
  for (const pid_t node : nodes) {
    ::kill(node, SIGKILL);
    ::waitpid(node, nullptr, 0);
  }
  ::close(found[0]);
  return took;
}

void compare(long rounds) {
  std::array<std::vector<double>, 2> took;
  std::printf("%zu processes until each has found all\n%8s %8s %8s\n", kNodes, "clear s",
              "sealed s", "ratio");
  for (long round = 0; round < rounds; ++round) {
    for (const bool sealed : {false, true})
      took.at(sealed ? 1 : 0).push_back(seconds_to_find(sealed));
    std::printf("%8.2f %8.2f %8.2f\n", took[0].back(), took[1].back(),
                took[1].back() / took[0].back());
    std::fflush(stdout);
  }
  for (auto& each : took) std::nth_element(each.begin(), each.begin() + rounds / 2, each.end());
  const auto middle = static_cast<std::size_t>(rounds / 2);
  std::printf("%8.2f %8.2f %8.2f  median\n", took[0][middle], took[1][middle],
              took[1][middle] / took[0][middle]);
}

}  // namespace
}  // namespace skein::network

int main(int argc, char** argv) {
  const long rounds = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 5;
  if (rounds < 1) {
    std::fprintf(stderr, "usage: %s [ROUNDS]\n", argv[0]);
    return 2;
  }
  skein::network::compare(rounds);
}
