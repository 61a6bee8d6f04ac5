// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/setup_book.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {

/// A place in the configuration is short: so many fit into a text of a message.
constexpr std::size_t kKeysTextMax = 160;
/// Of two programs with one number; goes on like a key: "another ...".
constexpr const char* kTwin = "program under its number";
constexpr std::size_t kEarlierMax = 4;
constexpr int kTwinLasts = 3;  ///< periods

/// But for how far the clock is out, which every message measures anew.
bool same(const std::optional<SetupDifference>& a, const std::optional<SetupDifference>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->keys == b->keys && (a->clock_ahead_s == 0.0) == (b->clock_ahead_s == 0.0);
}

}  // namespace

std::uint32_t setup_hash(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) {
    hash ^= static_cast<std::uint8_t>(c);
    hash *= 16777619U;
  }
  return hash;
}

std::string text_of(const SetupDifference& difference) {
  std::string text = difference.keys.empty() ? "" : "another " + difference.keys;
  if (difference.clock_ahead_s != 0.0) {
    std::array<char, 64> clock{};
    std::snprintf(clock.data(), clock.size(), "a clock that is %.1f s %s",
                  std::abs(difference.clock_ahead_s),
                  difference.clock_ahead_s > 0.0 ? "ahead" : "behind");
    text.append(text.empty() ? "" : ", and ").append(clock.data());
  }
  return text;
}

std::vector<SetupItem> items_of(const SetupParams& params) {
  std::vector<SetupItem> items;
  for (const CommonKey& common : params.common) {
    items.push_back({setup_hash(common.name), common.value});
  }
  return items;
}

SetupBook::SetupBook(const SetupParams& params, VehicleId self, InstanceId instance, Instant now)
    : params_{params}, next_{now} {
  SKEIN_ASSERT(params_.common.size() <= kSetupItemsMax);
  own_.node = self;
  own_.instance = instance;
  own_.clock_guard = params_.clock_guard;
  own_.items = items_of(params_);
  for (const CommonKey& common : params_.common) {
    by_key_.emplace(setup_hash(common.name), &common);
  }
}

void SetupBook::on_setup(const Setup& setup, Instant now) {
  if (setup.node == own_.node && setup.instance == own_.instance) return;
  if (!nodes_.contains(setup.node) && nodes_.size() >= kNodesMax) return;
  Node& node = nodes_[setup.node];
  if (node.instance != setup.instance) {
    // Whoever is new has not heard of this node either.
    say_soon(now);
    if (node.instance == InstanceId{}) ++told_;
    const Node before = std::exchange(node, {});
    node.instance = setup.instance;
    node.difference = before.difference;
    node.earlier = before.earlier;
    node.twin_at = before.twin_at;
    // A program that has ended does not speak again: there are two.
    if (contains(node.earlier, setup.instance)) node.twin_at = now;
    if (before.instance != InstanceId{}) node.earlier.push_back(before.instance);
    if (node.earlier.size() > kEarlierMax) node.earlier.erase(node.earlier.begin());
  }
  if (setup.node == own_.node) {
    node.twin_at = now;
    return compare(setup.node, node, now);
  }
  node.keys = differing_keys(setup);
  watch_clock(node, setup, now);
  compare(setup.node, node, now);
}

void SetupBook::on_ahead(VehicleId id, Duration ahead, Instant now) {
  if (id == own_.node || (!nodes_.contains(id) && nodes_.size() >= kNodesMax)) return;
  Node& node = nodes_[id];
  node.clean = 0;
  if (node.ahead_s > 0.0) return;
  node.ahead_s = to_seconds(ahead);
  compare(id, node, now);
}

/// What is news is told the others at once: they may not know it of themselves.
void SetupBook::compare(VehicleId id, Node& node, Instant now) {
  std::string keys = node.keys;
  if (node.twin_at) keys.append(keys.empty() ? "" : ", ").append(kTwin);
  std::optional<SetupDifference> difference;
  suspects_ = suspects_ || node.twin_at || node.ahead_s != 0.0;
  if (!keys.empty() || node.ahead_s != 0.0) difference = SetupDifference{keys, node.ahead_s};
  const bool is_news = !same(difference, node.difference);
  node.difference = std::move(difference);
  if (!is_news) return;
  say_soon(now);
  if (node.difference) {
    news_.push(event::SetupDiffers{id, keys, node.ahead_s});
  } else {
    news_.push(event::SetupAgrees{id});
  }
}

void SetupBook::say_soon(Instant now) {
  next_ = std::min(next_, std::max(now, said_at_ + in_this_team(soon_)));
  hurried_ = true;
}

Duration SetupBook::in_this_team(Duration period) const {
  return period * static_cast<std::int64_t>(std::max<std::size_t>(1, told_ / kTeam));
}

/// Keys that only one of the two knows of are of another release, which is a key of its own.
std::string SetupBook::differing_keys(const Setup& setup) const {
  std::string keys;
  std::size_t more = 0;
  for (const SetupItem& item : setup.items) {
    const auto own = by_key_.find(item.key);
    if (own == by_key_.end() || own->second->value == item.value) continue;
    if (keys.size() + own->second->name.size() > kKeysTextMax) {
      ++more;
    } else {
      keys.append(keys.empty() ? "" : ", ").append(own->second->name);
    }
  }
  if (more > 0) keys.append(" and ").append(std::to_string(more)).append(" more");
  return keys;
}

/// Ahead: as measured here. Behind: as the other says, who finds this one ahead; by how much is
/// measured here, less the delay.
void SetupBook::watch_clock(Node& node, const Setup& setup, Instant now) const {
  const Duration ahead = setup.time - now;
  const bool is_ahead = ahead > std::min(params_.clock_guard, setup.clock_guard);
  const bool is_behind = contains(setup.ahead, own_.node) && ahead < Duration{};
  if (is_ahead || is_behind) {
    node.ahead_s = to_seconds(ahead);
    node.clean = 0;
  } else if (node.ahead_s != 0.0 && (node.clean == 0 || now - node.clean_at >= kCleanApart)) {
    node.clean_at = now;
    if (++node.clean >= kClean) node.ahead_s = 0.0;
  }
}

std::optional<Setup> SetupBook::poll_setup(const Orders& orders, Instant now) {
  if (now < next_) return std::nullopt;
  if (suspects_) forget_twins(now);
  said_at_ = now;
  soon_ = hurried_ ? std::min(2 * soon_, kPeriod) : kPeriodWhileNew;
  hurried_ = false;
  next_ = now + (orders.known ? in_this_team(kPeriod) : kPeriodWhileNew);
  Setup setup = own_;
  setup.time = now;
  setup.knows_orders = orders.known;
  setup.newest_order = orders.newest;
  if (!suspects_) return setup;
  for (const auto& [id, node] : nodes_) {
    if (node.ahead_s > 0.0 && setup.ahead.size() < kHeardMax) setup.ahead.push_back(id);
  }
  return setup;
}

void SetupBook::forget_twins(Instant now) {
  for (auto& [id, node] : nodes_) {
    if (!node.twin_at || now - *node.twin_at <= kTwinLasts * in_this_team(kPeriod)) continue;
    node.twin_at.reset();
    compare(id, node, now);
  }
}

const SetupDifference* SetupBook::difference(VehicleId node) const {
  const auto known = nodes_.find(node);
  return known == nodes_.end() || !known->second.difference ? nullptr : &*known->second.difference;
}

}  // namespace skein::mission
