// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/mesh.hpp"

#include <utility>

namespace skein::hil::radio {

void Mesh::move(const RadioParams& radio, const Interference& interference,
                std::span<const Node> nodes, Instant now) {
  radio_ = radio;
  interference_ = &interference;
  nodes_ = nodes;
  if (!next_.empty() && now < routes_at_ + params_.mend) return;
  routes_at_ = now;
  find_routes();
}

bool Mesh::relays(std::size_t node) const {
  return nodes_[node].on && (params_.ground_relays || nodes_[node].id != kGroundStation);
}

/// Breadth first from every destination, against the direction of the links.
void Mesh::find_routes() {
  const std::size_t count = nodes_.size();
  next_.assign(count * count, kNobody);
  std::vector<std::vector<std::uint16_t>> heard_from(count);
  for (std::size_t to = 0; to < count; ++to) {
    for (std::size_t from = 0; from < count; ++from) {
      if (from != to && up(from, to)) heard_from[to].push_back(static_cast<std::uint16_t>(from));
    }
  }
  std::vector<std::uint16_t> reached;
  for (std::size_t to = 0; to < count; ++to) {
    const auto next = std::span{next_}.subspan(to * count, count);
    reached.assign(1, static_cast<std::uint16_t>(to));
    next[to] = static_cast<std::uint16_t>(to);
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const std::uint16_t over = reached[i];
      if (over != to && !relays(over)) continue;
      for (const std::uint16_t from : heard_from[over]) {
        if (next[from] != kNobody) continue;
        next[from] = over;
        reached.push_back(from);
      }
    }
  }
}

int Mesh::hops(std::size_t from, std::size_t to) const {
  if (up(from, to)) return 1;
  const std::size_t count = nodes_.size();
  int hops = 0;
  for (std::size_t at = from; at != to; ++hops) {
    const std::uint16_t next = next_[to * count + at];
    if (next == kNobody || hops == params_.hops_max || !up(at, next) ||
        (next != to && !nodes_[next].on)) {
      return 0;
    }
    at = next;
  }
  return hops;
}

}  // namespace skein::hil::radio
