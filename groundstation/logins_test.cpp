// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/logins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "skein/identity/authority.hpp"

namespace skein::groundstation {
namespace {

namespace fs = std::filesystem;
using console::Role;
using ::testing::HasSubstr;

constexpr std::int64_t kNow_unix_s = 1'777'000'000;
constexpr OperatorKeys::Time kNow{std::chrono::hours{100}};

class LoginsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-logins-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path file() const { return folder_ / "passwords"; }
  /// One minute after what it was written before.
  void write(const std::string& text, fs::perms mode = fs::perms::owner_read) {
    fs::remove(file());
    std::ofstream{file()} << text;
    fs::permissions(file(), mode);
    fs::last_write_time(file(), fs::file_time_type{} + ++minutes_ * std::chrono::minutes{1});
  }
  static std::string line(const std::string& user, const std::string& role,
                          const std::string& password) {
    return user + ":" + role + ":" + console::hash_password(password, "5a17", 1000) + "\n";
  }

  fs::path folder_;
  int minutes_ = 0;
};

TEST_F(LoginsTest, TheFileCountsAsItIsNow) {
  OperatorKeys keys;
  write(line("ada", "operator", "a horse") + line("bob", "observer", "a cow"));
  auto logins = Logins::open(file(), keys);
  ASSERT_TRUE(logins);
  EXPECT_EQ(logins->check("ada", "a horse", kNow), Role::op);
  EXPECT_EQ(logins->check("bob", "a cow", kNow), Role::observer);
  EXPECT_EQ(logins->check("eve", "a cow", kNow), std::nullopt);
  write(line("ada", "operator", "another horse"));
  EXPECT_EQ(logins->check("ada", "a horse", kNow), std::nullopt);
  EXPECT_EQ(logins->check("ada", "another horse", kNow), Role::op);
  EXPECT_EQ(logins->check("bob", "a cow", kNow), std::nullopt);
  write("nonsense");
  EXPECT_EQ(logins->check("ada", "another horse", kNow), Role::op) << "what was known stays";
}

TEST_F(LoginsTest, AFileThatOthersReadIsRefused) {
  OperatorKeys keys;
  const std::string text = line("ada", "operator", "a horse");
  using fs::perms;
  for (const auto mode : {perms::others_read, perms::others_write, perms::group_write}) {
    write(text, perms::owner_read | mode);
    const auto logins = Logins::open(file(), keys);
    ASSERT_FALSE(logins);
    EXPECT_THAT(logins.error().message, HasSubstr("chmod 600"));
  }
  write(text, perms::owner_read | perms::group_read);
  EXPECT_TRUE(Logins::open(file(), keys)) << "the service's group";
}

TEST_F(LoginsTest, AnOperatorsKeyIsUnlockedUntilItIsRevoked) {
  auto authority = identity::Authority::create(folder_ / "mission", "ridge", 30, kNow_unix_s,
                                               identity::Durable::no);
  ASSERT_TRUE(authority);
  ASSERT_TRUE(authority->enrol_operator("ada", "ada has a horse", kNow_unix_s));
  OperatorKeys keys{folder_ / "mission", identity::Verifier{authority->certificate()},
                    [] { return kNow_unix_s; }};
  write(line("ada", "operator", "ada has a horse") + line("bob", "operator", "bob has none"));
  auto logins = Logins::open(file(), keys);
  ASSERT_TRUE(logins);
  mission::Authorisation grant{{}, SiteId{4}, true, "ada", at_seconds(10.0), {}, {}, {}};
  grant.deliveries.push_back(
      {{{SiteId{4}, TaskKind::deliver, 0}, VehicleId{2}, at_seconds(60.0)}, 0.5});
  EXPECT_FALSE(keys.approve(grant, kNow));
  EXPECT_EQ(logins->check("ada", "ada has a horse", kNow), Role::op);
  EXPECT_TRUE(keys.approve(grant, kNow));
  EXPECT_EQ(logins->check("bob", "bob has none", kNow), Role::op) << "who signs nothing";

  ASSERT_TRUE(authority->revoke(*authority->serial_of("ada")));
  keys.learn(authority->revoked());
  EXPECT_EQ(logins->check("ada", "ada has a horse", kNow), std::nullopt);
  EXPECT_EQ(logins->check("bob", "bob has none", kNow), Role::op);
}

}  // namespace
}  // namespace skein::groundstation
