// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/ros2/messages.hpp"

namespace skein::ros2 {

inline constexpr std::size_t kProposalBytesMax = 1024;
inline constexpr std::size_t kProposalNameMax = 40;  ///< characters; the rest is dropped

/// The proposal as a marker of Cursor on Target, which the ground station takes as one of any other
/// agency. Fails where it has no place on earth, or a kind that there is not.
[[nodiscard]] Result<std::string> marker_of(const skein_msgs::SiteProposal& proposal,
                                            const std::string& uid, std::int64_t unix_ns);

/// What of others' samples is passed on; the rest is counted. Pure; `now` never decreases.
class ProposalIntake {
 public:
  static constexpr int kBurst = 20;           ///< at once
  static constexpr double kRate_per_s = 0.5;  ///< and then

  /// `run`: tells the markers of this process from those of others.
  explicit ProposalIntake(std::string run) : run_{std::move(run)} {}

  /// The marker that a sample of SiteProposal in CDR becomes.
  [[nodiscard]] std::optional<std::string> take(std::span<const std::uint8_t> bytes, Instant now,
                                                std::int64_t unix_ns);
  /// Why the last one was not passed on, once.
  [[nodiscard]] std::optional<std::string> poll_trouble();
  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }
  [[nodiscard]] std::uint64_t too_many() const { return too_many_; }

 private:
  [[nodiscard]] bool has_room(Instant now);

  std::string run_;
  std::uint64_t next_ = 1;
  double room_ = kBurst;
  Instant room_at_{};
  std::uint64_t unreadable_ = 0;
  std::uint64_t too_many_ = 0;
  std::optional<std::string> trouble_;
};

}  // namespace skein::ros2
