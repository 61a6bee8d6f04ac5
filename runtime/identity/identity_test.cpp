// SPDX-License-Identifier: Apache-2.0
//
// A node's files: made once, read by nobody else, whole or not at all.
#include "skein/identity/identity.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <set>

#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"
#include "test_mission.hpp"

namespace skein::identity {
namespace {

class Node : public TestMission {
 protected:
  [[nodiscard]] std::filesystem::path file(const char* name) const {
    return vehicle(3).folder / name;
  }
  [[nodiscard]] std::string why_not_open(std::int64_t now_unix_s = kNow_unix_s) const {
    const auto opened = Identity::open(vehicle(3), now_unix_s);
    return opened ? "" : opened.error().message;
  }
};

TEST_F(Node, MakesItsKeysOnce) {
  const Request first = request(3);
  EXPECT_TRUE(is_proven(first));
  EXPECT_EQ(request(3), first);
  EXPECT_NE(request(4).sign_key, first.sign_key);
  const auto other = read_or_make_node_key(vehicle(3), VehicleId{4});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("keys of node 3"), std::string::npos);
}

TEST_F(Node, KeepsItsKeysToItself) {
  static_cast<void>(request(3));
  struct stat is {};
  ASSERT_EQ(::stat(file("node.key").c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777U, 0600U);
  ASSERT_EQ(::stat(vehicle(3).folder.c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777U, 0700U);
  for (const mode_t mode : {0640U, 0604U, 0660U, 0620U}) {
    ASSERT_EQ(::chmod(file("node.key").c_str(), mode), 0);
    const auto read = read_node_key(vehicle(3));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("chmod 600"), std::string::npos);
  }
  ASSERT_EQ(::chmod(file("node.key").c_str(), 0400), 0);
  EXPECT_TRUE(read_node_key(vehicle(3)));
}

TEST_F(Node, CountsOnWithNewKeys) {
  const Request first = request(3);
  ASSERT_TRUE(count_start(vehicle(3), VehicleId{3}));
  const auto other = make_new_node_key(vehicle(3), VehicleId{3});
  ASSERT_TRUE(other);
  EXPECT_NE(other->sign_key(), first.sign_key);
  EXPECT_EQ(request(3), request_of(*other));
  EXPECT_EQ(count_start(vehicle(3), VehicleId{3})->number, 2);
}

// So that a service which runs as another user can read what root made for it.
TEST_F(Node, AsRootGivesItsFilesToTheFoldersOwner) {
  if (::geteuid() != 0) GTEST_SKIP() << "not root";
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(::chown(folder_.c_str(), kNobody, kNobody), 0);
  static_cast<void>(request(3));
  for (const auto& path : {vehicle(3).folder, file("node.key"), file("starts")}) {
    struct stat is {};
    ASSERT_EQ(::stat(path.c_str(), &is), 0);
    EXPECT_EQ(is.st_uid, kNobody) << path;
    EXPECT_EQ(is.st_gid, kNobody) << path;
  }
}

TEST_F(Node, TakesItsKeysFromTheServiceManager) {
  static_cast<void>(request(3));
  KeyFolder keys = vehicle(3);
  keys.credentials = folder_ / "credentials";
  std::filesystem::create_directory(keys.credentials);
  std::filesystem::rename(file("node.key"), keys.credentials / "node.key");
  // As systemd has it where an access list lets the service's user in.
  ASSERT_EQ(::chmod((keys.credentials / "node.key").c_str(), 0440), 0);
  EXPECT_FALSE(read_node_key(vehicle(3)));
  const auto read = read_or_make_node_key(keys, VehicleId{3});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(make_new_node_key(keys, VehicleId{3}));
  EXPECT_FALSE(std::filesystem::exists(file("node.key")));
}

TEST_F(Node, IsOpenedWithTheMissionsKey) {
  Authority authority = create();
  const Membership first = enrol(authority, 3);
  enrol(authority, 4);
  const Identity three = open(3);
  EXPECT_EQ(three.own(), first.own);
  EXPECT_EQ(three.epoch_key().epoch, 1);
  EXPECT_EQ(three.epoch_key().secret, open(4).epoch_key().secret);
  const auto station = Identity::open({ground(), {}}, kNow_unix_s);
  ASSERT_TRUE(station) << station.error().message;
  EXPECT_EQ(station->own().role, Role::ground);
  EXPECT_EQ(station->epoch_key().secret, three.epoch_key().secret);
}

TEST_F(Node, SaysWhatIsMissing) {
  EXPECT_NE(why_not_open().find("skein-onboard enrol"), std::string::npos);
  static_cast<void>(request(3));
  EXPECT_NE(why_not_open().find("--membership"), std::string::npos);
  Authority authority = create();
  enrol(authority, 3);
  EXPECT_EQ(why_not_open(), "");
  EXPECT_NE(why_not_open(kNow_unix_s + 31 * kDay_s).find("new mission"), std::string::npos);
  EXPECT_NE(why_not_open(0).find("1970-01-01 00:00 UTC; set the clock"), std::string::npos);
  put(file("membership"), "SKEIN-MEMBER-1:AAAA");
  EXPECT_NE(why_not_open().find("membership: this is no membership"), std::string::npos);
}

TEST_F(Node, TakesNoAnswerThatIsNotItsOwn) {
  Authority authority = create();
  const Membership of_four = enrol(authority, 4);
  static_cast<void>(request(3));
  const auto kept = store_membership(vehicle(3), of_four, kNow_unix_s, false);
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message.find("enrol with its own request"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("membership")));

  // His certificate with the key that was wrapped for another.
  Membership mixed = enrol(authority, 3);
  mixed.keys.grant = of_four.keys.grant;
  EXPECT_FALSE(store_membership(vehicle(3), mixed, kNow_unix_s, true));
}

TEST_F(Node, LeavesAMissionOnlyWhenTold) {
  Authority authority = create();
  const Membership old = enrol(authority, 3);
  auto valley = Authority::create(folder_ / "other", "valley", 1, kNow_unix_s, Durable::no);
  ASSERT_TRUE(valley);
  const std::vector requests{request(3)};
  const auto answers = valley->enrol(requests, kNow_unix_s);
  ASSERT_TRUE(answers);
  const auto kept = store_membership(vehicle(3), answers->front(), kNow_unix_s, false);
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message.find("'ridge'"), std::string::npos);
  EXPECT_TRUE(store_membership(vehicle(3), answers->front(), kNow_unix_s, true));
  EXPECT_EQ(open(3).authority().name, "valley");
  // Out of date, it is in nobody's way.
  const std::int64_t later = kNow_unix_s + 2 * kDay_s;
  EXPECT_TRUE(store_membership(vehicle(3), old, later, false));
}

TEST_F(Node, CountsItsStarts) {
  static_cast<void>(request(3));
  EXPECT_EQ(*starts_of(vehicle(3)), 0);
  std::set<std::uint64_t> instances;
  for (std::uint16_t n = 1; n <= 20; ++n) {
    const auto start = count_start(vehicle(3), VehicleId{3});
    ASSERT_TRUE(start) << start.error().message;
    EXPECT_EQ(start->number, n);
    EXPECT_EQ(start->sender, VehicleId{3});
    EXPECT_LT(start->random, 1U << 24U);
    instances.insert(instance_of(*start).value);
  }
  EXPECT_EQ(instances.size(), 20U);
  for (const char* text : {"", "x\n", "-1\n", "65536\n", "12 13\n"}) {
    put(file("starts"), text);
    const auto start = count_start(vehicle(3), VehicleId{3});
    ASSERT_FALSE(start) << text;
    EXPECT_NE(start.error().message.find("echo 1000 >"), std::string::npos);
  }
  std::filesystem::remove(file("starts"));
  EXPECT_FALSE(count_start(vehicle(3), VehicleId{3})) << "it may have been started before";
  put(file("starts"), "65535\n");
  EXPECT_FALSE(count_start(vehicle(3), VehicleId{3}));
}

// What the count is for: with one key, no two starts seal with the same.
TEST_F(Node, AStartIsNeverTakenForAnEarlierOne) {
  Authority authority = create();
  enrol(authority, 3);
  const seal::EpochKey key = open(3).epoch_key();
  seal::Opener opener;
  opener.accept(key);
  std::vector<std::uint8_t> datagram;
  std::vector<std::uint8_t> before;
  std::vector<std::uint8_t> plain;
  for (int i = 0; i < 5; ++i) {
    seal::Sealer sealer{*count_start(vehicle(3), VehicleId{3}), key};
    ASSERT_TRUE(sealer.seal(std::vector<std::uint8_t>{1, 2, 3}, datagram));
    EXPECT_EQ(opener.open(datagram, plain, Instant{}).opened, seal::Opened::good);
    if (i > 0) {
      EXPECT_EQ(opener.open(before, plain, Instant{}).opened, seal::Opened::old_start);
    }
    before = datagram;
  }
}

/// No file of this process grows beyond that while it lives: as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit full{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(Node, AWriteThatIsCutOffLeavesWhatWas) {
  Authority authority = create();
  const Membership first = enrol(authority, 3);
  const std::string before = text_in(file("membership"));
  {
    const FullDisk full{100};
    EXPECT_FALSE(store_membership(vehicle(3), first, kNow_unix_s, true));
    EXPECT_FALSE(read_or_make_node_key(vehicle(9), VehicleId{9}));
  }
  EXPECT_EQ(text_in(file("membership")), before);
  EXPECT_EQ(why_not_open(), "");
  EXPECT_FALSE(std::filesystem::exists(vehicle(9).folder / "node.key"));
  EXPECT_TRUE(read_or_make_node_key(vehicle(9), VehicleId{9}));
  // And what such a write left beside is in nobody's way.
  put(file("membership.new"), "SKEIN-MEM");
  put(file("starts.new"), "");
  EXPECT_TRUE(store_membership(vehicle(3), first, kNow_unix_s, true));
  EXPECT_TRUE(count_start(vehicle(3), VehicleId{3}));
  EXPECT_EQ(why_not_open(), "");
}

class News : public Node {
 protected:
  News() : authority_{create()} {
    for (const std::uint16_t id : std::array<std::uint16_t, 3>{3, 4, 5}) enrol(authority_, id);
  }
  /// For that vehicle.
  [[nodiscard]] KeyChange change(std::uint16_t id) const {
    const auto changes = read_changes(ground());
    EXPECT_TRUE(changes) << changes.error().message;
    for (const auto& [node, change] : *changes) {
      if (node == VehicleId{id}) return change;
    }
    ADD_FAILURE() << "nothing for vehicle " << id;
    return {};
  }
  Authority authority_;
};

TEST_F(News, OfTheKeyReachAllButWhoWasRevoked) {
  Identity three = open(3);
  Identity four = open(4);
  Identity five = open(5);
  const auto serial_of_four = *authority_.serial_of(VehicleId{4});
  ASSERT_TRUE(authority_.revoke(serial_of_four));
  EXPECT_EQ(three.take(change(5)), Changed::not_ours);
  EXPECT_EQ(three.take(change(3)), Changed::taken);
  EXPECT_EQ(three.take(change(3)), Changed::known);
  EXPECT_EQ(three.epoch_key().epoch, 2);
  EXPECT_TRUE(three.revoked().contains(serial_of_four));
  EXPECT_EQ(four.take(change(3)), Changed::revoked);
  EXPECT_EQ(four.epoch_key().epoch, 1);
  EXPECT_EQ(five.take(change(5)), Changed::taken);
  for (const Identity* one : {&three, &five}) EXPECT_TRUE(one->store().ok());
  EXPECT_EQ(five.epoch_key().secret, three.epoch_key().secret);
  EXPECT_EQ(open(3).epoch_key().secret, three.epoch_key().secret) << "from the disk";
  EXPECT_EQ(Identity::open({ground(), {}}, kNow_unix_s)->epoch_key().secret,
            three.epoch_key().secret);
  // Two at once, for who was away.
  ASSERT_TRUE(authority_.revoke(*authority_.serial_of(VehicleId{5})));
  EXPECT_EQ(three.take(change(3)), Changed::taken);
  EXPECT_EQ(three.epoch_key().epoch, 3);
  EXPECT_EQ(three.revoked().serials.size(), 2U);
}

TEST_F(News, ThatWereChangedOrMixedAreRefused) {
  Identity three = open(3);
  const KeyChange first = change(3);
  ASSERT_TRUE(authority_.revoke(*authority_.serial_of(VehicleId{4})));
  const KeyChange good = change(3);
  const Bytes bytes = to_bytes(good);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes changed = bytes;
    changed[i] ^= 1U;
    const auto read = key_change_from(changed);
    if (read) {
      EXPECT_NE(three.take(*read), Changed::taken) << i;
    }
  }
  // The new list without the new key, and the other way round.
  EXPECT_NE(three.take({good.revoked, first.grant}), Changed::taken);
  EXPECT_NE(three.take({first.revoked, good.grant}), Changed::taken);
  EXPECT_EQ(three.take(good), Changed::taken);
  EXPECT_EQ(three.take(first), Changed::known) << "the old key does not come back";
  EXPECT_EQ(three.epoch_key().epoch, 2);
}

TEST_F(News, CountInFlightThoughTheDiskIsFull) {
  Identity three = open(3);
  ASSERT_TRUE(authority_.revoke(*authority_.serial_of(VehicleId{4})));
  const KeyChange news = change(3);
  {
    const FullDisk full{100};
    EXPECT_EQ(three.take(news), Changed::taken);
    EXPECT_FALSE(three.store().ok());
  }
  EXPECT_EQ(three.epoch_key().epoch, 2);
  EXPECT_EQ(open(3).epoch_key().epoch, 1);
}

TEST_F(News, WhoMissedThemIsEnrolledAgainWithTheSameKeys) {
  const Certificate before = open(3).own();
  ASSERT_TRUE(authority_.revoke(*authority_.serial_of(VehicleId{4})));
  enrol(authority_, 3);
  EXPECT_EQ(open(3).own(), before);
  EXPECT_EQ(open(3).epoch_key().epoch, 2);
}

}  // namespace
}  // namespace skein::identity
