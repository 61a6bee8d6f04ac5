// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/authority.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>

#include "skein/base/stations.hpp"
#include "skein/identity/register.hpp"
#include "skein/identity/team.hpp"
#include "test_mission.hpp"

namespace skein::identity {
namespace {

class AuthorityTest : public TestMission {
 protected:
  [[nodiscard]] Authority reopen() const {
    auto made = Authority::open(ground());
    EXPECT_TRUE(made) << made.error().message;
    return std::move(made).value();
  }
};

TEST_F(AuthorityTest, IsAsItWasWhenItIsOpenedAgain) {
  Certificate certificate;
  std::vector<Certificate> members;
  {
    Authority authority = create();
    enrol(authority, 1);
    enrol(authority, 2);
    ASSERT_TRUE(authority.revoke(*authority.serial_of(VehicleId{1})));
    certificate = authority.certificate();
    members = authority.members();
  }
  const Authority again = reopen();
  EXPECT_EQ(again.certificate(), certificate);
  EXPECT_EQ(again.members(), members);
  EXPECT_EQ(members.size(), 3U) << "and the ground station";
  EXPECT_EQ(again.epoch(), 2);
  EXPECT_FALSE(again.serial_of(VehicleId{1}));
  EXPECT_EQ(again.serial_of(VehicleId{2}), Serial{3});
}

TEST_F(AuthorityTest, IsOfOneProcessAtATime) {
  {
    const Authority authority = create();
    const auto second = Authority::open(ground(), std::chrono::milliseconds{0});
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("another command has it"), std::string::npos);
  }
  EXPECT_TRUE(Authority::open(ground()));
}

TEST_F(AuthorityTest, KeepsItsSecretsToItself) {
  static_cast<void>(create());
  for (const auto& entry : std::filesystem::directory_iterator{ground()}) {
    struct stat is {};
    ASSERT_EQ(::stat(entry.path().c_str(), &is), 0);
    EXPECT_EQ(is.st_mode & 0077U, 0U) << entry.path();
  }
  for (const char* name : {"authority.key", "register"}) {
    ASSERT_EQ(::chmod((ground() / name).c_str(), 0640), 0);
    const auto opened = Authority::open(ground());
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("chmod 600"), std::string::npos);
    ASSERT_EQ(::chmod((ground() / name).c_str(), 0600), 0);
  }
}

TEST_F(AuthorityTest, TwoMissionsAreNotOne) {
  auto other = Authority::create(folder_ / "other", "ridge", 30, kNow_unix_s, Durable::no);
  ASSERT_TRUE(other);
  Authority authority = create();
  EXPECT_NE(other->certificate().mission, authority.certificate().mission);
  const Membership member = enrol(authority, 1);
  EXPECT_EQ(check(member.own, other->certificate(), kNow_unix_s), Trust::other_mission);
  EXPECT_EQ(open(1).take({other->revoked(), member.keys.grant}), Changed::not_ours);
}

TEST_F(AuthorityTest, TakesAFolderOfItsOwn) {
  static_cast<void>(create());
  const auto second = Authority::create(ground(), "ridge", 30, kNow_unix_s, Durable::no);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("a folder of its own"), std::string::npos);
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_TRUE(Authority::create(folder_ / "empty/", "ridge", 30, kNow_unix_s, Durable::no));
  EXPECT_TRUE(Authority::open(folder_ / "empty"));
}

TEST_F(AuthorityTest, WhatACutLeftOfCreationIsInNobodysWay) {
  std::filesystem::create_directories(folder_ / "ground.new" / "operators");
  put(folder_ / "ground.new" / "authority.key", "SKEIN-AUTH");
  static_cast<void>(create());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ground.new"));
  EXPECT_TRUE(Authority::open(ground()));
}

TEST_F(AuthorityTest, RefusesNamesAndDaysThatAreNone) {
  for (const char* name : {"", "a b", "../a", "-x", "\x1b[31m"}) {
    EXPECT_FALSE(Authority::create(ground(), name, 30, kNow_unix_s, Durable::no)) << name;
  }
  for (const int days : {-1, 0, 367}) {
    EXPECT_FALSE(Authority::create(ground(), "ridge", days, kNow_unix_s, Durable::no)) << days;
  }
  EXPECT_FALSE(std::filesystem::exists(ground()));
}

TEST_F(AuthorityTest, EnrolsAllOrNone) {
  Authority authority = create();
  Request bad = request(2);
  bad.proof[0] ^= 1U;
  const std::vector requests{request(1), bad, request(3)};
  const auto answers = authority.enrol(requests, kNow_unix_s);
  ASSERT_FALSE(answers);
  EXPECT_NE(answers.error().message.find("vehicle 2"), std::string::npos);
  EXPECT_EQ(authority.members().size(), 1U);
}

TEST_F(AuthorityTest, RefusesAKeyThatAgreesWithEverybodyOnTheSame) {
  Authority authority = create();
  const NodeKey key = make_node_key(VehicleId{1});
  Request bad = request_of(key);
  bad.agree_key = {};
  sign(bad, key.sign);
  EXPECT_TRUE(is_proven(bad));
  const std::vector requests{bad};
  EXPECT_FALSE(authority.enrol(requests, kNow_unix_s));
}

TEST_F(AuthorityTest, OneVehicleHasOneCertificateUnlessItWasRevoked) {
  Authority authority = create();
  const Membership first = enrol(authority, 1);
  EXPECT_EQ(enrol(authority, 1).own, first.own);
  const std::vector others{request_of(make_node_key(VehicleId{1}))};
  const auto refused = authority.enrol(others, kNow_unix_s);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("mission revoke vehicle 1"), std::string::npos);
  ASSERT_TRUE(authority.revoke(first.own.serial));
  const std::vector lost{request(1)};
  const auto again = authority.enrol(lost, kNow_unix_s);
  ASSERT_FALSE(again) << "whoever has the lost vehicle has these keys";
  EXPECT_NE(again.error().message.find("--new-keys"), std::string::npos);
  const auto answers = authority.enrol(others, kNow_unix_s);
  ASSERT_TRUE(answers) << answers.error().message;
  EXPECT_NE(answers->front().own.serial, first.own.serial);
  EXPECT_EQ(answers->front().keys.grant.epoch, 2);
  EXPECT_FALSE(
      check(Membership{first.authority, first.own, {authority.revoked(), first.keys.grant}},
            kNow_unix_s));
}

TEST_F(AuthorityTest, AnotherGroundStationIsEnrolledAsAVehicleIs) {
  const VehicleId node = station_node(2);
  Membership second;
  {
    Authority authority = create();
    second = enrol(authority, node.value);
    EXPECT_EQ(second.own.role, Role::ground);
    EXPECT_EQ(second.own.node, node);
    EXPECT_EQ(holder_of(second.own), "ground station 2");
    enrol(authority, 1);
    EXPECT_EQ(authority.members().size(), 3U);
  }
  Authority again = reopen();
  EXPECT_EQ(again.serial_of(node), second.own.serial);
  const auto told = read_changes(ground());
  ASSERT_TRUE(told);
  EXPECT_EQ(told->size(), 2U) << "it is told of new keys, too";
  EXPECT_FALSE(again.revoke(Serial{1})) << "the mission's own";
  ASSERT_TRUE(again.revoke(second.own.serial));
  EXPECT_FALSE(again.serial_of(node));
  EXPECT_EQ(read_changes(ground())->size(), 1U);
}

TEST_F(AuthorityTest, CountsAStartBeyondAnothersOfTheSameNode) {
  Authority authority = create();
  enrol(authority, station_node(2).value);
  const KeyFolder keys = vehicle(station_node(2).value);
  EXPECT_EQ(count_start(keys, kGroundStation)->number, 1);
  EXPECT_EQ(count_start(keys, kGroundStation, 58)->number, 58);
  EXPECT_EQ(count_start(keys, kGroundStation, 7)->number, 59);
  ASSERT_TRUE(note_start(keys, 90));
  ASSERT_TRUE(note_start(keys, 60));
  const auto next = count_start(keys, kGroundStation);
  EXPECT_EQ(next->number, 91);
  EXPECT_EQ(start_number(instance_of(*next)), 91);
}

TEST_F(AuthorityTest, NobodyJoinsWhenItIsOver) {
  Authority authority = create(1);
  const std::vector requests{request(1)};
  const auto late = authority.enrol(requests, kNow_unix_s + 2 * kDay_s);
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("create a new mission"), std::string::npos);
  const auto early = authority.enrol(requests, 0);
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().message.find("set the clock"), std::string::npos);
}

TEST_F(AuthorityTest, RevokesEachOnceAndNeitherItselfNorNobody) {
  Authority authority = create();
  const Membership member = enrol(authority, 1);
  EXPECT_FALSE(authority.revoke(Serial{0}));
  EXPECT_FALSE(authority.revoke(Serial{1})) << "the ground station";
  EXPECT_FALSE(authority.revoke(Serial{99}));
  EXPECT_EQ(authority.epoch(), 1);
  EXPECT_TRUE(authority.revoke(member.own.serial));
  EXPECT_FALSE(authority.revoke(member.own.serial));
  EXPECT_EQ(authority.epoch(), 2);
}

TEST_F(AuthorityTest, HasKeysForTwoHundredAndFiftyFourRevocations) {
  Authority authority = create();
  for (int i = 0; i < 254; ++i) {
    const std::vector requests{request_of(make_node_key(VehicleId{7}))};
    ASSERT_TRUE(authority.enrol(requests, kNow_unix_s));
    ASSERT_TRUE(authority.revoke(*authority.serial_of(VehicleId{7})));
  }
  EXPECT_EQ(authority.epoch(), kEpochMax);
  const std::vector requests{request(7)};
  ASSERT_TRUE(authority.enrol(requests, kNow_unix_s));
  const auto last = authority.revoke(*authority.serial_of(VehicleId{7}));
  ASSERT_FALSE(last);
  EXPECT_NE(last.error().message.find("create a new one"), std::string::npos);
}

// The register was written, and what is made of it was not.
TEST_F(AuthorityTest, ACutAfterTheRegisterIsMadeGood) {
  std::string membership;
  std::string changes;
  {
    Authority authority = create();
    enrol(authority, 1);
    enrol(authority, 2);
    membership = text_in(ground() / "membership");
    changes = text_in(ground() / "changes");
    ASSERT_TRUE(authority.revoke(*authority.serial_of(VehicleId{1})));
  }
  const auto epoch_at_ground = [this] {
    return Identity::open({ground(), {}}, kNow_unix_s)->epoch_key().epoch;
  };
  for (const bool both : {true, false}) {
    if (both) put(ground() / "membership", membership);
    put(ground() / "changes", changes);
    EXPECT_EQ(epoch_at_ground(), both ? 1 : 2);
    static_cast<void>(reopen());
    EXPECT_EQ(epoch_at_ground(), 2);
    const auto told = read_changes(ground());
    ASSERT_TRUE(told);
    ASSERT_EQ(told->size(), 1U);
    EXPECT_EQ(told->front().change.grant.epoch, 2);
  }
}

TEST_F(AuthorityTest, SaysWhatIsWrongWithItsRegister) {
  {
    Authority authority = create();
    enrol(authority, 1);
  }
  const std::string good = text_in(ground() / "register");
  for (std::size_t at = 0; at < good.size(); at += 7) {
    std::string bad = good;
    bad[at] = bad[at] == 'Q' ? 'R' : 'Q';
    put(ground() / "register", bad);
    const auto opened = Authority::open(ground());
    ASSERT_FALSE(opened) << at;
    EXPECT_NE(opened.error().message.find("/register: "), std::string::npos);
  }
  for (std::size_t cut = 0; cut < good.size() - 1; cut += 13) {
    put(ground() / "register", good.substr(0, cut));
    // Cut between lines it would have forgotten a member: a whole file is never cut.
    if (good[cut] != '\n' && (cut == 0 || good[cut - 1] != '\n')) {
      EXPECT_FALSE(Authority::open(ground())) << cut;
    }
  }
}

TEST_F(AuthorityTest, AnOperatorHasANameOfAFileAndNoOther) {
  Authority authority = create();
  for (const char* name : {"../ada", "a:b", "", ".ada"}) {
    EXPECT_FALSE(authority.enrol_operator(name, "correct horse", kNow_unix_s)) << name;
  }
  EXPECT_TRUE(authority.enrol_operator("ada", "correct horse", kNow_unix_s));
  EXPECT_FALSE(authority.enrol_operator("ada", "correct horse", kNow_unix_s));
  EXPECT_EQ(authority.serial_of("ada"), Serial{2});
}

TEST_F(AuthorityTest, ATeamForTheBenchIsMadeAtOnce) {
  constexpr std::uint16_t kVehicles = 200;
  std::vector<VehicleId> vehicles;
  for (std::uint16_t id = 1; id <= kVehicles; ++id) vehicles.push_back(VehicleId{id});
  const auto begin = std::chrono::steady_clock::now();
  const auto made = make_team(folder_ / "team", vehicles, kNow_unix_s);
  ASSERT_TRUE(made) << made.error().message;
  RecordProperty(
      "seconds",
      std::to_string(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
  const auto station =
      Identity::open({node_folder(folder_ / "team", kGroundStation), {}}, kNow_unix_s);
  ASSERT_TRUE(station) << station.error().message;
  Verifier verifier = station->verifier();
  for (const VehicleId id : vehicles) {
    const KeyFolder keys{node_folder(folder_ / "team", id), {}};
    const auto node = Identity::open(keys, kNow_unix_s);
    ASSERT_TRUE(node) << node.error().message;
    EXPECT_EQ(node->epoch_key().secret, station->epoch_key().secret);
    EXPECT_EQ(verifier.learn(node->own(), kNow_unix_s), Trust::good);
    EXPECT_EQ(count_start(keys, id)->number, 1);
  }
  EXPECT_FALSE(make_team(folder_ / "team", vehicles, kNow_unix_s)) << "it is not free";
}

}  // namespace
}  // namespace skein::identity
