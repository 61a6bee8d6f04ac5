// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/radio_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/base/contains.hpp"
#include "skein/base/stations.hpp"

namespace skein::hil::radio {
namespace {

std::size_t group_of(VehicleId node, const std::vector<std::vector<VehicleId>>& groups) {
  const auto has = [node](const auto& group) { return contains(group, node); };
  return static_cast<std::size_t>(std::find_if(groups.begin(), groups.end(), has) - groups.begin());
}

bool is_ground(const Node& node) { return node.id == kGroundStation || is_station(node.id); }

bool in_range(const RadioParams& params, const Node& from, const Node& to) {
  const Vec2 origin{0.0, 0.0};
  const auto place = [&origin](const Node& node) -> const Vec2* {
    if (is_ground(node)) return &origin;
    return node.position ? &*node.position : nullptr;
  };
  const bool ground = is_ground(from) || is_ground(to);
  const Vec2* a = place(from);
  const Vec2* b = place(to);
  if (a == nullptr || b == nullptr) return ground;
  const double range_m = ground ? params.ground_range_m : params.range_m;
  return (*a - *b).squaredNorm() <= range_m * range_m;
}

}  // namespace

void Disturbance::add(const Disturbance& other) {
  loss = std::max(loss, other.loss);
  delay = std::max(delay, other.delay);
  jitter = std::max(jitter, other.jitter);
  if (!other.disorder) return;
  if (!disorder) disorder.emplace();
  disorder->duplicates = std::max(disorder->duplicates, other.disorder->duplicates);
  disorder->held_back = std::max(disorder->held_back, other.disorder->held_back);
  disorder->held_back_max = std::max(disorder->held_back_max, other.disorder->held_back_max);
}

bool Cut::lets_through(VehicleId sender, VehicleId receiver) const {
  if (kind == Kind::bridge && (sender == bridge || receiver == bridge)) return true;
  const std::size_t from = group_of(sender, groups);
  if (kind == Kind::one_way && from == groups.size()) return true;
  return from == group_of(receiver, groups);
}

Cut cut_off(std::vector<VehicleId> group, Cut::Kind kind) {
  Cut cut;
  cut.kind = kind;
  cut.groups.push_back(std::move(group));
  return cut;
}

Cut silence(const std::vector<VehicleId>& nodes, Cut::Kind kind) {
  Cut cut;
  cut.kind = kind;
  for (const VehicleId node : nodes) cut.groups.push_back({node});
  return cut;
}

bool is_up(const RadioParams& params, const Interference& interference, const Node& from,
           const Node& to) {
  return (interference.healed || in_range(params, from, to)) &&
         std::all_of(interference.cuts.begin(), interference.cuts.end(),
                     [&](const Cut& cut) { return cut.lets_through(from.id, to.id); });
}

Link link_when_up(const RadioParams& params, const Interference& interference) {
  const Disturbance& worse = interference.disturbance;
  Link link;
  link.loss = std::max(interference.healed ? 0.0 : params.loss, worse.loss);
  link.delay = params.delay + worse.delay;
  link.jitter = params.jitter + worse.jitter;
  link.disorder = worse.disorder;
  link.bytes_per_s = params.bytes_per_s;
  return link;
}

Link over_hops(const Link& link, int hops) {
  Link way = link;
  if (hops == 1) return way;
  way.up = link.up && hops > 0;
  if (!way.up) return way;
  way.loss = 1.0 - std::pow(1.0 - link.loss, hops);
  way.delay = hops * link.delay;
  way.jitter = hops * link.jitter;
  if (link.bytes_per_s) way.bytes_per_s = *link.bytes_per_s / hops;
  return way;
}

Link in_real_time(const Link& link, double rate) {
  const auto real = [rate](Duration d) { return from_seconds(to_seconds(d) / rate); };
  Link slowed = link;
  slowed.delay = real(link.delay);
  slowed.jitter = real(link.jitter);
  if (slowed.bytes_per_s) slowed.bytes_per_s = *link.bytes_per_s * rate;
  if (slowed.disorder) slowed.disorder->held_back_max = real(link.disorder->held_back_max);
  return slowed;
}

Arrivals carry(const Link& link, Random& random) {
  Arrivals arrivals;
  if (!link.up || random.chance(link.loss)) return arrivals;
  const auto delay = [&] {
    const double share = random.uniform(-1.0, 1.0);
    return std::max(Duration{}, link.delay + from_seconds(share * to_seconds(link.jitter)));
  };
  arrivals.push_back(delay());
  if (!link.disorder) return arrivals;
  if (random.chance(link.disorder->held_back)) {
    arrivals.back() += from_seconds(random.uniform(0.0, to_seconds(link.disorder->held_back_max)));
  }
  if (random.chance(link.disorder->duplicates)) arrivals.push_back(delay());
  return arrivals;
}

Arrivals Channel::carry(const Link& link, VehicleId from, std::size_t bytes, Instant now,
                        Random& random) {
  Arrivals arrivals = radio::carry(link, random);
  if (!link.bytes_per_s || !link.up) return arrivals;
  // What is lost has taken its time of the channel, too.
  const Duration takes = from_seconds(static_cast<double>(bytes) / *link.bytes_per_s);
  Instant& half_free_at = half_free_at_[from];
  const Instant free_at = std::max(free_at_, now) + takes;
  if (half_free_at - now > 2 * kBurst || free_at - now > kWaitMax) return {};
  half_free_at = std::max(half_free_at, now) + 2 * takes;
  free_at_ = free_at;
  for (Duration& delay : arrivals) delay += free_at - now;
  return arrivals;
}

}  // namespace skein::hil::radio
