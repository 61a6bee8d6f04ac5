// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "skein/base/time.hpp"
#include "skein/onboard/preflight.hpp"

/// What a vehicle's checks find, for the ground station: a summary, since the air is narrow.
namespace skein::onboard {

/// Of the lines' text together; what is beyond is only counted.
inline constexpr std::size_t kPreflightTextMax = 1000;

/// Fills in `base` what `checks` found: counts of each group, and the lines that are not ok, those
/// that fail first.
[[nodiscard]] mission::Preflight preflight_of(mission::Preflight base, const Checks& checks);

/// Of the parameters that were looked at: the same where they are set alike, each autopilot's own
/// system id apart; 0 where none was told.
[[nodiscard]] std::uint32_t digest_of(const ardupilot::AutopilotFacts& facts);

/// When it is told: at once where a verdict is another or a ground station asks, but not more often
/// than kSpacing; where only figures are, after kFigures; and again each kRepeat.
class PreflightTeller {
 public:
  static constexpr Duration kSpacing = std::chrono::seconds{2};
  static constexpr Duration kFigures = std::chrono::seconds{10};
  static constexpr Duration kRepeat = std::chrono::seconds{30};

  void put(mission::Preflight newest) { newest_ = std::move(newest); }
  /// Somebody has started who has heard nothing yet.
  void ask() { asked_ = true; }
  /// What is to be told at `now`, which never decreases.
  [[nodiscard]] std::optional<mission::Preflight> due(Instant now);

 private:
  std::optional<mission::Preflight> newest_;
  std::optional<mission::Preflight> told_;
  Instant told_at_{};
  bool asked_ = false;
};

}  // namespace skein::onboard
