// SPDX-License-Identifier: Apache-2.0
#include "skein/identity_desk/keys_shown.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "skein/codec/json_text.hpp"
#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/team.hpp"
#include "skein/identity_desk/given.hpp"

namespace skein::identity_desk {
namespace {

constexpr std::int64_t kNow_unix_s = 1'777'000'000;
constexpr std::int64_t kDay_s = 86'400;

class KeysShownTest : public testing::Test {
 public:
  KeysShownTest(const KeysShownTest&) = delete;
  KeysShownTest& operator=(const KeysShownTest&) = delete;
  ~KeysShownTest() override { std::filesystem::remove_all(folder_); }

 protected:
  KeysShownTest() {
    std::string name = testing::TempDir() + "skein-keys-XXXXXX";
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    EXPECT_TRUE(identity::make_team(folder_, std::vector{VehicleId{3}, VehicleId{4}}, kNow_unix_s));
  }
  [[nodiscard]] identity::KeyFolder of(std::uint16_t node) const {
    return {identity::node_folder(folder_, VehicleId{node}), {}};
  }
  std::filesystem::path folder_;
};

TEST_F(KeysShownTest, AtTheGroundStationNamesAllMembers) {
  {
    auto authority = identity::Authority::open(of(0).folder);
    ASSERT_TRUE(authority);
    ASSERT_TRUE(authority->revoke(*authority->serial_of(VehicleId{4})));
  }
  const auto shown = show_keys(of(0), kNow_unix_s);
  EXPECT_TRUE(shown.good) << shown.text;
  const auto json = codec::parse_json(shown.json);
  EXPECT_EQ(json.at("mission").at("name"), "bench");
  EXPECT_EQ(json.at("epoch"), 2);
  EXPECT_EQ(json.at("own").at("role"), "ground");
  ASSERT_EQ(json.at("members").size(), 4U) << "the ground station, an operator, two vehicles";
  EXPECT_EQ(json.at("members")[2].at("vehicle"), 3);
  EXPECT_EQ(json.at("members")[2].at("revoked"), false);
  EXPECT_EQ(json.at("members")[3].at("revoked"), true);
  EXPECT_NE(shown.text.find("vehicle 4  REVOKED"), std::string::npos) << shown.text;
  EXPECT_NE(shown.text.find("30 days left"), std::string::npos) << shown.text;
}

TEST_F(KeysShownTest, OnBoardNamesThisNode) {
  const auto shown = show_keys(of(3), kNow_unix_s);
  EXPECT_TRUE(shown.good) << shown.text;
  const auto json = codec::parse_json(shown.json);
  EXPECT_EQ(json.at("own").at("vehicle"), 3);
  EXPECT_EQ(json.at("starts"), 0);
  EXPECT_FALSE(json.contains("members"));
}

TEST_F(KeysShownTest, SaysWhatIsWrong) {
  const auto is_wrong = [this](std::uint16_t node, std::int64_t now, const char* why) {
    const auto shown = show_keys(of(node), now);
    EXPECT_FALSE(shown.good);
    EXPECT_NE(shown.text.find(why), std::string::npos) << shown.text;
    EXPECT_FALSE(codec::parse_json(shown.json).at("problems").empty());
  };
  is_wrong(3, kNow_unix_s + 31 * kDay_s, "create a new mission");
  is_wrong(3, 0, "set the clock");
  is_wrong(9, kNow_unix_s, "skein-onboard enrol");
  std::filesystem::remove(of(3).folder / "starts");
  is_wrong(3, kNow_unix_s, "echo 1000");
  std::filesystem::remove(of(4).folder / "membership");
  is_wrong(4, kNow_unix_s, "--membership");
  ASSERT_EQ(::chmod((of(4).folder / "node.key").c_str(), 0644), 0);
  is_wrong(4, kNow_unix_s, "chmod 600");
}

// The private keys are not what is shown, in no form.
TEST_F(KeysShownTest, ShowsNoSecret) {
  for (const std::uint16_t node : std::array<std::uint16_t, 2>{0, 3}) {
    const auto shown = show_keys(of(node), kNow_unix_s);
    EXPECT_EQ(shown.text.find("KEY-1:"), std::string::npos);
    EXPECT_EQ(shown.json.find("KEY-1:"), std::string::npos);
  }
}

TEST(Given, IsALineOrAFilesLines) {
  EXPECT_EQ(*given_lines("SKEIN-X", "SKEIN-"), std::vector<std::string>{"SKEIN-X"});
  EXPECT_FALSE(given_lines("no-such-file", "SKEIN-"));
}

TEST_F(KeysShownTest, NamesWhatOthersMayRead) {
  for (const char* file : {"authority.key", "operators/rehearsal.key"}) {
    const auto path = of(0).folder / file;
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    std::filesystem::permissions(path, std::filesystem::perms{0640});
    const auto shown = show_keys(of(0), kNow_unix_s);
    EXPECT_FALSE(shown.good);
    EXPECT_NE(shown.text.find(path.string() + ": others may read it"), std::string::npos)
        << shown.text;
    std::filesystem::permissions(path, std::filesystem::perms{0600});
  }
  EXPECT_TRUE(show_keys(of(0), kNow_unix_s).good);
}

}  // namespace
}  // namespace skein::identity_desk
