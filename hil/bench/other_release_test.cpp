// SPDX-License-Identifier: Apache-2.0
#include "other_release.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace skein::hil {
namespace {

TEST(OtherRelease, AKeyGoesWithAllThatIsBelowIt) {
  const std::string yaml =
      "version: 1\n"
      "traffic:\n"
      "  horizontal_m: 600\n"
      "  aircraft:\n"
      "    - {id: 1}\n"
      "vehicle:\n"
      "  id: 3\n"
      "  recovery: home\n";
  EXPECT_EQ(without_keys(yaml, {2, 8}), "version: 1\nvehicle:\n  id: 3\n");
  EXPECT_EQ(without_keys(yaml, {}), yaml);
}

class Program : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  /// What stands for another release's program.
  std::filesystem::path script(const std::string& body) {
    const auto file = folder_ / "program";
    std::ofstream{file} << "#!/bin/sh\n" << body;
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  }

  std::filesystem::path folder_ =
      std::filesystem::path{testing::TempDir()} / ("other-release-" + std::to_string(::getpid()));
};

TEST_F(Program, IsAskedUntilItTakesTheFile) {
  const auto file = folder_ / "vehicle.yaml";
  std::ofstream{file} << "id: 3\nnew:\n  deep: 1\nnewer: 2\n";
  const auto program = script(
      "n=$(grep -n '^new' \"$2\" | head -n 1 | cut -d: -f1)\n"
      "[ -z \"$n\" ] && exit 0\n"
      "echo \"skein-onboard: $2:$n: new: is no key of this group, which knows id\" >&2\n"
      "exit 2\n");
  const auto left_out = fit_configuration(file, program, folder_ / "log");
  ASSERT_TRUE(left_out) << left_out.error().message;
  EXPECT_EQ(left_out->size(), 2U);
  std::ifstream in{file};
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>{in}, {}}), "id: 3\n");
}

TEST_F(Program, ThatRefusesItForAnythingElseIsNoHelp) {
  const auto file = folder_ / "vehicle.yaml";
  std::ofstream{file} << "id: 3\n";
  const auto left_out =
      fit_configuration(file, script("echo 'id: too small' >&2; exit 2\n"), folder_ / "log");
  ASSERT_FALSE(left_out);
  EXPECT_NE(left_out.error().message.find("too small"), std::string::npos);
}

}  // namespace
}  // namespace skein::hil
