// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/signing.hpp"

#include "bytes.hpp"
#include "crypto.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/stations.hpp"

namespace skein::identity {
namespace {

constexpr std::string_view kStatementPurpose = "skein statement 1";
constexpr std::string_view kApprovalPurpose = "skein approval 1";
constexpr std::size_t kTopicMax = 255;

std::uint64_t ns(Instant t) { return static_cast<std::uint64_t>(t.time_since_epoch().count()); }

/// A certificate takes the place of an older one of the same holder.
template <class Holders, class Holder>
void keep_newest(Holders& holders, const Holder& holder, const Certificate& certificate) {
  const auto [known, is_new] = holders.try_emplace(holder, certificate);
  if (!is_new && known->second.serial < certificate.serial) known->second = certificate;
}

}  // namespace

std::array<std::uint8_t, 32> digest(Span bytes) { return sha256(bytes); }

Bytes signed_bytes(const MissionId& mission, const Statement& statement) {
  SKEIN_ASSERT(statement.topic.size() <= kTopicMax);
  ByteWriter out;
  out.add(kStatementPurpose).add(mission.bytes);
  out.number(statement.topic.size(), 1).add(statement.topic);
  out.number(statement.sender.value, 2).number(statement.instance.value, 8);
  out.number(statement.sequence, 8).number(ns(statement.time), 8);
  out.number(statement.body.size(), 4).add(statement.body);
  return out.take();
}

Bytes signed_bytes(const MissionId& mission, const Approval& approval) {
  SKEIN_ASSERT(approval.vehicles.size() <= Approval::kVehiclesMax);
  ByteWriter out;
  out.add(kApprovalPurpose).add(mission.bytes).add(approval.plan);
  out.number(approval.granted ? 1 : 0, 1)
      .number(ns(approval.from), 8)
      .number(ns(approval.until), 8);
  out.number(approval.vehicles.size(), 2);
  for (const VehicleId vehicle : approval.vehicles) out.number(vehicle.value, 2);
  return out.take();
}

Signature Signer::sign(const Statement& statement) const {
  return ed25519_sign(key_, signed_bytes(mission_, statement));
}

Signature Signer::sign(const Approval& approval) const {
  return ed25519_sign(key_, signed_bytes(mission_, approval));
}

Trust Verifier::learn(const Certificate& certificate, std::int64_t now_unix_s) {
  const bool is_op = certificate.role == Role::op;
  if (certificate.mission == authority_.mission && revoked_.contains(certificate.serial)) {
    return Trust::revoked;
  }
  const auto node = nodes_.find(certificate.node);
  if (!is_op && node != nodes_.end() && node->second == certificate) return Trust::good;
  const auto op = operators_.find(certificate.name);
  if (is_op && op != operators_.end() && op->second == certificate &&
      now_unix_s <= certificate.not_after_unix_s) {
    return Trust::good;
  }
  if (const Trust trust = check(certificate, authority_, now_unix_s); trust != Trust::good) {
    return trust;
  }
  // The authority signs no more than there is room for.
  if (certificate.serial.value > kMembersMax) return Trust::forged;
  if (is_op) {
    keep_newest(operators_, certificate.name, certificate);
  } else {
    keep_newest(nodes_, certificate.node, certificate);
  }
  return Trust::good;
}

Trust Verifier::learn(const RevocationList& list) {
  if (list.mission == authority_.mission && list.epoch < revoked_.epoch) return Trust::good;
  const Trust trust = check(list, authority_);
  if (trust == Trust::good) revoked_ = list;
  return trust;
}

bool Verifier::knows_stations() const {
  const auto first = nodes_.lower_bound(kFirstStation);
  return first != nodes_.end() && is_station(first->first);
}

Trust Verifier::verify(const Statement& statement, const Signature& signature) const {
  if (statement.sender == kGroundStation && knows_stations()) {
    return verify_of_stations(signed_bytes(authority_.mission, statement), signature);
  }
  const auto by = nodes_.find(statement.sender);
  if (by == nodes_.end()) return Trust::unknown;
  return verify(by->second, signed_bytes(authority_.mission, statement), signature);
}

Trust Verifier::verify_of_stations(Span said, const Signature& signature) const {
  Trust trust = Trust::unknown;
  for (const auto& [node, by] : nodes_) {
    if (by.role != Role::ground) continue;
    const Trust of_it = verify(by, said, signature);
    if (of_it == Trust::good) return of_it;
    if (trust != Trust::revoked) trust = of_it;
  }
  return trust;
}

Trust Verifier::verify(const std::string& op, const Approval& approval,
                       const Signature& signature) const {
  const auto by = operators_.find(op);
  if (by == operators_.end()) return Trust::unknown;
  return verify(by->second, signed_bytes(authority_.mission, approval), signature);
}

Trust Verifier::verify(const Certificate& by, Span said, const Signature& signature) const {
  if (revoked_.contains(by.serial)) return Trust::revoked;
  return ed25519_verify(by.sign_key, said, signature) ? Trust::good : Trust::forged;
}

}  // namespace skein::identity
