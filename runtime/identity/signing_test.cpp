// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/signing.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "crypto.hpp"
#include "skein/identity/operator_key.hpp"
#include "test_mission.hpp"

namespace skein::identity {
namespace {

Bytes bytes(std::string_view text) { return {text.begin(), text.end()}; }

std::string hex(Span span) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t b : span) {
    text += kDigits[b >> 4U];
    text += kDigits[b & 15U];
  }
  return text;
}

const Bytes kBody = bytes("yes");

Statement statement() {
  return {.topic = "authorise",
          .sender = VehicleId{300},
          .instance = InstanceId{0x1122334455667788},
          .sequence = 42,
          .time = Instant{Duration{5'000'000'001}},
          .body = kBody};
}

Approval approval() {
  Approval made;
  made.plan = digest(bytes("plan"));
  made.vehicles = {VehicleId{1}, VehicleId{300}};
  made.from = at_seconds(1);
  made.until = at_seconds(2);
  made.granted = true;
  return made;
}

Signer signer() {
  MissionId mission;
  for (std::uint8_t i = 0; i < 16; ++i) mission.bytes.at(i) = i;
  Secret key;
  key.bytes.fill(2);
  return {mission, key};
}

// Python's cryptography 48: Ed25519PrivateKey.from_private_bytes(b"\2" * 32).sign(b"skein statement
// 1"
// + bytes(range(16)) + b"\x09authorise" + 300, 0x1122334455667788, 42, 5000000001 and 3 big endian
// in 2, 8, 8, 8 and 4 bytes + b"yes").
TEST(Signing, AStatementsSignatureIsFixed) {
  EXPECT_EQ(
      hex(signer().sign(statement())),
      "dadd906994ab5694c824f563cf7b697057279c56170810b39d0a9be10f5db45c549a0b96d78b521ca583b242ac"
      "ff1eebb88bd360e15ad0c6d6345bba04959f04");
}

// The same of b"skein approval 1" + bytes(range(16)) + sha256(b"plan").digest() + b"\1" + 10**9,
// 2 * 10**9, 2, 1 and 300 big endian in 8, 8, 2, 2 and 2 bytes.
TEST(Signing, AnApprovalsSignatureIsFixed) {
  EXPECT_EQ(
      hex(signer().sign(approval())),
      "f00a25020c0203bf685e18a7aef891723622591729e3b679cf999476143718d955989ff2ebf2396a1f15a28bdc"
      "3084372863b79c7e2dcd19c68afccb5e123d0e");
}

class Signed : public TestMission {
 protected:
  Signed()
      : authority_{create()}, own_{enrol(authority_, 300)}, verifier_{authority_.certificate()} {
    EXPECT_EQ(verifier_.learn(own_.own, kNow_unix_s), Trust::good);
  }
  Authority authority_;
  Membership own_;
  Verifier verifier_;
};

TEST_F(Signed, AStatementIsItsSendersAsItIs) {
  const Signature signature = open(300).signer().sign(statement());
  EXPECT_EQ(verifier_.verify(statement(), signature), Trust::good);
  const Bytes other = bytes("yet");
  const std::vector<std::function<void(Statement&)>> changes{
      [](Statement& s) { s.topic = "authorisf"; }, [](Statement& s) { ++s.instance.value; },
      [](Statement& s) { ++s.sequence; },          [](Statement& s) { s.time += Duration{1}; },
      [&](Statement& s) { s.body = other; },       [](Statement& s) { s.body = s.body.first(2); },
  };
  for (const auto& change : changes) {
    Statement changed = statement();
    change(changed);
    EXPECT_EQ(verifier_.verify(changed, signature), Trust::forged);
  }
  for (std::size_t i = 0; i < signature.size(); ++i) {
    Signature changed = signature;
    changed.at(i) ^= 1U;
    EXPECT_EQ(verifier_.verify(statement(), changed), Trust::forged) << i;
  }
}

TEST_F(Signed, NobodySpeaksInAnothersName) {
  enrol(authority_, 4);
  EXPECT_EQ(verifier_.learn(open(4).own(), kNow_unix_s), Trust::good);
  EXPECT_EQ(verifier_.verify(statement(), open(4).signer().sign(statement())), Trust::forged);
  Statement unknown = statement();
  unknown.sender = VehicleId{5};
  EXPECT_EQ(verifier_.verify(unknown, open(4).signer().sign(unknown)), Trust::unknown);
}

TEST_F(Signed, WhoWasRevokedIsNoLongerBelieved) {
  const Signature signature = open(300).signer().sign(statement());
  ASSERT_TRUE(authority_.revoke(own_.own.serial));
  EXPECT_EQ(verifier_.learn(authority_.revoked()), Trust::good);
  EXPECT_EQ(verifier_.verify(statement(), signature), Trust::revoked);
  EXPECT_EQ(verifier_.learn(own_.own, kNow_unix_s), Trust::revoked);
  EXPECT_EQ(verifier_.learn(own_.keys.revoked), Trust::good) << "an old list takes nothing back";
  EXPECT_EQ(verifier_.verify(statement(), signature), Trust::revoked);
  RevocationList forged = authority_.revoked();
  forged.epoch = 200;
  forged.serials.clear();
  EXPECT_EQ(verifier_.learn(forged), Trust::forged);
}

TEST_F(Signed, ACertificateCountsFromWhenItWasLearnt) {
  Verifier late{authority_.certificate()};
  EXPECT_EQ(late.learn(own_.own, kNow_unix_s + 31 * kDay_s), Trust::expired);
  EXPECT_FALSE(late.knows(VehicleId{300}));
  EXPECT_EQ(verifier_.learn(own_.own, kNow_unix_s + 31 * kDay_s), Trust::good) << "known before";
}

TEST_F(Signed, AnOperatorDecidesWithHisPassword) {
  const auto made = authority_.enrol_operator("ada", "correct horse", kNow_unix_s);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(verifier_.learn(*made, kNow_unix_s), Trust::good);
  const auto locked = read_operator_key(ground(), "ada");
  ASSERT_TRUE(locked) << locked.error().message;
  const auto unlocked = unlock(*locked, "correct horse");
  ASSERT_TRUE(unlocked);
  const Signature signature = unlocked->sign(approval());
  EXPECT_EQ(verifier_.verify("ada", approval(), signature), Trust::good);
  EXPECT_EQ(verifier_.verify("eve", approval(), signature), Trust::unknown);
  EXPECT_EQ(verifier_.verify("ada", approval(), open(300).signer().sign(approval())),
            Trust::forged);
  const std::vector<std::function<void(Approval&)>> changes{
      [](Approval& a) { a.plan[0] ^= 1U; },
      [](Approval& a) { a.vehicles.pop_back(); },
      [](Approval& a) { a.vehicles[0] = VehicleId{2}; },
      [](Approval& a) { a.from -= Duration{1}; },
      [](Approval& a) { a.until += Duration{1}; },
      [](Approval& a) { a.granted = false; },
  };
  for (const auto& change : changes) {
    Approval changed = approval();
    change(changed);
    EXPECT_EQ(verifier_.verify("ada", changed, signature), Trust::forged);
  }
  ASSERT_TRUE(authority_.revoke(made->serial));
  EXPECT_EQ(verifier_.learn(authority_.revoked()), Trust::good);
  EXPECT_EQ(verifier_.verify("ada", approval(), signature), Trust::revoked);
}

}  // namespace
}  // namespace skein::identity
