// SPDX-License-Identifier: Apache-2.0
//
// What is handed over: its forms, and that nothing is taken for what it is not.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "crypto.hpp"
#include "skein/base/random.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/membership.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/identity/request.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::int64_t kFrom = 1'700'000'000;
constexpr std::int64_t kUntil = 1'800'000'000;

Secret secret(std::uint8_t fill) {
  Secret made;
  made.bytes.fill(fill);
  return made;
}

MissionId mission() {
  MissionId id;
  for (std::uint8_t i = 0; i < 16; ++i) id.bytes.at(i) = i;
  return id;
}

const Secret kAuthority = secret(1);
const NodeKey kNode{VehicleId{300}, secret(2), secret(3)};

Certificate make_authority() {
  Certificate c;
  c.mission = mission();
  c.role = Role::authority;
  c.name = "ridge";
  c.sign_key = ed25519_public(kAuthority);
  c.not_before_unix_s = kFrom;
  c.not_after_unix_s = kUntil;
  sign(c, kAuthority);
  return c;
}

const Certificate& authority() {
  static const Certificate made = make_authority();
  return made;
}

Certificate certificate() {
  Certificate c;
  c.mission = mission();
  c.serial.value = 7;
  c.role = Role::vehicle;
  c.node = kNode.node;
  c.sign_key = kNode.sign_key();
  c.agree_key = kNode.agree_key();
  c.not_before_unix_s = kFrom;
  c.not_after_unix_s = kUntil;
  sign(c, kAuthority);
  return c;
}

Certificate operators() {
  Certificate c = certificate();
  c.role = Role::op;
  c.node = {};
  c.name = "ada-2.b_c";
  c.agree_key = {};
  sign(c, kAuthority);
  return c;
}

KeyChange change() {
  KeyChange made;
  made.revoked = {.mission = mission(), .epoch = 3, .serials = {{2}, {5}}, .signature = {}};
  sign(made.revoked, kAuthority);
  seal::EpochKey key{.epoch = 3};
  key.secret.fill(5);
  made.grant = make_grant(key, certificate(), kAuthority);
  return made;
}

Membership membership() { return {authority(), certificate(), change()}; }

// Made by another implementation, Python's cryptography 48: Ed25519PrivateKey of 32 bytes 1 (the
// authority) and 2 (the vehicle 300), X25519PrivateKey of 32 bytes 3 (the vehicle) and 4 (once),
// the mission 00 01 ... 0f, serial 7, valid from 1700000000 to 1800000000; text is
// base64.b32encode(bytes + sha256(prefix + bytes).digest()[:4]).
TEST(Forms, TheCertificateIsFixed) {
  const std::string text =
      "SKEIN-CERT-1:"
      "AEAACAQDAQCQMBYIBEFAWDANBYHQAAAAA4BQCLAAQE4XODVIPULV6VVDKRTMGTD6ZTFY3CURWTXDPIS5"
      "6YHVXD6JWOKF37W5HNV5I73PUKHOCXMWTVN3B2STO5GURC627HPRY3QBESZ66IQAAAAAAZKT6EAAAAAAABVUTUQAMPK6"
      "RW"
      "QYPNCB35ZEWDQJRG5PXNJL2TYZDERXEW3QMF6PIZ32PPKAPB6Z2NRUYE4RSDFE5S5XSVURX6KG4QXIO4LOZKAMW77IJY"
      "WE"
      "CBY3K3PD4";
  EXPECT_EQ(to_text(certificate()), text);
  const auto read = certificate_from_text(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, certificate());
  EXPECT_EQ(fingerprint(*read), "BGMX-NMTF-R33M-3LHP");
}

TEST(Forms, TheRequestIsFixed) {
  EXPECT_EQ(
      to_text(request_of(kNode)),
      "SKEIN-REQUEST-1:AEASZAJZO4HKQ7IXL5LKGVDGYNGH5TGLRWFJDNHOG6RF35QPLOH4TM4ULX7N2O3L2R7W7IUO4"
      "FOZNHK3WDVFG52NJCF5V6O7DRXACJFT54RO2YDEZE4IZPGWOCPMPXUWNCQKYBJDGNIGWVB42SUZ67J3YEGUOTZU6GI"
      "55RGLJMZFRK5QLOE6PREX5SW74LHR5E6Z3CJ4IJR7T43PACB6QKFG");
}

// HKDF(SHA256, 32, salt = both public keys, info = "skein epoch key 1" and the head), AESGCM with
// the nonce 0 and the head.
TEST(Forms, AKeyThatAnotherWrappedIsOpened) {
  const auto read = key_change_from_text(
      "SKEIN-CHANGE-1:"
      "UIAQAAICAMCAKBQHBAEQUCYMBUHA6AYCAAAAAAQAAAAAKOVWSPFSN4DE4OPI3FDMTHJPV7JAEB6QQAA"
      "CZEXMNGAZ4BT75ZWN2MBRPQXE4GWOMCZ363BMENXHN2GSPPMOBRAQOH3HURB4ZZIQQEGQCAABAIBQIBIGA4EASCQLBQG"
      "Q4"
      "DYDAAAAAB5MAGZCBHUGGVH3QUZDPNO6B5H2WE6H7S7UGOTBYAMTNFQX73HRBO34V6WTKI74ON4MU2SONN3YCTBGP64I2"
      "VG"
      "5J63DMCZUS7XJCSOWH7H4NPAJ6U2LGWEG6HZ63CWQU6UBOR5NYGNIXQ6NSKWOA5TKPDDD2S2WPLPPJVWR6RK3NCENHWL"
      "NE"
      "VWMYPBRPE7KMPBG3F7OMBJOOGAAOV4W6USUKFE3ELNHTHNZVC2QK4FJZJVQ");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->revoked.serials, (std::vector<Serial>{{2}, {5}}));
  EXPECT_EQ(check(read->revoked, authority()), Trust::good);
  EXPECT_EQ(check(read->grant, authority()), Trust::good);
  const auto key = open_grant(read->grant, kNode.agree);
  ASSERT_TRUE(key);
  EXPECT_EQ(key->epoch, 3);
  EXPECT_EQ(key->secret, secret(5).bytes);
  EXPECT_FALSE(open_grant(read->grant, secret(9)));
}

TEST(Forms, AllAreReadAsTheyWereWritten) {
  for (const Certificate& c : {authority(), certificate(), operators()}) {
    EXPECT_EQ(*certificate_from(to_bytes(c)), c);
    EXPECT_EQ(*certificate_from_text(to_text(c)), c);
    EXPECT_LE(to_bytes(c).size(), kCertificateBytesMax);
  }
  EXPECT_EQ(*request_from_text("  " + to_text(request_of(kNode)) + "\r\n"), request_of(kNode));
  const KeyChange changed = change();
  EXPECT_EQ(*revocation_list_from_text(to_text(changed.revoked)), changed.revoked);
  EXPECT_EQ(*grant_from(to_bytes(changed.grant)), changed.grant);
  EXPECT_EQ(to_bytes(changed.grant).size(), kGrantBytes);
  EXPECT_EQ(*key_change_from_text(to_text(changed)), changed);
  const Membership member = membership();
  EXPECT_EQ(*membership_from_text(to_text(member)), member);
  const LockedKey locked = lock(kNode.sign, operators(), "password");
  EXPECT_EQ(*locked_key_from_text(to_text(locked)), locked);
}

TEST(Forms, TheGreatestFitTheirBounds) {
  KeyChange full = change();
  full.revoked.epoch = full.grant.epoch = kEpochMax;
  full.revoked.serials.clear();
  for (std::uint32_t i = 1; i <= kRevokedMax; ++i) full.revoked.serials.push_back({i * 16});
  EXPECT_EQ(to_bytes(full).size(), kChangeBytesMax);
  EXPECT_LT(kChangeBytesMax, 1400U) << "one datagram";
  EXPECT_EQ(*key_change_from_text(to_text(full)), full);
  const Membership member{authority(), certificate(), full};
  EXPECT_EQ(*membership_from_text(to_text(member)), member);
  EXPECT_LT(to_text(member).size(), 4296U) << "letters and digits in one QR code";
}

TEST(Forms, Base32IsAsRfc4648Has) {
  const auto of = [](std::string_view text) { return base32(Bytes{text.begin(), text.end()}); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "MY");
  EXPECT_EQ(of("fo"), "MZXQ");
  EXPECT_EQ(of("foo"), "MZXW6");
  EXPECT_EQ(of("foob"), "MZXW6YQ");
  EXPECT_EQ(of("fooba"), "MZXW6YTB");
  EXPECT_EQ(of("foobar"), "MZXW6YTBOI");
}

/// A form, and whether what was read of it is believed.
struct Form {
  const char* name;
  Bytes bytes;
  std::string text;
  std::function<bool(Span)> believed;
  std::function<bool(std::string_view)> text_believed;
};

template <class T, class Read, class ReadText, class Check>
Form form(const char* name, const T& value, Read read, ReadText read_text, Check believed) {
  return {name, to_bytes(value), to_text(value),
          [=](Span bytes) {
            const auto again = read(bytes);
            if (!again) return false;
            const Bytes written = to_bytes(*again);
            EXPECT_TRUE(std::equal(written.begin(), written.end(), bytes.begin(), bytes.end()))
                << name << ": two forms of one";
            return believed(*again);
          },
          [=](std::string_view text) {
            const auto again = read_text(text);
            return again && believed(*again);
          }};
}

std::vector<Form> forms() {
  const auto is_certificate = [](const Certificate& c) {
    return check(c, authority(), kFrom) == Trust::good;
  };
  const auto is_change = [](const KeyChange& c) {
    return check(c.revoked, authority()) == Trust::good &&
           check(c.grant, authority()) == Trust::good && open_grant(c.grant, kNode.agree);
  };
  return {
      form("certificate", certificate(), certificate_from, certificate_from_text, is_certificate),
      form("operator", operators(), certificate_from, certificate_from_text, is_certificate),
      form("request", request_of(kNode), request_from, request_from_text, is_proven),
      form("change", change(), key_change_from, key_change_from_text, is_change),
      form("membership", membership(), membership_from, membership_from_text,
           [](const Membership& m) { return check(m, kFrom).ok() && m.authority == authority(); }),
  };
}

TEST(Forms, OfWhichAByteWasChangedNoneIsBelieved) {
  for (const Form& one : forms()) {
    EXPECT_TRUE(one.believed(one.bytes)) << one.name;
    EXPECT_TRUE(one.text_believed(one.text)) << one.name;
    for (std::size_t i = 0; i < one.bytes.size(); ++i) {
      Bytes changed = one.bytes;
      changed[i] ^= static_cast<std::uint8_t>(1U << (i % 8));
      EXPECT_FALSE(one.believed(changed)) << one.name << ", byte " << i;
      changed.resize(i);
      EXPECT_FALSE(one.believed(changed)) << one.name << ", cut at " << i;
    }
    for (std::size_t i = 0; i < one.text.size(); ++i) {
      std::string changed = one.text;
      changed[i] = changed[i] == 'A' ? 'B' : 'A';
      EXPECT_FALSE(one.text_believed(changed)) << one.name << ", character " << i;
    }
    Bytes longer = one.bytes;
    longer.push_back(0);
    EXPECT_FALSE(one.believed(longer)) << one.name;
    EXPECT_FALSE(one.text_believed(one.text + "A")) << one.name;
  }
}

TEST(Forms, OfAHundredThousandHostileNoneIsBelieved) {
  constexpr int kRounds = 100'000;
  const auto all = forms();
  Random random{23};
  for (int i = 0; i < kRounds; ++i) {
    const Form& one = all[random.index(all.size())];
    const Bytes& other = all[random.index(all.size())].bytes;
    Bytes hostile = one.bytes;
    if (random.chance(0.3)) {  // head of one, tail of another
      const std::size_t cut = random.index(hostile.size());
      hostile.resize(cut);
      if (cut < other.size()) {
        hostile.insert(hostile.end(), other.begin() + static_cast<std::ptrdiff_t>(cut),
                       other.end());
      }
    }
    for (std::uint64_t n = 1 + random.index(4); n > 0 && !hostile.empty(); --n) {
      hostile[random.index(hostile.size())] = static_cast<std::uint8_t>(random.index(256));
    }
    if (hostile == one.bytes || hostile == other) continue;
    ASSERT_FALSE(one.believed(hostile)) << one.name;
    std::string text = one.text;
    for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
      text[random.index(text.size())] = static_cast<char>(random.index(256));
    }
    if (text != one.text) {
      ASSERT_FALSE(one.text_believed(text)) << one.name;
    }
  }
}

TEST(Forms, WhatIsTooLongIsNotDecoded) {
  EXPECT_FALSE(certificate_from_text("SKEIN-CERT-1:" + std::string(1U << 20U, 'A')));
  const auto wrong = certificate_from_text(to_text(request_of(kNode)));
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("SKEIN-CERT-1:"), std::string::npos);
}

TEST(Certificates, AreRefusedForWhatIsWrongWithThem) {
  const Certificate good = certificate();
  EXPECT_EQ(check_authority(authority(), kFrom), Trust::good);
  EXPECT_EQ(check(good, authority(), kFrom), Trust::good);
  EXPECT_EQ(check(good, authority(), kUntil), Trust::good);
  EXPECT_EQ(check(good, authority(), kUntil + 1), Trust::expired);
  EXPECT_EQ(check(good, authority(), kFrom - 1), Trust::not_yet_valid);
  EXPECT_EQ(check(good, authority(), 0), Trust::not_yet_valid) << "a clock that begins at 1970";
  EXPECT_EQ(check_authority(good, kFrom), Trust::wrong_role);
  EXPECT_EQ(check(authority(), authority(), kFrom), Trust::wrong_role);
  Certificate other = good;
  other.mission.bytes[3] ^= 1U;
  for (const Role role : {Role::ground, Role::vehicle, Role::op}) {
    other.role = role;
    sign(other, kAuthority);
    EXPECT_EQ(check(other, authority(), kFrom), Trust::other_mission) << to_text(role);
  }
  other = good;
  sign(other, kNode.sign);
  EXPECT_EQ(check(other, authority(), kFrom), Trust::forged);
  Certificate own = authority();
  sign(own, kNode.sign);
  EXPECT_EQ(check_authority(own, kFrom), Trust::forged);
}

// What no authority signs is no certificate, whoever signed it.
TEST(Certificates, HaveWhatTheirRoleHas) {
  const auto is_read = [](auto change_it) {
    Certificate c = certificate();
    change_it(c);
    sign(c, kAuthority);
    return certificate_from(to_bytes(c)).ok();
  };
  EXPECT_TRUE(is_read([](Certificate&) {}));
  EXPECT_FALSE(is_read([](Certificate& c) { c.node = {}; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.name = "ada"; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.serial = {}; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.role = Role::ground; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.role = static_cast<Role>(9); }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.not_after_unix_s = c.not_before_unix_s; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.not_after_unix_s = -1; }));
  EXPECT_FALSE(is_read([](Certificate& c) { c.not_before_unix_s = -1; }));
  for (const char* name :
       {"", "-a", "a b", "a/b", "\x1b[2J", "ada:", "0123456789012345678901234567890123"}) {
    EXPECT_FALSE(is_read([&](Certificate& c) {
      c = operators();
      c.name = name;
    })) << name;
  }
}

TEST(Revocations, AreInOrderAndEachOnce) {
  const auto is_read = [](std::vector<Serial> serials) {
    RevocationList list = change().revoked;
    list.serials = std::move(serials);
    sign(list, kAuthority);
    return revocation_list_from(to_bytes(list)).ok();
  };
  EXPECT_TRUE(is_read({}));
  EXPECT_TRUE(is_read({{1}, {2}}));
  EXPECT_FALSE(is_read({{2}, {1}}));
  EXPECT_FALSE(is_read({{2}, {2}}));
  EXPECT_FALSE(is_read({{0}, {2}})) << "the authority's own";
  EXPECT_FALSE(is_read(std::vector<Serial>(kRevokedMax + 1, Serial{1})));
}

TEST(Requests, AreSignedWithTheirOwnKey) {
  Request request = request_of(kNode);
  EXPECT_TRUE(is_proven(request));
  sign(request, kAuthority);
  EXPECT_FALSE(is_proven(request));
}

TEST(OperatorKeys, OpenWithTheirPasswordOnly) {
  Certificate c = operators();
  c.sign_key = kNode.sign_key();
  LockedKey locked = lock(kNode.sign, c, "correct horse");
  EXPECT_TRUE(unlock(locked, "correct horse"));
  EXPECT_FALSE(unlock(locked, "correct horsf"));
  EXPECT_FALSE(unlock(locked, ""));
  locked.certificate.name = "eve";
  EXPECT_FALSE(unlock(locked, "correct horse"));
}

}  // namespace
}  // namespace skein::identity
