// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/operator_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "skein/identity/authority.hpp"
#include "skein/identity/register.hpp"
#include "skein/network/approval.hpp"

namespace skein::groundstation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::int64_t kNow_unix_s = 1'777'000'000;
constexpr OperatorKeys::Time kNow{std::chrono::hours{100}};

class OperatorKeysTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-operators-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    auto authority = identity::Authority::create(folder_ / "mission", "ridge", 30, kNow_unix_s,
                                                 identity::Durable::no);
    ASSERT_TRUE(authority.ok());
    for (const char* op : {"ada", "bob"}) {
      ASSERT_TRUE(authority->enrol_operator(op, std::string{op} + " has a horse", kNow_unix_s));
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  static mission::Authorisation grant(const std::string& by) {
    mission::Authorisation grant{{}, SiteId{4}, true, by, at_seconds(10.0), {}, {}, {}};
    grant.deliveries.push_back(
        {{{SiteId{4}, TaskKind::deliver, 0}, VehicleId{2}, at_seconds(60.0)}, 0.5});
    grant.until = at_seconds(60.0);
    return grant;
  }
  /// Whose key has signed it; empty where none has.
  static std::string signer_of(const OperatorKeys& keys, const std::string& by,
                               OperatorKeys::Time now = kNow) {
    auto decided = grant(by);
    if (!keys.approve(decided, now)) return "";
    const auto carried = network::carried_approval(decided);
    return carried ? carried->by.name : "nobody that can be read";
  }

  [[nodiscard]] OperatorKeys keys(std::int64_t now_unix_s = kNow_unix_s) const {
    const auto mission = identity::read_register(identity::register_file(folder_ / "mission"));
    EXPECT_TRUE(mission);
    identity::Verifier verifier{mission->authority};
    EXPECT_EQ(verifier.learn(mission->revoked), identity::Trust::good);
    return {folder_ / "mission", std::move(verifier), [now_unix_s] { return now_unix_s; }};
  }
  /// The list that says so.
  [[nodiscard]] identity::RevocationList revoke(const char* op) const {
    auto authority = identity::Authority::open(folder_ / "mission");
    EXPECT_TRUE(authority);
    EXPECT_TRUE(authority->revoke(*authority->serial_of(op)));
    return authority->revoked();
  }

  fs::path folder_;
};

TEST_F(OperatorKeysTest, OnlyWhatAPasswordUnlockedSigns) {
  OperatorKeys keys = this->keys();
  EXPECT_EQ(signer_of(keys, "ada"), "");
  auto decided = grant("ada");
  EXPECT_THAT(keys.approve(decided, kNow).error().message, HasSubstr("skein-ground unlock"));
  EXPECT_FALSE(keys.unlock("ada", "a wrong one", kNow));
  EXPECT_FALSE(keys.unlock("eve", "ada has a horse", kNow));
  EXPECT_FALSE(keys.unlock("../ada", "ada has a horse", kNow));
  ASSERT_TRUE(keys.unlock("ada", "ada has a horse", kNow));
  EXPECT_EQ(signer_of(keys, "ada"), "ada");
  EXPECT_EQ(signer_of(keys, "bob"), "") << "who has not logged in";
  EXPECT_EQ(signer_of(keys, "ada", kNow + OperatorKeys::kUnlockedFor), "");
  keys.lock("ada");
  EXPECT_EQ(signer_of(keys, "ada"), "");
}

TEST_F(OperatorKeysTest, TheMachinesOperatorSignsForWhoHasNone) {
  OperatorKeys keys = this->keys();
  ASSERT_TRUE(keys.unlock_machine("bob", "bob has a horse"));
  EXPECT_EQ(keys.machine_operator(), "bob");
  ASSERT_TRUE(keys.unlock("ada", "ada has a horse", kNow));
  EXPECT_EQ(signer_of(keys, "ada"), "ada");
  EXPECT_EQ(signer_of(keys, "scenario"), "bob");
  keys.lock_machine();
  EXPECT_EQ(signer_of(keys, "scenario"), "");
}

TEST_F(OperatorKeysTest, WhoIsRevokedSignsNoMoreAndIsNotUnlocked) {
  OperatorKeys keys = this->keys();
  ASSERT_TRUE(keys.unlock("ada", "ada has a horse", kNow));
  ASSERT_TRUE(keys.unlock("bob", "bob has a horse", kNow));
  ASSERT_TRUE(keys.unlock_machine("ada", "ada has a horse"));
  EXPECT_FALSE(keys.is_revoked("ada"));
  keys.learn(revoke("ada"));
  EXPECT_TRUE(keys.is_revoked("ada"));
  EXPECT_EQ(keys.machine_operator(), std::nullopt);
  EXPECT_EQ(signer_of(keys, "ada"), "");
  EXPECT_EQ(signer_of(keys, "bob"), "bob");
  const auto again = keys.unlock_machine("ada", "ada has a horse");
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("revoked"));
  EXPECT_FALSE(this->keys().unlock("ada", "ada has a horse", kNow)) << "after a new start, too";

  auto authority = identity::Authority::open(folder_ / "mission");
  ASSERT_TRUE(authority && authority->enrol_operator("ada", "another horse", kNow_unix_s));
  EXPECT_FALSE(keys.is_revoked("ada")) << "who has a key that holds";
  EXPECT_TRUE(keys.unlock("ada", "another horse", kNow));
}

TEST_F(OperatorKeysTest, WhatVehiclesDoNotBelieveIsNotUnlocked) {
  OperatorKeys keys = this->keys(kNow_unix_s + 31 * 86'400L);
  const auto late = keys.unlock("ada", "ada has a horse", kNow);
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, HasSubstr("valid until"));
}

TEST_F(OperatorKeysTest, WithoutKeysNothingIsSigned) {
  OperatorKeys keys;
  auto decided = grant("ada");
  EXPECT_TRUE(keys.approve(decided, kNow));
  EXPECT_TRUE(decided.approval.empty());
  EXPECT_FALSE(keys.unlock("ada", "ada has a horse", kNow));
}

TEST(Unlock, IsReadAsItWasWritten) {
  const auto read = unlock_in(line_of(Unlock{"ada", "two  words and  blanks "}));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->name, "ada");
  EXPECT_EQ(read->password, "two  words and  blanks ");
  EXPECT_TRUE(unlock_in(line_of({}))->name.empty());
  for (const char* other : {"", "unlock ada x", "status", "\x01", "\x01lock ada"}) {
    EXPECT_FALSE(unlock_in(other)) << other;
  }
}

}  // namespace
}  // namespace skein::groundstation
