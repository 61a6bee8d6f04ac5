// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "skein/base/random.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// How long to wait before what is missing is asked for, and for the answer: learned from what
/// came, for the network is as it is, over however many hops. Who asks for what only comes late
/// makes the more traffic the busier the air is. Whatever is learned, or somebody wants to be, what
/// is lost is asked for within half a second, and again every half second.
class RepairPace {
 public:
  /// Nothing is asked for sooner than `least`.
  explicit RepairPace(Duration least) : least_{least} {}

  /// A missing part came as it was said first, so long after something that was said later.
  void on_late(Duration by, Instant now);
  /// The answer to the only question came, so long after it.
  void on_answer(Duration after);
  /// It came after several questions: to which of them, nobody knows.
  void on_late_answer();

  /// How long what is missing may still come by itself; and others may be about to ask.
  [[nodiscard]] Duration patience(Instant now, Random& random) const;
  /// From a question to its answer, as a rule.
  [[nodiscard]] Duration round_trip() const { return round_trip_; }
  /// How long to wait for an answer, after so many questions.
  [[nodiscard]] Duration ask_again(int asked) const;

 private:
  [[nodiscard]] Duration latest(Instant now) const;

  Duration least_;
  Duration latest_{};  ///< the most by which something came late, not long ago
  Instant latest_at_;
  Duration round_trip_ = std::chrono::milliseconds{30};
};

}  // namespace skein::air
