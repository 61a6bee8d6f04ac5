// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/membership.hpp"

#include <fmt/format.h>

#include "bytes.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr TextForm kForm{"SKEIN-MEMBER-1:", "membership", kMembershipBytesMax};

Error no_good(const char* part, const std::string& why) {
  return Error{fmt::format("the membership's {} is no good: {}", part, why)};
}

}  // namespace

Bytes to_bytes(const Membership& membership) {
  const Bytes authority = to_bytes(membership.authority);
  const Bytes own = to_bytes(membership.own);
  const Bytes keys = to_bytes(membership.keys);
  ByteWriter out;
  out.number(kVersion, 1).number(authority.size(), 1).add(Span{authority});
  out.number(own.size(), 1).add(Span{own}).add(Span{keys});
  return out.take();
}

Result<Membership> membership_from(Span bytes) {
  ByteReader in{bytes, "membership"};
  in.require(in.number(1, "version") == kVersion, "version");
  const Span authority = in.take(in.number(1, "authority"), "authority");
  const Span own = in.take(in.number(1, "certificate"), "certificate");
  const Span keys = in.take(in.left(), "keys");
  if (const auto all = in.finish(); !all) return all.error();
  const auto authoritys = certificate_from(authority);
  if (!authoritys) return authoritys.error();
  const auto certificate = certificate_from(own);
  if (!certificate) return certificate.error();
  const auto change = key_change_from(keys);
  if (!change) return change.error();
  return Membership{*authoritys, *certificate, *change};
}

std::string to_text(const Membership& membership) { return to_text(kForm, to_bytes(membership)); }

Result<Membership> membership_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kForm, text);
  if (!bytes) return bytes.error();
  return membership_from(*bytes);
}

Result<void> check(const Membership& membership, std::int64_t now_unix_s) {
  const auto& [authority, own, keys] = membership;
  if (const Trust trust = check_authority(authority, now_unix_s); trust != Trust::good) {
    return no_good("authority", why_not(authority, trust, now_unix_s));
  }
  if (const Trust trust = check(own, authority, now_unix_s); trust != Trust::good) {
    return no_good("certificate", why_not(own, trust, now_unix_s));
  }
  if (own.role != Role::ground && own.role != Role::vehicle) {
    return no_good("certificate", why_not(own, Trust::wrong_role, now_unix_s));
  }
  if (const Trust trust = check(keys.revoked, authority); trust != Trust::good) {
    return no_good("list of who was revoked", why_not(own, trust, now_unix_s));
  }
  if (const Trust trust = check(keys.grant, authority); trust != Trust::good) {
    return no_good("key", why_not(own, trust, now_unix_s));
  }
  if (keys.grant.member != own.serial) {
    return no_good("key", "it is for another member; enrol again");
  }
  if (keys.revoked.contains(own.serial)) {
    return no_good("certificate", why_not(own, Trust::revoked, now_unix_s));
  }
  return {};
}

}  // namespace skein::identity
