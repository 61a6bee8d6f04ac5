// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/child_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

namespace skein::hil {
namespace {

using namespace std::chrono_literals;

class ChildProcessTest : public testing::Test {
 protected:
  std::filesystem::path log_ = std::filesystem::temp_directory_path() /
                               ("skein-child-" + std::to_string(::getpid()) + ".log");
  void TearDown() override { std::filesystem::remove(log_); }
  [[nodiscard]] std::string output() const {
    std::stringstream text;
    text << std::ifstream{log_}.rdbuf();
    return text.str();
  }
};

TEST_F(ChildProcessTest, RunsWithItsEnvironmentAndTellsHowItEnded) {
  auto child = ChildProcess::start({"/bin/sh", "-c", "echo $SKEIN_WORD; exit 3"}, log_,
                                   {{"SKEIN_WORD", "hello"}});
  ASSERT_TRUE(child);
  ASSERT_TRUE(child->wait(10s));
  EXPECT_EQ(child->ended(), "exit status 3");
  EXPECT_FALSE(child->clean());
  EXPECT_EQ(output(), "hello\n");
}

TEST_F(ChildProcessTest, AMissingProgramIsASentence) {
  const auto child = ChildProcess::start({"/no/such/program"}, log_, {});
  ASSERT_FALSE(child);
  EXPECT_EQ(child.error().message,
            "/no/such/program: not an executable program; build it with ./dev build");
}

TEST_F(ChildProcessTest, WhoDoesNotStopIsKilled) {
  auto deaf = ChildProcess::start(
      {"/bin/sh", "-c", "trap '' TERM; echo ready; while :; do sleep 1; done"}, log_, {});
  auto good = ChildProcess::start(
      {"/bin/sh", "-c", "trap 'exit 0' TERM; echo ready; while :; do sleep 0.1; done"}, log_, {});
  ASSERT_TRUE(deaf && good);
  for (int i = 0; i < 1000 && output().size() < 12; ++i) ::usleep(10'000);
  ASSERT_EQ(output().size(), 12U) << "both have set their traps";
  EXPECT_FALSE(stop_all({&*deaf, &*good}, 2s));
  EXPECT_EQ(deaf->ended(), "signal 9 (Killed)");
  EXPECT_EQ(good->ended(), "exit status 0");
}

TEST_F(ChildProcessTest, EndsWithItsObject) {
  pid_t pid = 0;
  {
    auto child = ChildProcess::start({"/bin/sleep", "1000"}, log_, {});
    ASSERT_TRUE(child);
    pid = child->pid();
    EXPECT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

}  // namespace
}  // namespace skein::hil
