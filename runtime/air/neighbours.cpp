// SPDX-License-Identifier: Apache-2.0
#include "neighbours.hpp"

#include <iterator>
#include <utility>

namespace skein::air {

bool Neighbours::heard(const Author& author, Instant now) {
  if (all_.size() >= kMax && !all_.contains(author.node)) return false;
  const auto [at, is_new] = all_.try_emplace(author.node);
  Neighbour& neighbour = at->second;
  if (neighbour.instance != author.instance) neighbour = {author.instance, now, {}, false};
  neighbour.heard_at = now;
  return is_new;
}

bool Neighbours::on_hearing(VehicleId node, const HearingFrame& frame) {
  const auto known = all_.find(node);
  if (known == all_.end()) return false;
  Neighbour& neighbour = known->second;
  if (!frame.goes_on) neighbour.hears.clear();
  if (neighbour.hears.size() >= kWindowsMax) return false;
  if (!neighbour.hears.empty() && frame.first <= neighbour.hears.back().first) return false;
  neighbour.hears.push_back({frame.first, {frame.bits.begin(), frame.bits.end()}});
  return hears(neighbour, self_) && !std::exchange(neighbour.has_heard_us, true);
}

void Neighbours::forget_silent(Instant now) {
  std::erase_if(all_, [now](const auto& entry) { return now - entry.second.heard_at > kFor; });
}

bool Neighbours::hears(const Neighbour& neighbour, VehicleId whom) const {
  ++looks_;
  const auto after = std::ranges::upper_bound(neighbour.hears, whom, {}, &Window::first);
  if (after == neighbour.hears.begin()) return false;
  const Window& window = *std::prev(after);
  const auto bit = static_cast<std::size_t>(whom.value - window.first.value);
  return bit / 8 < window.bits.size() && (window.bits[bit / 8] >> bit % 8 & 1U) != 0;
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
  std::vector<VehicleId> rivals;           // heard it, too
  std::vector<const Neighbour*> beyond;    // neither it nor we reach them
  std::vector<const Neighbour*> audience;  // for whom it is
  for (const auto& [node, neighbour] : all_) {
    if (node == transmitter || node == self_) continue;
    if (hears(neighbour, transmitter)) {
      rivals.push_back(node);
    } else if (std::ranges::binary_search(uncovered, node)) {
      audience.push_back(&neighbour);
    } else if (!hears(neighbour, self_)) {
      beyond.push_back(&neighbour);
    }
  }
  const std::size_t looks_end = looks_ + kLooksMax;
  for (const VehicleId rival : rivals) {
    if (looks_ >= looks_end) return false;
    const auto is_reached = [&](const Neighbour* node) { return hears(*node, rival); };
    if (!std::ranges::all_of(audience, is_reached)) continue;
    if (rival < self_ || std::ranges::any_of(beyond, is_reached)) return true;
  }
  return false;
}

std::size_t Neighbours::listeners() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      all_, [this](const auto& entry) { return hears(entry.second, self_); }));
}

}  // namespace skein::air
