// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil::radio {

/// Routes over several hops, as a mesh below the programs has them (batman-adv, 802.11s, a radio's
/// own): the shortest, found anew every `mend`. In between a route works as long as each of its
/// links does; who is a neighbour is always reached directly.
class Mesh {
 public:
  explicit Mesh(const MeshParams& params) : params_{params} {}

  /// The nodes where they are at this moment. Preconditions: their number and order stay, and both
  /// spans are there until the next call.
  void move(const RadioParams& radio, const Interference& interference, std::span<const Node> nodes,
            Instant now);
  /// Of the nodes at these places of the span; 0: there is no way.
  [[nodiscard]] int hops(std::size_t from, std::size_t to) const;

 private:
  static constexpr std::uint16_t kNobody = 0xFFFF;
  void find_routes();
  [[nodiscard]] bool relays(std::size_t node) const;
  [[nodiscard]] bool up(std::size_t from, std::size_t to) const {
    return is_up(radio_, *interference_, nodes_[from], nodes_[to]);
  }

  MeshParams params_;
  RadioParams radio_;
  const Interference* interference_ = nullptr;
  std::span<const Node> nodes_;
  Instant routes_at_{};
  std::vector<std::uint16_t> next_;  ///< [to * nodes + from]
};

}  // namespace skein::hil::radio
