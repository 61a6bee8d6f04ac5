// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/certificate.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "bytes.hpp"
#include "crypto.hpp"
#include "skein/base/stations.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::int64_t kLastUnixS = 253'402'300'799;  ///< of the year 9999
constexpr std::string_view kPurpose = "skein certificate 1";
constexpr TextForm kForm{"SKEIN-CERT-1:", "certificate", kCertificateBytesMax};

bool is_node(Role role) { return role == Role::ground || role == Role::vehicle; }
bool is_named(Role role) { return role == Role::authority || role == Role::op; }

/// All but the signature.
ByteWriter unsigned_part(const Certificate& c) {
  ByteWriter out;
  out.number(kVersion, 1).add(c.mission.bytes).number(c.serial.value, 4);
  out.number(static_cast<std::uint8_t>(c.role), 1).number(c.node.value, 2);
  out.number(c.name.size(), 1).add(c.name).add(c.sign_key);
  if (is_node(c.role)) out.add(c.agree_key);
  out.number(static_cast<std::uint64_t>(c.not_before_unix_s), 8);
  out.number(static_cast<std::uint64_t>(c.not_after_unix_s), 8);
  return out;
}

Bytes what_is_signed(const Certificate& certificate) {
  const Bytes part = unsigned_part(certificate).take();
  return ByteWriter{}.add(kPurpose).add(Span{part}).take();
}

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

const char* to_text(Role role) {
  switch (role) {
    case Role::authority:
      return "authority";
    case Role::ground:
      return "ground";
    case Role::vehicle:
      return "vehicle";
    case Role::op:
      return "operator";
  }
  return "";
}

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kNameMax && is_letter_or_digit(name.front()) &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return is_letter_or_digit(c) || c == '.' || c == '_' || c == '-';
         });
}

Bytes to_bytes(const Certificate& certificate) {
  return unsigned_part(certificate).add(certificate.signature).take();
}

Result<Certificate> certificate_from(Span bytes) {
  ByteReader in{bytes, "certificate"};
  Certificate c;
  in.require(in.number(1, "version") == kVersion, "version");
  c.mission.bytes = in.array<16>("mission");
  c.serial.value = static_cast<std::uint32_t>(in.number(4, "serial"));
  const std::uint64_t role = in.number(1, "role");
  const bool is_role = role >= 1 && role <= static_cast<std::uint64_t>(Role::op);
  in.require(is_role, "role");
  if (is_role) c.role = static_cast<Role>(role);
  c.node.value = static_cast<std::uint16_t>(in.number(2, "node"));
  c.name = in.text(in.number(1, "name"), "name");
  c.sign_key = in.array<kKeyBytes>("sign_key");
  if (is_node(c.role)) c.agree_key = in.array<kKeyBytes>("agree_key");
  const std::uint64_t before = in.number(8, "not_before");
  const std::uint64_t after = in.number(8, "not_after");
  c.signature = in.array<64>("signature");

  in.require((c.role == Role::authority) == (c.serial.value == 0), "serial");
  const bool is_right = c.role == Role::vehicle  ? c.node != kGroundStation && !is_station(c.node)
                        : c.role == Role::ground ? c.node == kGroundStation || is_station(c.node)
                                                 : c.node == kGroundStation;
  in.require(is_right, "node");
  in.require(is_named(c.role) ? is_name(c.name) : c.name.empty(), "name");
  in.require(before < after, "not_before");
  in.require(after <= static_cast<std::uint64_t>(kLastUnixS), "not_after");
  c.not_before_unix_s = static_cast<std::int64_t>(before);
  c.not_after_unix_s = static_cast<std::int64_t>(after);
  return in.finish(std::move(c));
}

std::string to_text(const Certificate& certificate) {
  return to_text(kForm, to_bytes(certificate));
}

Result<Certificate> certificate_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kForm, text);
  if (!bytes) return bytes.error();
  return certificate_from(*bytes);
}

std::string fingerprint(const PublicKey& sign, const PublicKey& agree) {
  const auto sum = sha256(ByteWriter{}.add(sign).add(agree).take());
  std::string text = base32(Span{sum}.first(10));
  for (const std::size_t at : {12U, 8U, 4U}) text.insert(at, 1, '-');
  return text;
}

std::string fingerprint(const Certificate& c) { return fingerprint(c.sign_key, c.agree_key); }

std::string to_text(const MissionId& id) {
  std::string text;
  for (const std::uint8_t byte : id.bytes) text.append(fmt::format("{:02x}", byte));
  return text;
}

void sign(Certificate& certificate, const Secret& authority_key) {
  certificate.signature = ed25519_sign(authority_key, what_is_signed(certificate));
}

const char* to_text(Trust trust) {
  switch (trust) {
    case Trust::good:
      return "good";
    case Trust::forged:
      return "forged";
    case Trust::other_mission:
      return "other_mission";
    case Trust::not_yet_valid:
      return "not_yet_valid";
    case Trust::expired:
      return "expired";
    case Trust::wrong_role:
      return "wrong_role";
    case Trust::revoked:
      return "revoked";
    case Trust::unknown:
      return "unknown";
    case Trust::count:
      break;
  }
  return "";
}

namespace {

Trust check_dates(const Certificate& c, std::int64_t now_unix_s) {
  if (now_unix_s < c.not_before_unix_s) return Trust::not_yet_valid;
  return now_unix_s > c.not_after_unix_s ? Trust::expired : Trust::good;
}

}  // namespace

Trust check_authority(const Certificate& authority, std::int64_t now_unix_s) {
  if (authority.role != Role::authority) return Trust::wrong_role;
  if (!ed25519_verify(authority.sign_key, what_is_signed(authority), authority.signature)) {
    return Trust::forged;
  }
  return check_dates(authority, now_unix_s);
}

Trust check(const Certificate& certificate, const Certificate& authority, std::int64_t now_unix_s) {
  if (certificate.mission != authority.mission) return Trust::other_mission;
  if (certificate.role == Role::authority) return Trust::wrong_role;
  if (!ed25519_verify(authority.sign_key, what_is_signed(certificate), certificate.signature)) {
    return Trust::forged;
  }
  return check_dates(certificate, now_unix_s);
}

std::string holder_of(const Certificate& certificate) {
  switch (certificate.role) {
    case Role::vehicle:
      return fmt::format("vehicle {}", certificate.node.value);
    case Role::op:
      return fmt::format("operator {}", certificate.name);
    case Role::ground:
      if (!is_station(certificate.node)) return "ground station";
      return fmt::format("ground station {}", station_number(certificate.node));
    case Role::authority:
      break;
  }
  return "authority";
}

std::string why_not(const Certificate& certificate, Trust trust, std::int64_t now_unix_s) {
  switch (trust) {
    case Trust::forged:
      return "the mission's authority did not sign it; enrol with the authority of this mission";
    case Trust::other_mission:
      return "it is of another mission; enrol in this one";
    case Trust::not_yet_valid:
      return fmt::format("it is valid from {} on, and this clock says {}; set the clock",
                         utc_text(certificate.not_before_unix_s), utc_text(now_unix_s));
    case Trust::expired:
      return fmt::format(
          "it was valid until {}, and this clock says {}; create a new mission and enrol in it, or "
          "set the clock",
          utc_text(certificate.not_after_unix_s), utc_text(now_unix_s));
    case Trust::wrong_role:
      return fmt::format("its role is {}, which may not do this", to_text(certificate.role));
    case Trust::revoked:
      return certificate.role == Role::op
                 ? "it was revoked; 'skein-ground mission operator NAME' makes another"
                 : "it was revoked; make new keys (skein-onboard enrol --new-keys) and enrol anew";
    case Trust::good:
    case Trust::unknown:
    case Trust::count:
      break;
  }
  return to_text(trust);
}

std::string utc_text(std::int64_t unix_s) {
  constexpr std::int64_t kYear9999_s = 253'402'300'799;
  unix_s = std::clamp<std::int64_t>(unix_s, 0, kYear9999_s);
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(static_cast<std::time_t>(unix_s)));
}

}  // namespace skein::identity
