// SPDX-License-Identifier: Apache-2.0
//
// skein-hil simulate as a person starts it: virtual time, no other process.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "skein/hil/child_process.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class Simulate : public testing::Test {
 protected:
  Simulate() { fs::create_directories(folder_); }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }
  std::string run(const std::vector<std::string>& arguments) {
    std::vector<std::string> argv{SKEIN_PROGRAMS "/skein-hil", "simulate"};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    fs::remove(log_);
    auto child = ChildProcess::start(argv, log_, {});
    EXPECT_TRUE(child);
    return child->wait(240s) ? *child->ended() : "still running";
  }
  [[nodiscard]] std::string output() const {
    std::stringstream text;
    text << std::ifstream{log_}.rdbuf();
    return text.str();
  }
  /// The small scenario with one piece of text replaced.
  [[nodiscard]] std::string scenario_with(const std::string& from, const std::string& to) const {
    std::stringstream text;
    text << std::ifstream{kSmall}.rdbuf();
    std::string yaml = text.str();
    const auto at = yaml.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    yaml.replace(at, from.size(), to);
    const auto file = folder_ / "changed.yaml";
    std::ofstream{file} << yaml;
    return file.string();
  }

  static constexpr const char* kSmall = SKEIN_SOURCE_DIR "/scenarios/coalition-6.yaml";
  const fs::path folder_ =
      fs::temp_directory_path() / ("skein-simulate-" + std::to_string(::getpid()));
  const fs::path log_ = folder_ / "log";
};

TEST_F(Simulate, ManySeedsAreFlownAndSummedUp) {
  EXPECT_EQ(run({kSmall, "--runs", "8", "--seed", "5", "--jobs", "2"}), "exit status 0");
  const auto text = output();
  EXPECT_NE(text.find("8, seeds 5 to 12"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\nPASS\n")) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos) << "progress is for terminals";
  EXPECT_EQ(run({kSmall, "--runs", "8", "--seed", "5", "--jobs", "1"}), "exit status 0");
  EXPECT_EQ(text, output()) << "the number of threads changes nothing";
}

TEST_F(Simulate, APlanOfTasksIsFlown) {
  auto plan = ChildProcess::start(
      {SKEIN_PROGRAMS "/skein-ground", "plan", kSmall, "--all-known", "--out", folder_.string()},
      log_, {});
  ASSERT_TRUE(plan);
  ASSERT_TRUE(plan->wait(240s) && plan->clean()) << output();
  EXPECT_EQ(run({kSmall}), "exit status 0");
  const auto searching = output();
  EXPECT_EQ(run({kSmall, "--routes", (folder_ / "plan.yaml").string()}), "exit status 0");
  EXPECT_NE(output().find("DONE: 1 of 1 sites done"), std::string::npos) << output();
  EXPECT_NE(output(), searching) << "they begin elsewhere";
  EXPECT_EQ(run({kSmall, "--routes", kSmall}), "exit status 2") << "no plan";
}

TEST_F(Simulate, AFailingSeedIsTracedByTheLineThatIsPrinted) {
  // No vehicle can pass over its site to the nanometre.
  const auto strict = scenario_with("miss_distance_m: 30", "miss_distance_m: 0.000000001");
  EXPECT_EQ(run({strict, "--runs", "2", "--seed", "3"}), "exit status 1");
  const auto text = output();
  EXPECT_NE(text.find("seed 4 VIOLATED\n  deliveries: "), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\nFAIL\n")) << text;
  const auto again = "  again: " SKEIN_PROGRAMS "/skein-hil simulate " + strict;
  ASSERT_NE(text.find(again + " --seed 4 --trace\n"), std::string::npos) << text;

  EXPECT_EQ(run({strict, "--seed", "4", "--trace"}), "exit status 1");
  EXPECT_NE(output().find("VIOLATED:\n  deliveries: "), std::string::npos) << output();
  EXPECT_NE(output().find("lease_granted"), std::string::npos) << "the full trace";
}

/// 7 m/s of wind, and 4 m/s of speed to spare: where a leg is flown with the wind, its time is kept
/// by a longer path. By speed alone most deliveries failed and were flown a second time.
TEST_F(Simulate, AnotherPathKeepsTheTimeWhereSpeedCannot) {
  std::stringstream text;
  text << std::ifstream{SKEIN_SOURCE_DIR "/scenarios/hil-2.yaml"}.rdbuf();
  std::string yaml = text.str();
  for (const auto& [from, to] :
       {std::pair{"wind: {speed_mps: 5, from_deg: 240", "wind: {speed_mps: 7, from_deg: 60"},
        std::pair{"speed_min_mps: 42.5", "speed_min_mps: 46"},
        std::pair{"speed_max_mps: 57.5", "speed_max_mps: 54"},
        std::pair{"turn_radius_margin: 1.3 ", "turn_radius_margin: 1.5 "}}) {
    const auto at = yaml.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    yaml.replace(at, std::string{from}.size(), to);
  }
  const auto file = folder_ / "windy.yaml";
  std::ofstream{file} << yaml;
  EXPECT_EQ(run({file.string(), "--runs", "8", "--seed", "1"}), "exit status 0") << output();
  // A second attempt ends after 100 s.
  const std::string average = " s on average";
  const auto at = output().find(average);
  ASSERT_NE(at, std::string::npos) << output();
  EXPECT_LT(std::stod(output().substr(output().rfind(' ', at - 1))), 90.0) << output();
}

TEST_F(Simulate, BadInputIsNoViolation) {
  EXPECT_EQ(run({"scenarios/no-such.yaml", "--runs", "2"}), "exit status 2");
  EXPECT_NE(output().find("scenarios/no-such.yaml"), std::string::npos) << output();
}

}  // namespace
}  // namespace skein::hil
