// SPDX-License-Identifier: Apache-2.0
//
// Shards as a job engine runs them, processes that do not know of each other, of which one is
// killed: merged, they are what one machine writes, byte by byte.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "skein/hil/child_process.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr const char* kProgram = SKEIN_PROGRAMS "/skein-hil";
constexpr const char* kScenarios = SKEIN_SOURCE_DIR "/scenarios/";

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

std::size_t lines_of(const fs::path& file) {
  const std::string text = text_of(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Every file with its bytes.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& file : fs::directory_iterator{folder})
    files[file.path().filename().string()] = text_of(file.path());
  return files;
}

class Shards : public testing::Test {
 protected:
  Shards() { fs::create_directories(folder_); }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

  /// How the command ended; what it printed is in out() and err().
  std::string run(const std::string& command) {
    const std::string line = command + " >'" + out_.string() + "' 2>'" + err_.string() + "'";
    auto child = ChildProcess::start({"/bin/sh", "-c", line}, folder_ / "sh", {});
    EXPECT_TRUE(child);
    return child->wait(300s) ? *child->ended() : "still running";
  }
  [[nodiscard]] std::string out() const { return text_of(out_); }
  [[nodiscard]] std::string err() const { return text_of(err_); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  /// Begins the shard and kills it with two of its runs flown and many before it. Where it is done
  /// before that, since this process was not given its turn, it is begun anew.
  void fly_and_kill(const std::vector<std::string>& command, const std::string& shard,
                    const fs::path& into) {
    std::vector<std::string> argv{kProgram};
    argv.insert(argv.end(), command.begin(), command.end());
    argv.insert(argv.end(), {"--jobs", "1", "--shard", shard, "--out", into.string()});
    std::string ended = "exit status 0";
    for (int i = 0; i < 5 && ended == "exit status 0"; ++i) {
      fs::remove_all(into);
      auto child = ChildProcess::start(argv, folder_ / "killed", {});
      ASSERT_TRUE(child);
      while (lines_of(into / "runs.csv") < 3 && !child->ended()) std::this_thread::sleep_for(1ms);
      child->signal(SIGKILL);
      ASSERT_TRUE(child->wait(60s));
      ended = *child->ended();
    }
    ASSERT_EQ(ended, "signal 9 (Killed)") << text_of(folder_ / "killed");
    // As if it had been within a write.
    std::ofstream{into / "runs.csv", std::ios::app} << "17,1,";
  }

  /// Flies it on one machine and in shards, and compares.
  void try_shards(const std::vector<std::string>& command, const std::string& status) {
    std::string words = kProgram;
    for (const std::string& word : command) words += " " + word;
    ASSERT_EQ(run(words + " --out " + path("one")), status) << err();
    // Where they are put is all that the two print differently.
    const auto printed = [this](const std::string& folder) {
      std::string text = out();
      const auto at = text.find(path(folder));
      return at == std::string::npos ? text : text.replace(at, path(folder).size(), "-");
    };
    const std::string one = printed("one");

    fly_and_kill(command, "2/3", path("shard-2"));
    for (const std::string number : {"1", "3"}) {
      std::string order = words;
      order.append(" --shard ").append(number).append("/3 --out ").append(path("shard-" + number));
      ASSERT_EQ(run(order), "exit status 0") << err();
    }
    const std::string merge = std::string{kProgram} + " merge " + path("shard-1") + " " +
                              path("shard-2") + " " + path("shard-3") + " --out " + path("whole");
    ASSERT_EQ(run(merge), "exit status 1");
    EXPECT_NE(err().find("of shards 2 of 3; to fly them:\n  " + std::string{kProgram}),
              std::string::npos)
        << err();
    // The line that is printed flies what is missing.
    const auto at = err().find(std::string{"  "} + kProgram);
    ASSERT_NE(at, std::string::npos) << err();
    ASSERT_EQ(run(err().substr(at, err().find('\n', at) - at)), "exit status 0") << err();
    EXPECT_NE(err().find(" runs flown now"), std::string::npos) << err();
    EXPECT_EQ(lines_of(path("shard-1") + "/runs.csv"), lines_of(path("shard-2") + "/runs.csv"));

    ASSERT_EQ(run(merge), status) << err();
    EXPECT_EQ(err(), "");
    EXPECT_EQ(printed("whole"), one);
    const auto whole = files_of(path("whole"));
    for (const auto& [name, text] : files_of(path("one"))) {
      ASSERT_TRUE(whole.contains(name)) << name;
      EXPECT_TRUE(whole.at(name) == text) << name << " differs in " << folder_;
    }
    EXPECT_EQ(whole.size(), files_of(path("one")).size());
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("skein-shards-" + std::to_string(::getpid()) + "-" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
  const fs::path out_ = folder_ / "out";
  const fs::path err_ = folder_ / "err";
};

TEST_F(Shards, OfACoalitionAreOneMachines) {
  const std::string scenario = std::string{kScenarios} + "faults-8.yaml";
  try_shards({"simulate", scenario, "--runs", "15", "--faults", "mixed"}, "exit status 0");
  // With or without a folder the same is printed.
  const std::string kept = out();
  EXPECT_EQ(run(std::string{kProgram} + " simulate " + scenario + " --runs 15 --faults mixed"),
            "exit status 0");
  EXPECT_EQ(out(), kept);

  // A shard of fewer runs, merged into the whole, takes none of its runs out of sight.
  ASSERT_EQ(run(std::string{kProgram} + " simulate " + scenario +
                " --runs 6 --faults mixed --shard 1/3 --out " + path("few")),
            "exit status 0");
  EXPECT_EQ(run(std::string{kProgram} + " merge " + path("few") + " --out " + path("whole")),
            "exit status 0")
      << err();
  EXPECT_EQ(files_of(path("whole")), files_of(path("one")));

  // Other faults are another experiment.
  EXPECT_EQ(
      run(std::string{kProgram} + " simulate " + scenario + " --runs 15 --out " + path("one")),
      "exit status 2");
  EXPECT_NE(err().find("of the faults mixed"), std::string::npos) << err();

  // A machine that says otherwise of a run is found, with the file that it contradicts.
  fs::copy(path("shard-3"), path("liar"));
  std::string rows = text_of(path("liar") + "/runs.csv");
  const auto first = rows.find('\n') + 1;
  const auto number = rows.find(",1,", first);
  ASSERT_NE(number, std::string::npos) << rows;
  rows.replace(number, 3, ",0,");
  std::ofstream{path("liar") + "/runs.csv", std::ios::binary} << rows;
  EXPECT_EQ(run(std::string{kProgram} + " merge " + path("shard-3") + " " + path("liar") +
                " --out " + path("lies")),
            "exit status 2");
  EXPECT_NE(err().find(path("liar") + "/runs.csv:"), std::string::npos) << err();
  EXPECT_NE(err().find(path("shard-3") + "/runs.csv says of it"), std::string::npos) << err();
}

TEST_F(Shards, OfRunsWithViolationsAreOneMachines) {
  // No vehicle can pass over its site to the nanometre.
  std::string yaml = text_of(std::string{kScenarios} + "coalition-6.yaml");
  const std::string was = "miss_distance_m: 30";
  const auto at = yaml.find(was);
  ASSERT_NE(at, std::string::npos);
  yaml.replace(at, was.size(), "miss_distance_m: 0.000000001");
  std::ofstream{path("strict.yaml")} << yaml;
  try_shards({"simulate", path("strict.yaml"), "--runs", "90", "--seed", "7"}, "exit status 1");
  EXPECT_NE(out().find(" VIOLATED\n  deliveries: "), std::string::npos) << out();
}

TEST_F(Shards, OfAFormationAreOneMachines) {
  try_shards({"simulate", std::string{kScenarios} + "formation-5.yaml", "--runs", "24", "--faults",
              "mixed"},
             "exit status 0");
  EXPECT_NE(out().find("\nheld "), std::string::npos) << "a reason, too: " << out();
}

TEST_F(Shards, OfASweepAreOneMachines) {
  const auto file = path("tiny.yaml");
  std::ofstream{file} << "version: 1\ntitle: Try, with a comma\nscenario: " << kScenarios
                      << "coalition-6.yaml\nruns: 9\naxes:\n"
                         "  - name: method\n    points:\n"
                         "      - {label: ours}\n"
                         "      - {label: \"poly, nomial\", allocation: polynomial}\n"
                         "  - name: margin\n    points:\n"
                         "      - {label: short, formation_margin_s: 0.3}\n"
                         "      - {label: long, formation_margin_s: 1}\n";
  try_shards({"sweep", file}, "exit status 0");
}

}  // namespace
}  // namespace skein::hil
