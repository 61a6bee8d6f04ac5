// SPDX-License-Identifier: Apache-2.0
//
// The programs as a person starts them: real processes, Fast DDS, the radio between them.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "skein/configuration/process_config.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/recording/reader.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

int g_tests = 0;

class EndToEnd : public testing::Test {
 protected:
  EndToEnd() { fs::create_directories(folder_); }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

  ChildProcess start(const std::vector<std::string>& arguments) {
    std::vector<std::string> argv{SKEIN_PROGRAMS "/skein-hil"};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    auto child = ChildProcess::start(argv, log_, {});
    EXPECT_TRUE(child);
    return std::move(child).value();
  }
  /// Runs to the end; its output is in output().
  std::string run(const std::vector<std::string>& arguments) {
    auto child = start(arguments);
    return child.wait(240s) ? *child.ended() : "still running";
  }
  [[nodiscard]] static std::string text_of(const fs::path& file) {
    std::stringstream text;
    text << std::ifstream{file}.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string output() const { return text_of(log_); }
  bool wait_for_output(const std::string& words) const {
    for (int i = 0; i < 3000; ++i) {
      if (output().find(words) != std::string::npos) return true;
      ::usleep(20'000);
    }
    return false;
  }
  /// A copy of a scenario with one piece of text replaced.
  [[nodiscard]] std::string scenario_with(const std::string& from, const std::string& to,
                                          const fs::path& base = kSmall) const {
    std::string yaml = text_of(base);
    const auto at = yaml.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    yaml.replace(at, from.size(), to);
    const auto file = folder_ / "changed.yaml";
    std::ofstream{file} << yaml;
    return file.string();
  }
  /// Processes that a process has started and that still run.
  static std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    for (const auto& entry : fs::directory_iterator{"/proc"}) {
      std::ifstream file{entry.path() / "stat"};
      std::string line;
      if (!std::getline(file, line)) continue;
      std::stringstream fields{line.substr(line.rfind(')') + 2)};
      char state = 0;
      pid_t its_parent = 0;
      if (fields >> state >> its_parent && its_parent == parent && state != 'Z') {
        children.push_back(std::stoi(line));
      }
    }
    return children;
  }
  static std::string radio_tables_of(pid_t pid) {
    std::string found;
    for (const auto& entry : fs::directory_iterator{"/dev/shm"}) {
      const auto name = entry.path().filename().string();
      if (name.starts_with("skein-radio-" + std::to_string(pid) + "-")) found += name;
    }
    return found;
  }

  static constexpr const char* kSmall = SKEIN_SOURCE_DIR "/scenarios/coalition-6.yaml";
  const fs::path folder_ =
      fs::temp_directory_path() /
      ("skein-end-to-end-" + std::to_string(::getpid()) + "-" + std::to_string(++g_tests));
  const fs::path log_ = folder_ / "log";
};

TEST_F(EndToEnd, TheSmallMissionIsFlownAndJudged) {
  EXPECT_EQ(run({"run", kSmall, "--headless", "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  const auto text = output();
  const auto last = text.rfind('\n', text.size() - 2);
  EXPECT_TRUE(text.substr(last + 1).starts_with("PASS")) << text;
  EXPECT_TRUE(fs::exists(folder_ / "run" / "mission.mcap"));
  EXPECT_EQ(run({"reexecute", (folder_ / "run").string()}), "exit status 0") << output();
  EXPECT_NE(output().find("vehicle 6: "), std::string::npos) << output();
}

// Its script decides there, and not before the first one is gone.
TEST_F(EndToEnd, TheSecondGroundStationTakesOverFromOneThatHasDied) {
  const auto late =
      scenario_with("  - {site: 1, decision: grant, reaction_s: 1}\n",
                    "  - {site: 1, decision: grant, reaction_s: 1, not_before_s: 21}\n"
                    "faults:\n"
                    "  - {at_s: 8, kill_vehicle: 0}\n");
  EXPECT_EQ(run({"run", late, "--headless", "--ground-stations", "2", "--take-command", "20",
                 "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  const auto log = text_of(folder_ / "run" / "ground-2.log");
  EXPECT_NE(log.find("ground-1 has the command: this ground station only watches"),
            std::string::npos);
  EXPECT_NE(log.find("NOBODY is in command: ground-1 was not heard"), std::string::npos) << log;
  EXPECT_NE(log.find("this ground station has the command: ground-2"), std::string::npos);
}

TEST_F(EndToEnd, TheFirstGroundStationStepsBackWhereTheSecondTakesTheCommand) {
  const auto late = scenario_with("reaction_s: 1}", "reaction_s: 1, not_before_s: 15}");
  EXPECT_EQ(run({"run", late, "--headless", "--ground-stations", "2", "--take-command", "10",
                 "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  const auto first = text_of(folder_ / "run" / "ground.log");
  EXPECT_NE(first.find("this ground station has the command: ground-1"), std::string::npos);
  const auto told = first.find("has the command: this ground station only watches");
  ASSERT_NE(told, std::string::npos) << first;
  EXPECT_NE(first.substr(0, told).rfind("ground-2 ("), std::string::npos) << first;
}

TEST_F(EndToEnd, CoptersSurveyAndAssessWhatPlanesDeliver) {
  const std::string mission = SKEIN_SOURCE_DIR "/scenarios/mixed-6.yaml";
  EXPECT_EQ(run({"run", mission, "--headless", "--rate", "3", "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  EXPECT_NE(output().find("1 survey, 2 assess"), std::string::npos) << output();
  EXPECT_EQ(run({"reexecute", (folder_ / "run").string()}), "exit status 0") << output();
}

TEST_F(EndToEnd, WhoseBatteryFallsFliesHomeAndTheOthersDoItsWork) {
  const std::string mission = scenario_with(
      "sites:\n", "faults:\n  - {at_s: 22, battery_vehicle: 2, battery_percent: 33}\n\nsites:\n",
      SKEIN_SOURCE_DIR "/scenarios/hil-2.yaml");
  EXPECT_EQ(run({"run", mission, "--headless", "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  EXPECT_NE(output().find("vehicle 2: warning: flies home: its battery leaves"), std::string::npos)
      << output();
  const auto low = recording::read(folder_ / "run" / "vehicle-02", VehicleId{2});
  ASSERT_TRUE(low.ok()) << low.error().message;
  const auto& first = low->track.front().state;
  const auto& last = low->track.back().state;
  EXPECT_GE(first.battery_percent, 99);
  EXPECT_LE(last.battery_percent, 33);
  EXPECT_GT(last.battery_percent, 20);  // its reserve
  // In the orbit at home, or on its way there when the others' work is done.
  const Vec2 home = low->plans.back().plan.path.end().position();
  EXPECT_LT(std::hypot(home.x() - first.x_m, home.y() - first.y_m), 500.0);
  EXPECT_EQ(run({"reexecute", (folder_ / "run").string()}), "exit status 0") << output();
}

TEST_F(EndToEnd, AVehicleThatDiesEndsTheRunAndNothingIsLeft) {
  auto bench = start({"run", kSmall, "--headless", "--out", (folder_ / "run").string()});
  ASSERT_TRUE(wait_for_output("all 6 vehicles heard")) << output();
  const auto children = children_of(bench.pid());
  ASSERT_EQ(children.size(), 7U);
  ::kill(children.back(), SIGKILL);
  ASSERT_TRUE(bench.wait(60s));
  EXPECT_EQ(bench.ended(), "exit status 1") << output();
  EXPECT_NE(output().find("ended by itself: signal 9 (Killed)"), std::string::npos) << output();
  for (const pid_t child : children) EXPECT_NE(::kill(child, 0), 0) << child << " still runs";
  EXPECT_EQ(radio_tables_of(bench.pid()), "");
}

TEST_F(EndToEnd, AFormationGoesOnWithoutTheVehicleThatIsLostInAChange) {
  const std::string mission = SKEIN_SOURCE_DIR "/tests/end_to_end/formation-loss.yaml";
  EXPECT_EQ(run({"run", mission, "--headless", "--rate", "2", "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  EXPECT_NE(output().find("vehicle 2 is silent"), std::string::npos) << output();
  const auto ground = recording::read(folder_ / "run" / "ground", kGroundStation);
  ASSERT_TRUE(ground.ok()) << ground.error().message;
  EXPECT_FALSE(ground->places.empty());
  EXPECT_EQ(run({"reexecute", (folder_ / "run").string()}), "exit status 0") << output();
}

TEST_F(EndToEnd, AFormationIsSafeThroughLossSilenceAndWithoutLeaderAndGroundStation) {
  const std::string mission = SKEIN_SOURCE_DIR "/tests/end_to_end/formation-faults.yaml";
  EXPECT_EQ(run({"run", mission, "--headless", "--rate", "2", "--out", (folder_ / "run").string()}),
            "exit status 0")
      << output();
  EXPECT_NE(output().find("fault: vehicle 1 is killed"), std::string::npos) << output();
  EXPECT_NE(output().find("fault: the ground station is killed"), std::string::npos) << output();
}

TEST_F(EndToEnd, AFormationObeysOrdersFromAnotherShell) {
  const fs::path run_folder = folder_ / "run";
  const std::string unscripted =
      scenario_with("script: [take-off, form wedge spacing 5 at 0 40 12, rally, land]",
                    "script: []", SKEIN_SOURCE_DIR "/tests/end_to_end/formation-loss.yaml");
  auto bench = start({"run", unscripted, "--headless", "--prompt", "--out", run_folder.string()});
  ASSERT_TRUE(wait_for_output("the mission begins")) << output();
  const fs::path told = folder_ / "told";
  const auto tell = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {SKEIN_PROGRAMS "/skein-ground", "tell", "--config",
                                 (run_folder / "ground.yaml").string()});
    fs::remove(told);
    auto child = ChildProcess::start(words, told, {});
    EXPECT_TRUE(child);
    EXPECT_TRUE(child->wait(60s));
    return child->ended().value_or("still running");
  };
  // Refused until the mission begins and everybody is heard.
  const auto until = std::chrono::steady_clock::now() + 60s;
  while ((tell({"preview", "take-off"}) != "exit status 0" ||
          text_of(told).find("preview: 4 vehicles") == std::string::npos) &&
         std::chrono::steady_clock::now() < until) {
    ::usleep(100'000);
  }
  EXPECT_NE(text_of(told).find("preview: 4 vehicles"), std::string::npos) << text_of(told);
  EXPECT_EQ(tell({"form", "wedge", "spacing", "0.6"}), "exit status 1") << text_of(told);
  EXPECT_EQ(tell({"take-off"}), "exit status 0") << text_of(told);
  EXPECT_TRUE(wait_for_output("formation held")) << output();
  EXPECT_EQ(tell({"record", (folder_ / "evening").string()}), "exit status 0") << text_of(told);
  EXPECT_EQ(tell({"quit"}), "exit status 0") << text_of(told);
  EXPECT_TRUE(bench.wait(60s));
  EXPECT_EQ(bench.ended(), "exit status 0") << output();
}

TEST_F(EndToEnd, RoutesArePlannedThenFlownAndOnlyAsTheMissionIs) {
  const std::string mission = SKEIN_SOURCE_DIR "/scenarios/routes-3.yaml";
  const fs::path plan = folder_ / "plan" / "plan.yaml";
  {
    auto child = ChildProcess::start({std::string{SKEIN_PROGRAMS "/skein-ground"}, "plan", mission,
                                      "--out", plan.parent_path().string()},
                                     folder_ / "planned", {});
    ASSERT_TRUE(child);
    ASSERT_TRUE(child->wait(60s));
    ASSERT_EQ(child->ended(), "exit status 0") << text_of(folder_ / "planned");
  }
  EXPECT_NE(text_of(folder_ / "planned").find("every rule holds"), std::string::npos);
  EXPECT_TRUE(fs::exists(plan.parent_path() / "vehicle-3.plan"));

  // The mission has changed since.
  EXPECT_EQ(run({"run", scenario_with("site_east_m: 990", "site_east_m: 995", mission), "--routes",
                 plan.string(), "--headless", "--out", (folder_ / "refused").string()}),
            "exit status 2");
  EXPECT_NE(output().find("for another site; plan it anew"), std::string::npos) << output();
  fs::remove(log_);

  EXPECT_EQ(run({"run", mission, "--routes", plan.string(), "--headless", "--rate", "3", "--out",
                 (folder_ / "run").string()}),
            "exit status 0")
      << output();
  const auto text = output();
  EXPECT_NE(text.find("ok   routes               3 routes"), std::string::npos) << text;
  EXPECT_NE(text.find("ok   hazards"), std::string::npos) << text;
  EXPECT_NE(text.find("\nPASS: all"), std::string::npos) << text;
}

TEST_F(EndToEnd, CtrlCStopsEverything) {
  auto bench = start({"run", kSmall, "--headless", "--out", (folder_ / "run").string()});
  ASSERT_TRUE(wait_for_output("all 6 vehicles heard")) << output();
  const auto children = children_of(bench.pid());
  bench.signal(SIGINT);
  ASSERT_TRUE(bench.wait(60s));
  EXPECT_EQ(bench.ended(), "exit status 1");
  EXPECT_NE(output().find("interrupted"), std::string::npos) << output();
  for (const pid_t child : children) EXPECT_NE(::kill(child, 0), 0) << child << " still runs";
  EXPECT_EQ(radio_tables_of(bench.pid()), "");
}

TEST_F(EndToEnd, TheSameSeedIsSimulatedByteForByte) {
  const std::string mission = SKEIN_SOURCE_DIR "/scenarios/coalition-32.yaml";
  EXPECT_EQ(run({"simulate", mission, "--trace"}), "exit status 0") << output();
  const std::string once = output();
  fs::remove(log_);
  EXPECT_EQ(run({"simulate", mission, "--trace"}), "exit status 0");
  EXPECT_EQ(once, output());
  fs::remove(log_);
  EXPECT_EQ(run({"simulate", mission, "--trace", "--seed", "99"}), "exit status 0");
  EXPECT_NE(once, output());
}

struct BadInput {
  const char* name;
  const char* from;
  const char* to;
  const char* sentence;
};

class BadScenario : public EndToEnd, public testing::WithParamInterface<BadInput> {};

TEST_P(BadScenario, IsRefusedInASentence) {
  EXPECT_EQ(run({"run", scenario_with(GetParam().from, GetParam().to), "--headless"}),
            "exit status 2")
      << output();
  EXPECT_NE(output().find(GetParam().sentence), std::string::npos) << output();
}

INSTANTIATE_TEST_SUITE_P(
    EndToEnd, BadScenario,
    testing::Values(
        BadInput{"UnknownKey", "range_m: 6000", "rnage_m: 6000", "did you mean"},
        BadInput{"UnitRange", "cruise_speed_mps: 28", "cruise_speed_mps: -28", "cruise_speed_mps"},
        BadInput{"DuplicateVehicle", "id: 3, type: carrier", "id: 2, type: carrier", "2"},
        BadInput{"ImpossibleMission", "bearings_deg: [0, 120, 240]",
                 "bearings_deg: [0, 60, 120, 180, 240, 300]", "deliver"}),
    [](const auto& bad) { return std::string{bad.param.name}; });

TEST_F(EndToEnd, AMissingFileIsNamed) {
  EXPECT_EQ(run({"run", "scenarios/no-such.yaml"}), "exit status 2");
  EXPECT_NE(output().find("scenarios/no-such.yaml"), std::string::npos) << output();
}

TEST_F(EndToEnd, APortInUseIsNamedWithItsRemedy) {
  const int s = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ASSERT_EQ(::inet_pton(AF_INET, configuration::AirConfig{}.group.c_str(), &address.sin_addr), 1);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(s, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(::getsockname(s, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const auto port = std::to_string(ntohs(address.sin_port));
  EXPECT_EQ(
      run({"run", kSmall, "--headless", "--port-base", port, "--out", (folder_ / "run").string()}),
      "exit status 2");
  EXPECT_NE(output().find("UDP port " + port + " is in use"), std::string::npos) << output();
  ::close(s);
}

}  // namespace
}  // namespace skein::hil
