// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "frames.hpp"
#include "skein/air/link.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// The parts that this node has said and may be asked for again.
class OutStream {
 public:
  /// Numbers a part that is being said now. The parts of a sample follow each other.
  PartFrame add(std::uint8_t channel, bool begins, bool ends, std::vector<std::uint8_t> bytes,
                Instant now);
  /// Who asks sooner than `answered` after it was said cannot have heard it yet.
  void asked(const MissingFrame& missing, Duration answered, Instant now);
  /// The oldest part that is to be said again and that no call has marked since; its bytes are
  /// valid until the next change. `from` is where to look from, and becomes where it was found.
  [[nodiscard]] std::optional<PartFrame> wanted(std::size_t& from) const;
  void said_again(std::size_t at, Instant now);
  [[nodiscard]] bool wants() const { return wanted_ > 0; }
  void forget(Instant now);
  [[nodiscard]] Head head() const;

 private:
  struct Part {
    PartFrame frame;  ///< its bytes are below
    std::vector<std::uint8_t> bytes;
    Instant said_at;
    Instant heard_of_at;  ///< when it was said or said again
    bool wanted = false;
  };
  std::deque<Part> parts_;  ///< their numbers follow each other; the last is `newest_`
  std::uint16_t newest_ = 0;
  std::size_t wanted_ = 0;
};

}  // namespace skein::air
