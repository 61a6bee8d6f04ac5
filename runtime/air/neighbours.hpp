// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "frames.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// Whom this node hears itself, and whom each of those hears, as it says.
class Neighbours {
 public:
  static constexpr Duration kFor = std::chrono::seconds{3};  ///< after it was heard last

  explicit Neighbours(VehicleId self) : self_{self} {}

  /// Whether it was none before.
  bool heard(VehicleId node, Instant now);
  /// Whether it hears us, and did not before.
  bool on_hearing(VehicleId node, const HearingFrame& frame);
  void forget_silent(Instant now);

  /// As that neighbour says, of whom it hears. Nobody else is known to hear anybody.
  [[nodiscard]] bool hears(VehicleId neighbour, VehicleId whom) const;
  /// Those that hear us, but not `whom`, and are not `whom`.
  [[nodiscard]] std::vector<VehicleId> without(VehicleId whom) const;
  /// Whether another neighbour that hears `transmitter`, too, is to pass on before us what is for
  /// `uncovered`: it reaches all of them, and somebody else whom we do not, or has the smaller id.
  [[nodiscard]] bool has_better(VehicleId transmitter,
                                const std::vector<VehicleId>& uncovered) const;
  /// How many hear us.
  [[nodiscard]] std::size_t listeners() const;

  /// Calls `tell` with the frames that say whom we hear.
  template <class Tell>
  void tell_hearing(const Tell& tell) const {
    std::vector<std::uint8_t> bits;
    for (auto at = all_.begin(); at != all_.end();) {
      const auto first = at->first;
      bits.clear();
      for (; at != all_.end(); ++at) {
        const auto bit = static_cast<std::size_t>(at->first.value - first.value);
        if (bit / 8 >= std::min(bits.size() + kGapMax, kWindowMax)) break;
        bits.resize(std::max(bits.size(), bit / 8 + 1));
        bits[bit / 8] = static_cast<std::uint8_t>(bits[bit / 8] | 1U << bit % 8);
      }
      tell(HearingFrame{first != all_.begin()->first, first, bits});
    }
  }

 private:
  static constexpr std::size_t kGapMax = 8;  ///< bytes; a wider gap costs more than a new frame
  static constexpr std::size_t kWindowMax = 255;

  struct Window {
    VehicleId first;
    std::vector<std::uint8_t> bits;
  };
  struct Neighbour {
    Instant heard_at;
    std::vector<Window> hears;
    bool has_heard_us = false;
  };
  [[nodiscard]] static bool hears(const Neighbour& neighbour, VehicleId whom);

  VehicleId self_;
  std::map<VehicleId, Neighbour> all_;
};

}  // namespace skein::air
