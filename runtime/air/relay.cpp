// SPDX-License-Identifier: Apache-2.0
#include "relay.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace skein::air {
namespace {

using namespace std::chrono_literals;

/// How long others are given to do it: the less, the more it is needed, and by chance.
constexpr double kWait_s = 0.005;
constexpr double kWaitByNeed_s = 0.010;
constexpr double kWaitByChance_s = 0.010;
/// And who goes first, until it is taken for not having heard it.
constexpr Duration kOther = 150ms;
constexpr Duration kTogether = 3ms;  ///< what is due within this goes in one datagram
constexpr std::size_t kWaitingMax = 64;

constexpr std::size_t kKeptMax = 512;
constexpr Duration kKeptFor = 15s;    ///< as its author holds it
constexpr Duration kAnswered = 50ms;  ///< who asks before could not have heard the last answer

}  // namespace

Relay::Relay(VehicleId self, std::uint8_t hops_max, std::size_t bytes_max)
    : neighbours{self}, self_{self}, hops_max_{hops_max}, bytes_max_{bytes_max} {}

Duration Relay::wait(Random& random) {
  return from_seconds(random.uniform(kWait_s, kWait_s + kWaitByNeed_s + kWaitByChance_s));
}

std::deque<Relay::Waiting>::iterator Relay::waiting_as(std::span<const std::uint8_t> bytes) {
  return std::ranges::find_if(waiting_, [bytes](const Waiting& waiting) {
    return std::ranges::equal(waiting.bytes, bytes);
  });
}

Instant Relay::when(const std::vector<VehicleId>& uncovered, Instant now, Random& random) const {
  const double need = static_cast<double>(uncovered.size()) /
                      static_cast<double>(std::max<std::size_t>(neighbours.listeners(), 1));
  return now + from_seconds(kWait_s + kWaitByNeed_s * (1.0 - need) +
                            random.uniform(0.0, kWaitByChance_s));
}

void Relay::wait_until(Instant at, const Passage& passage, Urgency urgency,
                       std::vector<VehicleId> uncovered) {
  if (kPassedOnBytes + passage.bytes.size() > bytes_max_) return;
  if (waiting_.size() == kWaitingMax) {
    waiting_.pop_front();
    ++gave_way_;
  }
  waiting_.push_back({{passage.bytes.begin(), passage.bytes.end()},
                      static_cast<std::uint8_t>(passage.hops - 1),
                      passage.late,
                      urgency,
                      at,
                      std::move(uncovered)});
}

void Relay::on_first(const Passage& passage, std::vector<std::uint16_t> parts, bool spreads,
                     Urgency urgency, Instant now, Random& random) {
  if (!passes()) return;
  if (spreads && passage.hops > 0) {
    auto uncovered = neighbours.without(passage.author.node);
    std::erase_if(uncovered, [&](VehicleId node) {
      return node == passage.transmitter || neighbours.hears(node, passage.transmitter);
    });
    if (!uncovered.empty()) {
      auto at = when(uncovered, now, random);
      if (neighbours.has_better(passage.transmitter, uncovered)) at += kOther;
      wait_until(at, passage, urgency, std::move(uncovered));
    }
  }
  if (parts.empty()) return;
  if (kept_.size() == kKeptMax) kept_.pop_front();
  kept_.push_back({passage.author,
                   std::move(parts),
                   {passage.bytes.begin(), passage.bytes.end()},
                   urgency,
                   now,
                   std::nullopt});
}

void Relay::on_copy(const Passage& passage) {
  const auto same = waiting_as(passage.bytes);
  if (same == waiting_.end()) return;
  std::erase_if(same->uncovered, [&](VehicleId node) {
    return node == passage.transmitter || neighbours.hears(node, passage.transmitter);
  });
  if (same->uncovered.empty()) waiting_.erase(same);
}

/// Its author is left to answer whom it is heard by, once.
void Relay::on_missing(VehicleId asker, const MissingFrame& missing, Instant now, Random& random) {
  if (!passes() || !neighbours.hears(asker, self_)) return;
  const bool hears_author = neighbours.hears(asker, missing.author.node);
  for (Kept& kept : kept_) {
    const auto asked = [&](std::uint16_t part) { return is_asked_for(missing, part); };
    if (kept.author != missing.author || std::ranges::none_of(kept.parts, asked)) continue;
    if (kept.asked_at && now - *kept.asked_at < kAnswered) continue;
    const bool is_first = !kept.asked_at;
    kept.asked_at = now;
    if (is_first && hears_author) continue;
    if (const auto same = waiting_as(kept.bytes); same != waiting_.end()) {
      same->uncovered.push_back(asker);
      continue;
    }
    wait_until(when({asker}, now, random), {kept.author, self_, hops(), true, kept.bytes},
               kept.urgency, {asker});
  }
}

std::optional<Instant> Relay::due(Urgency urgency) const {
  std::optional<Instant> due;
  for (const Waiting& waiting : waiting_) {
    if (waiting.urgency == urgency) due = std::min(due.value_or(waiting.at), waiting.at);
  }
  return due;
}

std::optional<PassedOnFrame> Relay::take(Urgency urgency, Instant now, std::size_t room) {
  const auto next = std::ranges::find_if(waiting_, [&](const Waiting& waiting) {
    return waiting.urgency == urgency && waiting.at <= now + kTogether &&
           kPassedOnBytes + waiting.bytes.size() <= room;
  });
  if (next == waiting_.end()) return std::nullopt;
  taken_ = std::move(next->bytes);
  const PassedOnFrame frame{next->late, next->hops, taken_};
  waiting_.erase(next);
  return frame;
}

void Relay::forget(Instant now) {
  neighbours.forget_silent(now);
  while (!kept_.empty() && now - kept_.front().heard_at > kKeptFor) kept_.pop_front();
}

}  // namespace skein::air
