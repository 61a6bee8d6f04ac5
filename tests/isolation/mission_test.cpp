// SPDX-License-Identifier: Apache-2.0
//
// A mission of processes, some of whose carriers are ended, stopped and killed in flight.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "processes.hpp"
#include "skein/hil/child_process.hpp"

namespace skein::isolation {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr int kVehicles = 6;

std::string text_of(const fs::path& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

std::uint64_t number_before(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  if (at == std::string::npos) return ~std::uint64_t{0};
  const auto begin = text.find_last_not_of("0123456789", at - 1);
  return std::stoull(text.substr(begin + 1));
}

struct Struck {
  int node = 0;  ///< 0 the ground station
  int signal = 0;
};
constexpr std::array kStrikes{Struck{1, SIGSEGV}, Struck{3, SIGSTOP}, Struck{4, SIGKILL},
                              Struck{0, SIGSEGV}, Struck{1, SIGSTOP}};

class Mission : public testing::Test {
 protected:
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }
  [[nodiscard]] fs::path log_of(int node) const {
    return run() / (node == 0 ? "ground.log" : "vehicle-" + std::to_string(node) + ".log");
  }

  void start() {
    fs::create_directories(folder_);
    const std::vector<std::string> words{
        std::string{SKEIN_PROGRAMS} + "/skein-hil",
        "run",
        std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml",
        "--headless",
        "--dds",
        "--out",
        run().string()};
    auto started = hil::ChildProcess::start(words, folder_ / "log", {});
    ASSERT_TRUE(started.ok()) << started.error().message;
    mission_.emplace(std::move(started).value());
    while (text_of(log_of(0)).find("coalition formed") == std::string::npos) {
      ASSERT_FALSE(mission_->ended()) << text_of(folder_ / "log");
      std::this_thread::sleep_for(20ms);
    }
  }

  /// The agent of that node: the process whose command line names its configuration, and which is
  /// no carrier.
  [[nodiscard]] pid_t agent_of(int node) const {
    const std::string config =
        (run() / (node == 0 ? "ground.yaml" : "vehicle-" + std::to_string(node) + ".yaml"))
            .string();
    for (const auto& entry : fs::directory_iterator{"/proc"}) {
      const std::string words = text_of(entry.path() / "cmdline");
      if (words.find(config) != std::string::npos && words.find("skein-hil") == std::string::npos) {
        return static_cast<pid_t>(std::stol(entry.path().filename()));
      }
    }
    return -1;
  }

  fs::path folder_ = fs::temp_directory_path() / ("skein_isolation_" + std::to_string(::getpid()));
  std::optional<hil::ChildProcess> mission_;
};

TEST_F(Mission, EndsInItsTimeThoughNetworksAreLost) {
  ASSERT_NO_FATAL_FAILURE(start());
  std::map<int, std::uint64_t> memory;
  std::map<int, std::uint64_t> struck;
  for (const auto& [node, signal] : kStrikes) {
    const pid_t agent = agent_of(node);
    const auto carriers = children_of(agent);
    ASSERT_EQ(carriers.size(), 1U) << node;
    memory.emplace(node, resident_bytes(agent));
    kill(carriers[0], signal);
    ++struck[node];
    // The next is struck when this one has another.
    while (children_of(agent) == carriers) {
      ASSERT_FALSE(mission_->ended()) << text_of(folder_ / "log");
      std::this_thread::sleep_for(10ms);
    }
    while (children_of(agent).empty()) std::this_thread::sleep_for(10ms);
  }
  for (const auto& [node, before] : memory) {
    EXPECT_LT(resident_bytes(agent_of(node)), before + 3 * kMegabyte) << node;
  }
  ASSERT_TRUE(mission_->wait(180s));
  EXPECT_TRUE(mission_->clean()) << *mission_->ended() << text_of(folder_ / "log");
  for (int node = 0; node <= kVehicles; ++node) {
    const std::string log = text_of(log_of(node));
    EXPECT_EQ(number_before(log, " times, messages not sent meanwhile"), struck[node]) << log;
    if (node == 0) continue;
    // 50 times a second for some 45 s. On a busy machine some are late, with or without a network.
    EXPECT_LT(number_before(log, " overruns"), 5U) << log;
  }
}

}  // namespace
}  // namespace skein::isolation
