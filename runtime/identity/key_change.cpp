// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/key_change.hpp"

#include <algorithm>

#include "bytes.hpp"
#include "crypto.hpp"
#include "skein/base/assert.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::string_view kListPurpose = "skein revocations 1";
constexpr std::string_view kGrantPurpose = "skein grant 1";
constexpr std::string_view kWrapPurpose = "skein epoch key 1";
constexpr TextForm kListForm{"SKEIN-REVOKED-1:", "list of who was revoked",
                             kRevocationListBytesMax};
constexpr TextForm kChangeForm{"SKEIN-CHANGE-1:", "change of the key", kChangeBytesMax};

ByteWriter unsigned_part(const RevocationList& list) {
  ByteWriter out;
  out.number(kVersion, 1).add(list.mission.bytes).number(list.epoch, 1);
  out.number(list.serials.size(), 1);
  for (const Serial serial : list.serials) out.number(serial.value, 4);
  return out;
}

/// For whom which key is.
ByteWriter head(const EpochGrant& grant) {
  ByteWriter out;
  out.number(kVersion, 1).add(grant.mission.bytes).number(grant.epoch, 1);
  out.number(grant.member.value, 4);
  return out;
}

ByteWriter unsigned_part(const EpochGrant& grant) {
  return head(grant).add(grant.once).add(grant.wrapped);
}

template <class T>
Bytes what_is_signed(std::string_view purpose, const T& said) {
  const Bytes part = unsigned_part(said).take();
  return ByteWriter{}.add(purpose).add(Span{part}).take();
}

Trust check_signature(const MissionId& mission, const Certificate& authority, const Bytes& said,
                      const Signature& signature) {
  if (mission != authority.mission) return Trust::other_mission;
  return ed25519_verify(authority.sign_key, said, signature) ? Trust::good : Trust::forged;
}

/// Both public keys are in it, so that the key is of this exchange alone.
Secret wrapping_key(const Secret& shared, const EpochGrant& grant, const PublicKey& member_key) {
  const Bytes salt = ByteWriter{}.add(grant.once).add(member_key).take();
  const Bytes whom = head(grant).take();
  return hkdf_sha256(shared, salt, ByteWriter{}.add(kWrapPurpose).add(Span{whom}).take());
}

RevocationList read_list(ByteReader& in) {
  RevocationList list;
  in.require(in.number(1, "version") == kVersion, "version");
  list.mission.bytes = in.array<16>("mission");
  list.epoch = static_cast<std::uint8_t>(in.number(1, "epoch"));
  in.require(list.epoch != 0, "epoch");
  const std::uint64_t count = in.number(1, "count");
  in.require(count <= kRevokedMax, "count");
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, kRevokedMax); ++i) {
    const Serial serial{static_cast<std::uint32_t>(in.number(4, "serial"))};
    in.require(serial > (list.serials.empty() ? Serial{} : list.serials.back()), "serial");
    list.serials.push_back(serial);
  }
  list.signature = in.array<64>("signature");
  return list;
}

EpochGrant read_grant(ByteReader& in) {
  EpochGrant grant;
  in.require(in.number(1, "version") == kVersion, "version");
  grant.mission.bytes = in.array<16>("mission");
  grant.epoch = static_cast<std::uint8_t>(in.number(1, "epoch"));
  in.require(grant.epoch != 0, "epoch");
  grant.member.value = static_cast<std::uint32_t>(in.number(4, "member"));
  in.require(grant.member.value != 0, "member");
  grant.once = in.array<kKeyBytes>("once");
  grant.wrapped = in.array<EpochGrant::kWrappedBytes>("wrapped");
  grant.signature = in.array<64>("signature");
  return grant;
}

}  // namespace

bool RevocationList::contains(Serial serial) const {
  return std::binary_search(serials.begin(), serials.end(), serial);
}

Bytes to_bytes(const RevocationList& list) {
  return unsigned_part(list).add(list.signature).take();
}

Result<RevocationList> revocation_list_from(Span bytes) {
  ByteReader in{bytes, "list of who was revoked"};
  RevocationList list = read_list(in);
  return in.finish(std::move(list));
}

Bytes to_bytes(const EpochGrant& grant) { return unsigned_part(grant).add(grant.signature).take(); }

Result<EpochGrant> grant_from(Span bytes) {
  ByteReader in{bytes, "grant of an epoch's key"};
  const EpochGrant grant = read_grant(in);
  return in.finish(grant);
}

Bytes to_bytes(const KeyChange& change) {
  const Bytes list = to_bytes(change.revoked);
  const Bytes grant = to_bytes(change.grant);
  return ByteWriter{}.number(kChangeMark, 1).add(Span{list}).add(Span{grant}).take();
}

Result<KeyChange> key_change_from(Span bytes) {
  ByteReader in{bytes, "change of the key"};
  in.require(in.number(1, "mark") == kChangeMark, "mark");
  KeyChange change;
  change.revoked = read_list(in);
  change.grant = read_grant(in);
  in.require(change.grant.mission == change.revoked.mission, "mission");
  in.require(change.grant.epoch == change.revoked.epoch, "epoch");
  return in.finish(std::move(change));
}

std::string to_text(const RevocationList& list) { return to_text(kListForm, to_bytes(list)); }

Result<RevocationList> revocation_list_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kListForm, text);
  if (!bytes) return bytes.error();
  return revocation_list_from(*bytes);
}

std::string to_text(const KeyChange& change) { return to_text(kChangeForm, to_bytes(change)); }

Result<KeyChange> key_change_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kChangeForm, text);
  if (!bytes) return bytes.error();
  return key_change_from(*bytes);
}

void sign(RevocationList& list, const Secret& authority_key) {
  list.signature = ed25519_sign(authority_key, what_is_signed(kListPurpose, list));
}

Trust check(const RevocationList& list, const Certificate& authority) {
  return check_signature(list.mission, authority, what_is_signed(kListPurpose, list),
                         list.signature);
}

EpochGrant make_grant(const seal::EpochKey& key, const Certificate& member,
                      const Secret& authority_key) {
  EpochGrant grant{.mission = member.mission, .epoch = key.epoch, .member = member.serial};
  const Secret once = random_secret();
  grant.once = x25519_public(once);
  const auto shared = x25519(once, member.agree_key);
  SKEIN_ASSERT(shared.has_value());
  Secret inside;
  inside.bytes = key.secret;
  grant.wrapped = wrap(wrapping_key(*shared, grant, member.agree_key), head(grant).take(), inside);
  grant.signature = ed25519_sign(authority_key, what_is_signed(kGrantPurpose, grant));
  return grant;
}

Trust check(const EpochGrant& grant, const Certificate& authority) {
  return check_signature(grant.mission, authority, what_is_signed(kGrantPurpose, grant),
                         grant.signature);
}

std::optional<seal::EpochKey> open_grant(const EpochGrant& grant, const Secret& agree_key) {
  const auto shared = x25519(agree_key, grant.once);
  if (!shared) return std::nullopt;
  const Secret key = wrapping_key(*shared, grant, x25519_public(agree_key));
  const auto inside = unwrap(key, head(grant).take(), grant.wrapped);
  if (!inside) return std::nullopt;
  return seal::EpochKey{.epoch = grant.epoch, .secret = inside->bytes};
}

}  // namespace skein::identity
