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
  static constexpr std::size_t kMax = 1024;                  ///< more are none

  explicit Neighbours(VehicleId self) : self_{self} {}

  /// Whether it was none before. Another start of a node has not said yet whom it hears.
  bool heard(const Author& author, Instant now);
  /// Whether it hears us, and did not before.
  bool on_hearing(VehicleId node, const HearingFrame& frame);
  void forget_silent(Instant now);

  /// As that neighbour says, of whom it hears. Nobody else is known to hear anybody.
  [[nodiscard]] bool hears(VehicleId neighbour, VehicleId whom) const;
  /// Those that hear us, but not `whom`, and are not `whom`.
  [[nodiscard]] std::vector<VehicleId> without(VehicleId whom) const;
  /// Whether another neighbour that hears `transmitter`, too, is to pass on before us what is for
  /// `uncovered` (sorted): it reaches all of them, and somebody else whom we do not, or has the
  /// smaller id. None is where kLooksMax looks do not find it.
  [[nodiscard]] bool has_better(VehicleId transmitter,
                                const std::vector<VehicleId>& uncovered) const;
  static constexpr std::size_t kLooksMax = 20'000;
  /// How many hear us.
  [[nodiscard]] std::size_t listeners() const;

  /// How often it was looked up whether one hears another: what datagrams cost.
  [[nodiscard]] std::size_t looks() const { return looks_; }

  /// Calls `tell` with the frames that say whom we hear.
  template <class Tell>
  void tell_hearing(const Tell& tell) const {
    std::vector<std::uint8_t> bits;
    for (auto at = all_.begin(); at != all_.end();) {
      const auto first = at->first;
      bits.clear();
      for (; at != all_.end(); ++at) {
        const auto bit = static_cast<std::size_t>(at->first.value - first.value);
        if (bit / 8 >= std::min(bits.size() + kGapMax, kWindowBytesMax)) break;
        bits.resize(std::max(bits.size(), bit / 8 + 1));
        bits[bit / 8] = static_cast<std::uint8_t>(bits[bit / 8] | 1U << bit % 8);
      }
      tell(HearingFrame{first != all_.begin()->first, first, bits});
    }
  }

 private:
  static constexpr std::size_t kGapMax = 8;  ///< bytes; a wider gap costs more than a new frame
  static constexpr std::size_t kWindowBytesMax = 255;
  static constexpr std::size_t kWindowsMax = 64;  ///< of a neighbour; more are not taken

  struct Window {
    VehicleId first;
    std::vector<std::uint8_t> bits;
  };
  struct Neighbour {
    InstanceId instance;
    Instant heard_at;
    std::vector<Window> hears;  ///< in their order
    bool has_heard_us = false;
  };
  [[nodiscard]] bool hears(const Neighbour& neighbour, VehicleId whom) const;

  VehicleId self_;
  std::map<VehicleId, Neighbour> all_;
  mutable std::size_t looks_ = 0;
};

}  // namespace skein::air
