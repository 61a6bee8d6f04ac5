// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "skein/console/sections.hpp"

namespace skein::console {

/// What there is to be seen now, and what has happened: the texts that clients get, each by what it
/// has had already. Without I/O.
class Board {
 public:
  static constexpr std::size_t kEventsKept = 20'000;
  static constexpr std::size_t kEventsPerText = 200;
  /// The time line is all that ever was: it is said again once a second at most.
  static constexpr double kTimelinePeriod_s = 1.0;

  /// How much of the board somebody has seen.
  struct Seen {
    std::uint64_t number = 0;  ///< of publications
    std::array<std::uint64_t, kSectionCount> revisions{};
    std::uint64_t next_seq = 0;
  };

  void publish(double time_s, Sections sections);
  void append(std::vector<std::string> events);
  /// Events from that one on are taken back: they will be appended anew.
  void truncate(std::uint64_t next_seq);

  [[nodiscard]] bool has_state(const Seen& seen) const { return seen.number < number_; }
  /// The newest state: what has changed of it. Precondition: has_state(seen).
  [[nodiscard]] std::string state(Seen& seen) const;
  [[nodiscard]] bool has_events(const Seen& seen) const { return seen.next_seq < next_seq(); }
  /// The next few events; those that are no longer kept are passed over.
  [[nodiscard]] std::string events(Seen& seen) const;
  [[nodiscard]] std::string history(const std::string& series) const;

  [[nodiscard]] std::uint64_t next_seq() const { return first_seq_ + events_.size(); }
  [[nodiscard]] double time_s() const { return time_s_; }

 private:
  double time_s_ = 0.0;
  double timeline_s_ = -1e9;  ///< of the one that is shown
  std::uint64_t number_ = 0;
  Sections sections_;
  std::array<std::uint64_t, kSectionCount> revisions_{};
  std::deque<std::string> events_;
  std::uint64_t first_seq_ = 0;
};

}  // namespace skein::console
