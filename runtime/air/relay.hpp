// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "frames.hpp"
#include "neighbours.hpp"
#include "skein/air/link.hpp"
#include "skein/base/random.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// A datagram as it was on the air.
struct Passage {
  Author author;
  VehicleId transmitter;  ///< from whom it was heard: its author, or who passed it on
  std::uint8_t hops = 0;  ///< how often it may be passed on yet
  bool late = false;      ///< said again for its parts
  std::span<const std::uint8_t> bytes;
};

/// Passes on what others say to those who did not hear it, by the scalable broadcast algorithm
/// (Peng and Lu, MobiHoc 2000): who has neighbours that did not hear a datagram waits a little,
/// longer where another is to go before it, and drops it when all of them have heard it from others
/// meanwhile. What can be asked for is kept for a while, and said again to who asks and does not
/// hear its author.
class Relay {
 public:
  /// `bytes_max`: of a frame.
  Relay(VehicleId self, std::uint8_t hops_max, std::size_t bytes_max);

  [[nodiscard]] bool passes() const { return hops_max_ > 1; }
  /// How often what is heard from its author may be passed on.
  [[nodiscard]] std::uint8_t hops() const { return static_cast<std::uint8_t>(hops_max_ - 1); }
  /// A little, in which others may do it.
  [[nodiscard]] static Duration wait(Random& random);

  /// A datagram that was heard for the first time, and those of its parts that were new; `spreads`:
  /// it is to be passed on.
  void on_first(const Passage& passage, std::vector<std::uint16_t> parts, bool spreads,
                Urgency urgency, Instant now, Random& random);
  /// One that was heard before.
  void on_copy(const Passage& passage);
  void on_missing(VehicleId asker, const MissingFrame& missing, Instant now, Random& random);

  [[nodiscard]] std::optional<Instant> due(Urgency urgency) const;
  /// The next that fits into so many bytes, if one is due; valid until the next call.
  [[nodiscard]] std::optional<PassedOnFrame> take(Urgency urgency, Instant now, std::size_t room);

  void forget(Instant now);
  /// Datagrams that waited until newer ones took their place.
  [[nodiscard]] std::uint64_t gave_way() const { return gave_way_; }

  Neighbours neighbours;

 private:
  struct Waiting {
    std::vector<std::uint8_t> bytes;
    std::uint8_t hops = 0;
    bool late = false;
    Urgency urgency = Urgency::decision;
    Instant at;
    std::vector<VehicleId> uncovered;  ///< did not hear it, as far as is known
  };
  struct Kept {
    Author author;
    std::vector<std::uint16_t> parts;
    std::vector<std::uint8_t> bytes;
    Urgency urgency = Urgency::decision;
    Instant heard_at;
    std::optional<Instant> asked_at;
  };
  [[nodiscard]] std::deque<Waiting>::iterator waiting_as(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Instant when(const std::vector<VehicleId>& uncovered, Instant now,
                             Random& random) const;
  void wait_until(Instant at, const Passage& passage, Urgency urgency,
                  std::vector<VehicleId> uncovered);

  const VehicleId self_;
  const std::uint8_t hops_max_;
  const std::size_t bytes_max_;
  std::deque<Waiting> waiting_;
  std::deque<Kept> kept_;
  std::vector<std::uint8_t> taken_;
  std::uint64_t gave_way_ = 0;
};

}  // namespace skein::air
