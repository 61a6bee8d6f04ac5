// SPDX-License-Identifier: Apache-2.0
#include "signatures.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "skein/base/stations.hpp"
#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/identity/team.hpp"
#include "skein/network/approval.hpp"

namespace skein::network {
namespace {

using codec::Topic;
using Judged = Signatures::Judged;
using Bytes = std::vector<std::uint8_t>;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};
constexpr VehicleId kStation = station_node(2);

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
    const std::vector vehicles{kOne, kTwo, kStation};
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
  /// With sequence 1 and an empty body.
  [[nodiscard]] Bytes signed_at(VehicleId node, Topic topic, std::chrono::nanoseconds time) const {
    const auto signature = config(node).signer.sign(identity::Statement{
        codec::kTopics.at(static_cast<std::size_t>(topic)).name, node, {7}, 1, Instant{time}, {}});
    Bytes trailer{1, 0, 0, 0, 0, 0, 0, 0};
    trailer.reserve(kSignatureBytes);
    for (unsigned i = 0; i < 8; ++i) {
      trailer.push_back(static_cast<std::uint8_t>(time.count() >> (8 * i)));
    }
    for (const std::uint8_t byte : signature) trailer.push_back(byte);
    for (const char c : {'S', 'k', 'S', '\1'}) trailer.push_back(static_cast<std::uint8_t>(c));
    return trailer;
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

TEST_F(SignaturesTest, WhoseCertificatesAreOfAnotherMissionKeepsNobodysOut) {
  Signatures judge{config(kOne), kOne, InstanceId{7}};
  for (int i = 0; i < 6; ++i) {
    const auto other = folder_ / ("other-" + std::to_string(i));
    ASSERT_TRUE(identity::make_team(other, std::vector{kTwo}, now_unix_s()).ok());
    auto stranger =
        identity::Identity::open({identity::node_folder(other, kTwo), {}}, now_unix_s());
    ASSERT_TRUE(stranger.ok());
    judge.learn(identity::to_bytes(stranger.value().own()));
  }
  judge.learn(identity::to_bytes(config(kTwo).own));
  Signatures two = of(kTwo);
  const Bytes bytes = said(two, {1, 2});
  std::span<const std::uint8_t> body{bytes};
  const auto signature = cut_signature(body);
  EXPECT_EQ(judge.judge(Topic::command, kTwo, {7}, body, signature), Judged::good);
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

// The judge was started after it was said, and has heard nothing of its order.
TEST_F(SignaturesTest, WhatWasSignedLongBeforeTheStartIsReplayed) {
  const auto at = [&](Topic topic, std::chrono::seconds ago) {
    const auto time = std::chrono::system_clock::now().time_since_epoch() - ago;
    return signed_at(kGroundStation, topic, std::chrono::nanoseconds{time});
  };
  EXPECT_EQ(judge(at(Topic::command, std::chrono::minutes{5})), Judged::replayed);
  EXPECT_EQ(judge(at(Topic::command, std::chrono::seconds{10})), Judged::good);
  EXPECT_EQ(judge(at(Topic::setup, std::chrono::minutes{5}), kGroundStation, {7}, Topic::setup),
            Judged::good)
      << "a clock that is behind is told by it";
}

// Who has a lost vehicle's keys uses up the numbers; with new keys it is heard again.
TEST_F(SignaturesTest, NewKeysBeginTheOrderAnew) {
  Signatures captor = of(kTwo, {~0ULL});
  EXPECT_EQ(judge(said(captor, {1}), kTwo, {~0ULL}), Judged::good);
  Signatures itself = of(kTwo);
  EXPECT_EQ(judge(said(itself, {1}), kTwo), Judged::replayed);

  auto authority = identity::Authority::open(identity::node_folder(folder_, kGroundStation));
  ASSERT_TRUE(authority.ok()) << authority.error().message;
  ASSERT_TRUE(authority->revoke(identity(kTwo).own().serial).ok());
  const auto key = identity::make_node_key(kTwo);
  const std::vector requests{identity::request_of(key)};
  const auto answers = authority->enrol(requests, now_unix_s());
  ASSERT_TRUE(answers.ok()) << answers.error().message;
  const auto& own = answers->front().own;
  judge_->learn(identity::to_bytes(own));
  Signatures anew{{identity::Signer{own.mission, key.sign}, own, config(kOne).verifier}, kTwo, {8}};
  EXPECT_EQ(judge(said(anew, {1}), kTwo, {8}), Judged::good);
}

// The ground station's signature is not the operator's.
TEST_F(SignaturesTest, AGrantNeedsAnOperatorsApproval) {
  const auto ground_folder = identity::node_folder(folder_, kGroundStation);
  std::string password;
  std::getline(std::ifstream{ground_folder / identity::kBenchPasswordFile} >> std::ws, password);
  const auto locked = identity::read_operator_key(ground_folder, identity::kBenchOperator);
  ASSERT_TRUE(locked.ok()) << locked.error().message;
  const auto op = identity::unlock(*locked, password);
  ASSERT_TRUE(op.ok()) << op.error().message;

  mission::Authorisation grant{{}, SiteId{4}, true, "ada", at_seconds(10.0), {}, {}, {}};
  const auto judged = [&] { return judge_->judge_approval(mission::Message{grant}); };
  EXPECT_FALSE(approve(grant, *op, locked->certificate)) << "of nothing";
  EXPECT_EQ(judged(), Judged::missing);
  grant.deliveries.push_back({{{SiteId{4}, TaskKind::deliver, 0}, kTwo, at_seconds(60.0)}, 0.5});
  grant.until = at_seconds(60.0);
  EXPECT_EQ(judged(), Judged::missing);
  ASSERT_TRUE(approve(grant, *op, locked->certificate));
  EXPECT_EQ(judged(), Judged::good);
  grant.round.number = 7;  // the same deliveries under a successor
  EXPECT_EQ(judged(), Judged::good);

  const auto good = grant;
  const auto changed = [&](const std::function<void(mission::Authorisation&)>& change) {
    grant = good;
    change(grant);
    return judged();
  };
  using A = mission::Authorisation;
  EXPECT_EQ(changed([](A& g) { g.site = SiteId{5}; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.until += std::chrono::hours{1}; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.deliveries[0].assignment.vehicle = kOne; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.deliveries[0].bearing_rad += 1e-9; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.decided_by = "eve"; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.approval.back() ^= 1U; }), Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.approval.pop_back(); }), Judged::missing);
  EXPECT_EQ(changed([&](A& g) {
              (void)approve(g, config(kGroundStation).signer, config(kGroundStation).own);
            }),
            Judged::missing)
      << "a ground station is no operator";
  EXPECT_EQ(changed([&](A& g) { (void)approve(g, config(kTwo).signer, locked->certificate); }),
            Judged::forged);
  EXPECT_EQ(changed([](A& g) { g.granted = false; }), Judged::good) << "a refusal needs none";

  auto authority = identity::Authority::open(ground_folder);
  ASSERT_TRUE(authority.ok());
  ASSERT_TRUE(authority->revoke(locked->certificate.serial).ok());
  judge_->learn(authority->revoked());
  grant = good;
  EXPECT_EQ(judged(), Judged::forged) << "that operator is out";
}

TEST_F(SignaturesTest, EachOfSeveralGroundStationsSpeaksAsTheOne) {
  Signatures first = of(kGroundStation, {7});
  Signatures second{config(kStation), kGroundStation, {8}};
  const Bytes early = said(second, {1});
  EXPECT_EQ(judge(early, kGroundStation, {8}), Judged::forged) << "it is not known yet";
  judge_->learn(identity::to_bytes(config(kStation).own));
  EXPECT_EQ(judge(said(first, {1})), Judged::good);
  EXPECT_EQ(judge(said(second, {1}), kGroundStation, {8}), Judged::good);
  EXPECT_EQ(judge(said(first, {1})), Judged::replayed) << "the newer start has the command";
  Signatures again = of(kGroundStation, {9});
  EXPECT_EQ(judge(said(again, {1}), kGroundStation, {9}), Judged::good) << "taken back";
  Signatures insider{config(kTwo), kGroundStation, {10}};
  EXPECT_EQ(judge(said(insider, {1}), kGroundStation, {10}), Judged::forged);
}

TEST_F(SignaturesTest, AGroundStationThatIsOutHasUsedUpNobodysNumbers) {
  judge_->learn(identity::to_bytes(config(kStation).own));
  Signatures captor{config(kStation), kGroundStation, {~0ULL}};
  EXPECT_EQ(judge(said(captor, {1}), kGroundStation, {~0ULL}), Judged::good);
  Signatures first = of(kGroundStation, {7});
  EXPECT_EQ(judge(said(first, {1})), Judged::replayed);
  auto authority = identity::Authority::open(identity::node_folder(folder_, kGroundStation));
  ASSERT_TRUE(authority.ok()) << authority.error().message;
  ASSERT_TRUE(authority->revoke(*authority->serial_of(kStation)).ok());
  judge_->learn(identity(kGroundStation).revoked());
  EXPECT_EQ(judge(said(captor, {1}), kGroundStation, {~0ULL}), Judged::forged);
  EXPECT_EQ(judge(said(first, {1})), Judged::good);
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
