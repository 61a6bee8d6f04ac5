// SPDX-License-Identifier: Apache-2.0
#include "signatures.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/team.hpp"

namespace skein::network {
namespace {

using codec::Topic;
using Judged = Signatures::Judged;
using Bytes = std::vector<std::uint8_t>;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

std::int64_t now_unix_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// A ground station and two vehicles; what each says is judged by the first vehicle.
class SignaturesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-signatures-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    const std::vector vehicles{kOne, kTwo};
    ASSERT_TRUE(identity::make_team(folder_, vehicles, now_unix_s()).ok());
    judge_ = std::make_unique<Signatures>(config(kOne), kOne, InstanceId{7});
    for (const VehicleId other : {kGroundStation, kTwo}) {
      judge_->learn(identity::to_bytes(config(other).own));
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] identity::Identity identity(VehicleId node) const {
    auto opened =
        identity::Identity::open({identity::node_folder(folder_, node), {}}, now_unix_s());
    EXPECT_TRUE(opened.ok());
    return std::move(opened).value();
  }
  [[nodiscard]] SignConfig config(VehicleId node) const {
    const auto who = identity(node);
    return {who.signer(), who.own(), who.verifier()};
  }
  [[nodiscard]] Signatures of(VehicleId node, InstanceId instance = {7}) const {
    return {config(node), node, instance};
  }
  static Bytes said(Signatures& by, Bytes body, Topic topic = Topic::command) {
    by.sign(topic, body);
    return body;
  }
  Judged judge(std::span<const std::uint8_t> bytes, VehicleId sender = kGroundStation,
               InstanceId instance = {7}, Topic topic = Topic::command) {
    const auto signature = cut_signature(bytes);
    return judge_->judge(topic, sender, instance, bytes, signature);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Signatures> judge_;
};

TEST_F(SignaturesTest, ADecisionIsGoodOnceAndInItsOrder) {
  Signatures ground = of(kGroundStation);
  const Bytes body{1, 2, 3, 4};
  const Bytes first = said(ground, body);
  const Bytes second = said(ground, body);
  const Bytes third = said(ground, body);
  ASSERT_EQ(first.size(), body.size() + kSignatureBytes);
  EXPECT_EQ(judge(first), Judged::good);
  EXPECT_EQ(judge(first), Judged::replayed);
  EXPECT_EQ(judge(third), Judged::good) << "one that was lost";
  EXPECT_EQ(judge(second), Judged::replayed);
}

TEST_F(SignaturesTest, ANewStartTakesThePlaceOfTheOld) {
  Signatures before = of(kGroundStation, {7});
  Signatures after = of(kGroundStation, {8});
  const Bytes old = said(before, {1});
  const Bytes older = said(before, {1});
  EXPECT_EQ(judge(old), Judged::good);
  EXPECT_EQ(judge(said(after, {1}), kGroundStation, {8}), Judged::good);
  EXPECT_EQ(judge(older), Judged::replayed) << "recorded, and never heard here";
  EXPECT_EQ(judge(older, kGroundStation, {9}), Judged::forged) << "as if it were of a new start";
}

TEST_F(SignaturesTest, WhatIsChangedOrMovedIsForged) {
  Signatures ground = of(kGroundStation);
  const Bytes good = said(ground, {1, 2, 3, 4});
  for (const std::size_t at : {std::size_t{0}, std::size_t{4}, std::size_t{12}, std::size_t{40}}) {
    Bytes changed = good;
    changed[at] ^= 1U;
    EXPECT_EQ(judge(changed), Judged::forged) << at;
  }
  EXPECT_EQ(judge(good, kGroundStation, {7}, Topic::route), Judged::forged) << "another topic";
  EXPECT_EQ(judge(good, kTwo), Judged::forged) << "another sender";
  EXPECT_EQ(judge(Bytes{1, 2, 3, 4}), Judged::missing);
  Bytes no_mark = good;
  no_mark.back() ^= 1U;
  EXPECT_EQ(judge(no_mark), Judged::missing);
  EXPECT_EQ(judge(good), Judged::good);
}

TEST_F(SignaturesTest, AMemberCannotSignForAnother) {
  Signatures insider{config(kTwo), kGroundStation, {7}};
  EXPECT_EQ(judge(said(insider, {1})), Judged::forged);
  Signatures itself = of(kTwo);
  EXPECT_EQ(judge(said(itself, {1}), kTwo), Judged::good);
}

TEST_F(SignaturesTest, WhoIsUnknownOrRevokedIsNotBelieved) {
  const auto other_folder = folder_ / "others";
  const std::vector vehicles{kTwo};
  ASSERT_TRUE(identity::make_team(other_folder, vehicles, now_unix_s()).ok());
  const auto stranger =
      identity::Identity::open({identity::node_folder(other_folder, kTwo), {}}, now_unix_s());
  ASSERT_TRUE(stranger.ok());
  Signatures from_elsewhere{{stranger->signer(), stranger->own(), stranger->verifier()}, kTwo, {9}};
  judge_->learn(identity::to_bytes(stranger->own()));
  EXPECT_EQ(judge(said(from_elsewhere, {1}), kTwo, {9}), Judged::forged);
  judge_->learn(Bytes{1, 2, 3});
  judge_->learn(Bytes{});

  Signatures two = of(kTwo);
  EXPECT_EQ(judge(said(two, {1}), kTwo), Judged::good);
  auto authority = identity::Authority::open(identity::node_folder(folder_, kGroundStation));
  ASSERT_TRUE(authority.ok()) << authority.error().message;
  ASSERT_TRUE(authority->revoke(identity(kTwo).own().serial).ok());
  judge_->learn(identity(kGroundStation).revoked());
  EXPECT_EQ(judge(said(two, {1}), kTwo), Judged::forged);
  Signatures ground = of(kGroundStation);
  EXPECT_EQ(judge(said(ground, {1})), Judged::good) << "the others go on";
}

}  // namespace
}  // namespace skein::network
