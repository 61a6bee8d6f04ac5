// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/idl/topics.hpp"
#include "skein/mission/messages.hpp"
#include "skein/network/sign_config.hpp"

namespace skein::network {

/// What a signature adds to a message, behind it: sequence (8) and time (8), little endian, the
/// signature (64), and a mark by which it is known.
inline constexpr std::size_t kSignatureBytes = 8 + 8 + 64 + 4;

/// Makes the signatures of this node's decisions and judges those of others. From any thread: DDS
/// receives in several.
class Signatures {
 public:
  Signatures(SignConfig config, VehicleId self, InstanceId instance);

  /// A certificate as its node told it (identity::to_bytes), which may be anybody's. Nothing comes
  /// of one that is no good: it is verified when something that its node has signed is to be
  /// judged, which of most nodes of a large team is never.
  void learn(std::span<const std::uint8_t> certificate);
  void learn(const identity::RevocationList& list);
  /// Behind a message of that topic, of those bytes.
  void sign(codec::Topic topic, std::vector<std::uint8_t>& bytes);

  enum class Judged : std::uint8_t { good, missing, forged, replayed, count };
  /// A decision of that sender. It is good once: none that came later in the sender's order, or
  /// under a later start of its program, may have been judged good before; and nothing that was
  /// signed well before this node was started is due now. Setups are, which tell of clocks.
  [[nodiscard]] Judged judge(codec::Topic topic, VehicleId sender, InstanceId instance,
                             std::span<const std::uint8_t> body,
                             std::optional<std::span<const std::uint8_t>> signature);
  /// A grant carries the approval of an operator of this mission; all else needs none.
  [[nodiscard]] Judged judge_approval(const mission::Message& message);

 private:
  struct Newest {
    InstanceId instance;
    std::uint64_t sequence = 0;
  };

  /// More of them are verified as they come: whoever floods takes time, not memory, and no more of
  /// it at once than a few take.
  static constexpr std::size_t kUnverifiedMax = 2048;
  static constexpr std::size_t kUnverifiedOfNode = 4;
  struct Unverified {
    identity::Certificate certificate;
    std::chrono::seconds heard_at;  ///< since 1970: it must be valid then
  };

  void verify_certificates(VehicleId of);
  void verify(const Unverified& unverified);

  const SignConfig config_;
  const VehicleId self_;
  const InstanceId instance_;
  std::mutex mutex_;
  identity::Verifier verifier_;
  std::multimap<VehicleId, Unverified> unverified_;  ///< of each as they came
  std::array<std::uint64_t, codec::kTopicCount> said_{};
  std::map<std::pair<VehicleId, codec::Topic>, Newest> newest_;  ///< of members: bounded by them
  std::map<VehicleId, identity::Serial> serials_;                ///< of their certificates
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// The signature at the end of a sample's bytes, which is cut off them; none where there is none.
[[nodiscard]] std::optional<std::span<const std::uint8_t>> cut_signature(
    std::span<const std::uint8_t>& bytes);

}  // namespace skein::network
