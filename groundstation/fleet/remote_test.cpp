// SPDX-License-Identifier: Apache-2.0
//
// Hosts that are this machine, with programs that are shell scripts, and an ssh that is one.
#include "skein/fleet/remote.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "command.hpp"
#include "skein/configuration/deployment.hpp"

namespace skein::fleet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Runs until it is asked to end; refuses a configuration with the word `refused`.
constexpr const char* kProgram = R"(#!/bin/sh
case "$*" in
  *--version*) echo "skein-onboard 9.9"; exit 0 ;;
  *--flying*) [ -e "${0%/*}/flies" ]; exit ;;
  *--check-config*) if grep -q refused "$2"; then echo "line 1: refused"; exit 2; fi; exit 0 ;;
esac
if grep -q "title: dies" "$2"; then echo "cannot join"; exit 3; fi
trap 'exit 0' TERM
while :; do sleep 0.05; done
)";

class Remote : public testing::Test {
 protected:
  Remote() {
    fs::create_directories(folder_ / "bin");
    script(folder_ / "bin" / "skein-onboard", kProgram);
    host_.node = VehicleId{3};
    host_.address = "127.0.0.1";
    host_.programs = (folder_ / "bin").string();
    host_.configurations = (folder_ / "etc").string();
    host_.recordings = (folder_ / "it's here").string();
  }
  void TearDown() override {
    (void)stop(program(), false);
    fs::remove_all(folder_);
  }
  static void script(const fs::path& path, const std::string& text) {
    std::ofstream{path} << text;
    fs::permissions(path, fs::perms::owner_all);
  }
  [[nodiscard]] Program program() const { return program_of(host_, to_yaml(config_)); }
  [[nodiscard]] static std::string text_of(const fs::path& file) {
    std::stringstream text;
    text << std::ifstream{file}.rdbuf();
    return text.str();
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("skein-remote-" + std::to_string(::getpid()));
  configuration::Host host_;
  configuration::VehicleConfig config_ = [] {
    configuration::VehicleConfig config;
    config.vehicle.id = VehicleId{3};
    config.vehicle.cruise_speed_mps = 28.0;
    config.vehicle.speed_min_mps = 23.0;
    config.vehicle.speed_max_mps = 33.0;
    config.vehicle.turn_radius_m = 70.0;
    config.vehicle.range_m = 6000.0;
    config.vehicle.height_m = 100.0;
    config.origin = {31.5, 105.0, 0.0};
    config.time.epoch_unix_ns = 1'700'000'000'000'000'000;
    return config;
  }();
};

TEST_F(Remote, WhatIsPushedIsThereAndAsTheFile) {
  EXPECT_FALSE(status(program()).configured);
  ASSERT_TRUE(push(program(), false).ok());
  EXPECT_EQ(text_of(program().file), to_yaml(config_));
  const Status there = status(program());
  EXPECT_TRUE(there.as_the_file()) << there.trouble << there.unreadable;
  EXPECT_FALSE(there.running);
  EXPECT_EQ(there.state, "stopped");
  EXPECT_EQ(there.version, "skein-onboard 9.9");
  EXPECT_LT(std::abs(there.clock_offset_s), 5.0);
  EXPECT_EQ(std::distance(fs::directory_iterator{folder_ / "etc"}, {}), 1) << "nothing beside it";
}

TEST_F(Remote, KeysThatDifferAreNamedByValueNotByBytes) {
  ASSERT_TRUE(push(program(), false).ok());
  std::string text = text_of(program().file);
  text.replace(text.find("31.5"), 4, "31.500");
  std::ofstream{program().file} << "# by hand\n" << text;
  EXPECT_TRUE(status(program()).as_the_file());
  config_.origin.latitude_deg = 31.6;
  const Status there = status(program());
  EXPECT_FALSE(there.as_the_file());
  EXPECT_THAT(there.drift,
              ElementsAre(configuration::Difference{"origin.latitude_deg", "31.5", "31.6"}));
  std::ofstream{program().file} << "version: 7\n";
  EXPECT_THAT(status(program()).unreadable, HasSubstr("version"));
}

TEST_F(Remote, AProgramThatRunsKeepsItsConfiguration) {
  ASSERT_TRUE(push(program(), false).ok());
  ASSERT_TRUE(start(program()).ok());
  EXPECT_TRUE(status(program()).running);
  EXPECT_TRUE(start(program()).ok()) << "it runs already";
  config_.origin.latitude_deg = 31.6;
  const auto refused = push(program(), false);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("perhaps in flight"));
  EXPECT_FALSE(status(program()).drift.empty());
  EXPECT_TRUE(push(program(), true).ok());
  EXPECT_TRUE(status(program()).drift.empty());
  // Newer by whole seconds, which is what a host tells.
  const auto later = fs::last_write_time(program().file) + std::chrono::seconds{3};
  fs::last_write_time(program().file, later);
  EXPECT_TRUE(status(program()).outdated);
  ASSERT_TRUE(stop(program(), false).ok());
  EXPECT_FALSE(status(program()).running);
  EXPECT_TRUE(stop(program(), false).ok()) << "it does not run";
}

TEST_F(Remote, AConfigurationThatTheProgramRefusesReplacesNothing) {
  ASSERT_TRUE(push(program(), false).ok());
  const std::string before = text_of(program().file);
  config_.recording_folder = "refused";
  const auto refused = push(program(), false);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("line 1: refused"));
  EXPECT_EQ(text_of(program().file), before);
}

TEST_F(Remote, AProgramThatDoesNotStayIsTold) {
  Program program = this->program();
  ASSERT_TRUE(push(program, false).ok());
  std::ofstream{program.file} << "title: dies\n";
  const auto started = start(program);
  ASSERT_FALSE(started.ok());
  EXPECT_THAT(started.error().message, HasSubstr("cannot join"));
}

TEST_F(Remote, AProcessIdThatSomebodyElseHasIsNotOurs) {
  fs::create_directories(host_.recordings);
  std::ofstream{host_.recordings + "/onboard-3.pid"} << ::getpid() << "\n";
  EXPECT_FALSE(status(program()).running);
  EXPECT_TRUE(stop(program(), false).ok());  // and we are still there
}

TEST_F(Remote, SshIsGivenOneLineForTheShellThere) {
  host_.ssh = "pi@three";
  host_.run = "env A=b";
  EXPECT_THAT(command_on(host_, "echo 'x'"),
              ElementsAre("ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=5", "--", "pi@three",
                          R"('env' 'A=b' 'sh' '-c' 'echo '\''x'\''')"));
  // What ssh does with it: a shell reads the line.
  script(folder_ / "bin" / "ssh", "#!/bin/sh\nfor line; do :; done\nexec sh -c \"$line\"\n");
  // Nobody else reads the environment now. NOLINTBEGIN(concurrency-mt-unsafe)
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder_ / "bin").string().append(":").append(path).c_str(), 1);
  EXPECT_TRUE(push(program(), false).ok());
  EXPECT_TRUE(status(program()).as_the_file());
  script(folder_ / "bin" / "ssh", "#!/bin/sh\necho 'Connection refused' >&2\nexit 255\n");
  const Status there = status(program());
  EXPECT_FALSE(there.reachable);
  EXPECT_THAT(there.trouble, HasSubstr("is not reached: Connection refused"));
  ::setenv("PATH", path.c_str(), 1);
  // NOLINTEND(concurrency-mt-unsafe)
  host_.ssh.clear();
}

/// A systemctl that keeps in a file what runs, and notes what it was asked for.
constexpr const char* kSystemctl = R"(#!/bin/sh
echo "$*" >>FOLDER/asked
case "$1" in
  is-active) [ -e FOLDER/active ] && { [ "$2" = --quiet ] || echo active; exit 0; }
    [ "$2" = --quiet ] || echo inactive; exit 3 ;;
  start) [ -e FOLDER/broken ] && exit 1; touch FOLDER/active ;;
  stop) rm -f FOLDER/active ;;
  show) echo $PPID ;;
esac
)";

TEST_F(Remote, UnitsOfSystemdAreStartedAndStoppedByTheirNames) {
  std::string text = kSystemctl;
  for (auto at = text.find("FOLDER"); at != std::string::npos; at = text.find("FOLDER")) {
    text.replace(at, 6, folder_.string());
  }
  script(folder_ / "bin" / "systemctl", text);
  host_.programs.clear();
  host_.run = "env PATH=" + (folder_ / "bin").string() + ":/usr/bin:/bin";
  ASSERT_TRUE(push(program(), false).ok());
  EXPECT_EQ(status(program()).state, "inactive");
  EXPECT_EQ(status(program()).version, "skein-onboard 9.9");
  std::ofstream{folder_ / "broken"} << "";
  EXPECT_FALSE(start(program()).ok());
  fs::remove(folder_ / "broken");
  ASSERT_TRUE(start(program()).ok());
  EXPECT_EQ(status(program()).state, "active");
  EXPECT_TRUE(status(program()).running);
  EXPECT_FALSE(push(program(), false).ok());
  std::ofstream{folder_ / "bin" / "flies"} << "";
  const auto refused = stop(program(), false);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("flies: land it first"));
  EXPECT_TRUE(status(program()).running);
  fs::remove(folder_ / "bin" / "flies");
  ASSERT_TRUE(stop(program(), false).ok());
  EXPECT_FALSE(status(program()).running);
  const std::string asked = text_of(folder_ / "asked");
  EXPECT_THAT(asked, HasSubstr("\nstart skein-onboard@3.service\n"));
  EXPECT_THAT(asked, HasSubstr("\nstop skein-onboard@3.service\n"));
}

TEST_F(Remote, FoldersAreCollectedAndRemoved) {
  const fs::path there = fs::path{host_.recordings} / "run";
  fs::create_directories(there);
  std::ofstream{there / "a.mcap"} << "bytes";
  ASSERT_TRUE(collect(host_, there.string(), folder_ / "here").ok());
  EXPECT_EQ(text_of(folder_ / "here" / "a.mcap"), "bytes");
  EXPECT_EQ(std::distance(fs::directory_iterator{folder_ / "here"}, {}), 1);
  EXPECT_TRUE(remove(host_, there.string()).ok());
  EXPECT_FALSE(fs::exists(there));
  EXPECT_FALSE(collect(host_, there.string(), folder_ / "gone").ok());
}

TEST(Command, OneThatTakesTooLongIsEnded) {
  const auto outcome = run_command({"sleep", "60"}, "", std::chrono::milliseconds{50});
  ASSERT_FALSE(outcome.ok());
  EXPECT_THAT(outcome.error().message, HasSubstr("no answer within"));
  EXPECT_FALSE(run_command({"skein-no-such-program"}, "", std::chrono::seconds{1}).ok());
}

TEST(Command, MuchGoesInAndComesOut) {
  const std::string much(1 << 20, 'x');
  const auto outcome = run_command({"cat"}, much, std::chrono::seconds{20});
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->output, much);
  const auto unread = run_command({"true"}, much, std::chrono::seconds{20});
  ASSERT_TRUE(unread.ok());
  EXPECT_EQ(unread->status, 0);
}

}  // namespace
}  // namespace skein::fleet
