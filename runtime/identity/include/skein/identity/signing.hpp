// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/keys.hpp"

namespace skein::identity {

/// A message as its sender signs it: what it says, and where and when it was said, so that it is of
/// no use elsewhere or later.
struct Statement {
  std::string_view topic;  ///< at most 255 bytes
  VehicleId sender;
  InstanceId instance;         ///< of the sender's program
  std::uint64_t sequence = 0;  ///< in that topic
  Instant time{};
  Span body;  ///< as it goes over the air
};

/// An operator's decision, signed with his own key: it holds for one plan, for these vehicles and
/// this while, whoever carries it.
struct Approval {
  static constexpr std::size_t kVehiclesMax = 4096;
  std::array<std::uint8_t, 32> plan{};  ///< digest() of the plan as it was put before him
  std::vector<VehicleId> vehicles;      ///< in order; at most kVehiclesMax
  Instant from{};
  Instant until{};
  bool granted = false;
};

/// SHA-256.
[[nodiscard]] std::array<std::uint8_t, 32> digest(Span bytes);

/// What is signed, big endian: "skein statement 1", mission (16), length of the topic (1) and
/// topic, sender (2), instance (8), sequence (8), mission time in ns (8), length of the body (4)
/// and body.
[[nodiscard]] Bytes signed_bytes(const MissionId& mission, const Statement& statement);
/// "skein approval 1", mission (16), plan (32), granted (1), from and until in ns (8 each), how
/// many vehicles (2), vehicles (2 each).
[[nodiscard]] Bytes signed_bytes(const MissionId& mission, const Approval& approval);

/// From any thread. A signature takes some 50 us.
class Signer {
 public:
  Signer(const MissionId& mission, const Secret& sign_key) : mission_{mission}, key_{sign_key} {}
  [[nodiscard]] Signature sign(const Statement& statement) const;
  [[nodiscard]] Signature sign(const Approval& approval) const;

 private:
  MissionId mission_;
  Secret key_;
};

/// Knows whose signatures to believe. A certificate is checked once, when it is learnt: whether it
/// is valid then counts, so that no flight is cut by a date. A signature takes some 150 us. Of one
/// thread; memory is bounded by kMembersMax.
class Verifier {
 public:
  /// Precondition: the authority's certificate was checked.
  explicit Verifier(Certificate authority) : authority_{std::move(authority)} {}

  /// Of a node or an operator of this mission. A newer one of the same node (by its serial) takes
  /// the older one's place, an older one is not learnt.
  [[nodiscard]] Trust learn(const Certificate& certificate, std::int64_t now_unix_s);
  /// A list of an earlier epoch than the one that is known changes nothing.
  [[nodiscard]] Trust learn(const RevocationList& list);
  [[nodiscard]] bool knows(VehicleId node) const { return nodes_.contains(node); }
  /// More than one ground station may speak in this mission, as far as is known.
  [[nodiscard]] bool knows_stations() const;

  /// Did that node say this? As the ground station, did one of the mission's ground stations?
  [[nodiscard]] Trust verify(const Statement& statement, const Signature& signature) const;
  /// Did that operator decide this?
  [[nodiscard]] Trust verify(const std::string& op, const Approval& approval,
                             const Signature& signature) const;

 private:
  [[nodiscard]] Trust verify(const Certificate& by, Span said, const Signature& signature) const;
  [[nodiscard]] Trust verify_of_stations(Span said, const Signature& signature) const;

  Certificate authority_;
  RevocationList revoked_{.mission = {}, .epoch = 0, .serials = {}, .signature = {}};
  std::map<VehicleId, Certificate> nodes_;  ///< the ground station among them
  std::map<std::string, Certificate> operators_;
};

}  // namespace skein::identity
