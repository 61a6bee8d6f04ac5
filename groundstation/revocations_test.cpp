// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/revocations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/team.hpp"

namespace skein::groundstation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kNow_unix_s = 1'777'000'000;

TEST(Revocations, AreToldOnceAndNamedUntilTheHolderIsBack) {
  std::string folder = testing::TempDir() + "skein-revocations-XXXXXX";
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  ASSERT_TRUE(identity::make_team(folder, std::vector{VehicleId{3}, VehicleId{4}}, kNow_unix_s));
  const auto ground = identity::node_folder(folder, kGroundStation);
  const auto revoke = [&ground](const auto& whom) {
    auto authority = identity::Authority::open(ground);
    ASSERT_TRUE(authority);
    ASSERT_TRUE(authority->revoke(*authority->serial_of(whom)));
  };
  revoke(VehicleId{3});

  Revocations revocations{ground};
  EXPECT_THAT(revocations.take_new(), IsEmpty()) << "who was out before";
  EXPECT_THAT(revocations.vehicles(), ElementsAre(VehicleId{3}));
  EXPECT_EQ(revocations.text(), "revoked: vehicle 3\n");

  revoke(VehicleId{4});
  EXPECT_THAT(revocations.vehicles(), ElementsAre(VehicleId{3})) << "not looked at yet";
  revocations.look();
  const auto fresh = revocations.take_new();
  ASSERT_EQ(fresh.size(), 1U);
  EXPECT_EQ(holder_of(fresh.front()), "vehicle 4");
  EXPECT_THAT(revocations.take_new(), IsEmpty());
  EXPECT_EQ(revocations.text(), "revoked: vehicle 3, vehicle 4\n");

  const identity::KeyFolder four{identity::node_folder(folder, VehicleId{4}), {}};
  const auto key = identity::make_new_node_key(four, VehicleId{4});
  ASSERT_TRUE(key);
  {
    auto authority = identity::Authority::open(ground);
    ASSERT_TRUE(authority);
    ASSERT_TRUE(authority->enrol(std::vector{identity::request_of(*key)}, kNow_unix_s));
  }
  revocations.look();
  EXPECT_THAT(revocations.vehicles(), ElementsAre(VehicleId{3}));
  std::filesystem::remove_all(folder);
}

TEST(Revocations, WithoutKeysThereAreNone) {
  Revocations revocations;
  revocations.look();
  EXPECT_THAT(revocations.take_new(), IsEmpty());
  EXPECT_EQ(revocations.text(), "");
}

}  // namespace
}  // namespace skein::groundstation
