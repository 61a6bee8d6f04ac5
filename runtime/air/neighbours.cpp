// SPDX-License-Identifier: Apache-2.0
#include "neighbours.hpp"

#include <utility>

namespace skein::air {

bool Neighbours::heard(VehicleId node, Instant now) {
  const auto [at, is_new] = all_.try_emplace(node);
  at->second.heard_at = now;
  return is_new;
}

bool Neighbours::on_hearing(VehicleId node, const HearingFrame& frame) {
  const auto known = all_.find(node);
  if (known == all_.end()) return false;
  Neighbour& neighbour = known->second;
  if (!frame.goes_on) neighbour.hears.clear();
  if (neighbour.hears.size() >= kWindowMax) return false;
  neighbour.hears.push_back({frame.first, {frame.bits.begin(), frame.bits.end()}});
  return hears(neighbour, self_) && !std::exchange(neighbour.has_heard_us, true);
}

void Neighbours::forget_silent(Instant now) {
  std::erase_if(all_, [now](const auto& entry) { return now - entry.second.heard_at > kFor; });
}

bool Neighbours::hears(const Neighbour& neighbour, VehicleId whom) {
  return std::ranges::any_of(neighbour.hears, [whom](const Window& window) {
    if (whom < window.first) return false;
    const auto bit = static_cast<std::size_t>(whom.value - window.first.value);
    return bit / 8 < window.bits.size() && (window.bits[bit / 8] >> bit % 8 & 1U) != 0;
  });
}

bool Neighbours::hears(VehicleId neighbour, VehicleId whom) const {
  const auto known = all_.find(neighbour);
  return known != all_.end() && hears(known->second, whom);
}

std::vector<VehicleId> Neighbours::without(VehicleId whom) const {
  std::vector<VehicleId> nodes;
  for (const auto& [node, neighbour] : all_) {
    if (node != whom && hears(neighbour, self_) && !hears(neighbour, whom)) nodes.push_back(node);
  }
  return nodes;
}

bool Neighbours::has_better(VehicleId transmitter, const std::vector<VehicleId>& uncovered) const {
  return std::ranges::any_of(all_, [&](const auto& entry) {
    const VehicleId other = entry.first;
    if (other == self_ || other == transmitter || !hears(entry.second, transmitter)) return false;
    const auto reached = [&](VehicleId node) { return hears(node, other); };
    if (!std::ranges::all_of(uncovered, reached)) return false;
    return other < self_ || std::ranges::any_of(all_, [&](const auto& more) {
             return more.first != transmitter && hears(more.second, other) &&
                    !hears(more.second, transmitter) && !hears(more.second, self_);
           });
  });
}

std::size_t Neighbours::listeners() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      all_, [this](const auto& entry) { return hears(entry.second, self_); }));
}

}  // namespace skein::air
