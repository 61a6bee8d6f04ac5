// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "frames.hpp"
#include "repair_pace.hpp"
#include "skein/base/random.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// The parts of another's stream: puts them in order, joins them, and knows which to ask for. It
/// begins with the first that is said after its author was heard first.
class InStream {
 public:
  using Deliver = std::function<void(std::uint8_t channel, std::span<const std::uint8_t> bytes)>;

  /// Learns from what is missing for a time, and waits as was learned. It must outlive this.
  explicit InStream(RepairPace& pace) : pace_{&pace} {}

  /// Whether it was heard for the first time. `late`: whoever passed it on says it again.
  bool on_part(const PartFrame& part, bool late, Instant now, Random& random,
               const Deliver& deliver);
  /// What the author has said, after the parts of the same datagram.
  void on_head(const Head& head, Instant now, Random& random, const Deliver& deliver);
  /// How far the author is, as another says.
  void on_newest(std::uint16_t newest, Instant now, Random& random);
  /// Somebody else has asked for it.
  void on_asked(const MissingFrame& missing, Instant now, Random& random);

  /// When to ask; none where nothing is missing.
  [[nodiscard]] std::optional<Instant> ask_at() const;
  /// What to ask for now; none where nothing is due.
  [[nodiscard]] std::optional<MissingFrame> ask(const Author& author, Instant now, Random& random);
  /// How far the author is known to be; none where it was not heard yet.
  [[nodiscard]] std::optional<std::uint16_t> newest() const {
    return next_ ? std::optional{static_cast<std::uint16_t>(newest_)} : std::nullopt;
  }
  /// Parts that could not be had.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Held {
    std::uint8_t channel = 0;
    bool begins = false;
    bool ends = false;
    std::vector<std::uint8_t> bytes;
  };
  struct Missing {
    Instant since;
    Instant ask_at;
    bool hearsay = false;  ///< another says that there is such a part
    Instant asked_at = {};
    int asked = 0;
    bool others_asked = false;
  };
  [[nodiscard]] std::uint64_t extended(std::uint16_t number) const;
  void know_of(std::uint64_t newest, bool hearsay, Instant now, Random& random);
  [[nodiscard]] bool forget_hearsay_after(std::uint64_t newest);
  void learn_from(const Missing& missing, bool again, Instant now);
  void take(const Held& part, const Deliver& deliver);
  void take_ready(const Deliver& deliver);
  void skip_to(std::uint64_t number, const Deliver& deliver);

  RepairPace* pace_;
  /// Numbers are counted on from 2^16, so that those before the first are above 0.
  std::optional<std::uint64_t> next_;  ///< the first that is missing or was not said yet
  std::uint64_t newest_ = 0;           ///< of which is known
  std::map<std::uint64_t, Held> early_;
  std::map<std::uint64_t, Missing> missing_;  ///< all from `next_` to `newest_` that are not early
  std::optional<Held> joined_;                ///< the beginning of a sample
  std::uint64_t lost_ = 0;
};

}  // namespace skein::air
