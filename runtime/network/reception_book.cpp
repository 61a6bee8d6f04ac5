// SPDX-License-Identifier: Apache-2.0
#include "reception_book.hpp"

#include <algorithm>
#include <limits>

namespace skein::network {
namespace {

std::int64_t second_of(Instant now) {
  return std::chrono::floor<std::chrono::seconds>(now.time_since_epoch()).count();
}

}  // namespace

void ReceptionBook::came(const Stream& stream, std::uint64_t number, std::size_t bytes,
                         Instant now) {
  note(stream, number, true, bytes, now);
}

void ReceptionBook::was_sent(const Stream& stream, std::uint64_t number, Instant now) {
  note(stream, number, false, 0, now);
}

ReceptionBook::Slot& ReceptionBook::slot_of(Sender& sender, Instant now) {
  const std::int64_t second = second_of(now);
  Slot& slot = sender.slots.at(static_cast<std::size_t>((second % kSlots + kSlots) % kSlots));
  if (slot.second != second) slot = {.second = second};
  return slot;
}

void ReceptionBook::note(const Stream& stream, std::uint64_t number, bool itself, std::size_t bytes,
                         Instant now) {
  const std::lock_guard lock{mutex_};
  if (senders_.size() >= kSendersMax && !senders_.contains(stream.sender)) forget(now);
  if (senders_.size() >= kSendersMax && !senders_.contains(stream.sender)) return;
  Sender& sender = senders_[stream.sender];
  const std::pair key{stream.instance, stream.channel};
  if (sender.streams.size() >= kStreamsMax && !sender.streams.contains(key)) sender.streams.clear();
  const auto [at, is_new] = sender.streams.try_emplace(key);
  Numbers& numbers = at->second;
  Slot& slot = slot_of(sender, now);
  const bool leaps = !is_new && number > numbers.newest && number - numbers.newest > kLeapMax;
  if (is_new || leaps) {
    if (!itself) ++slot.missed;
    numbers.newest = number;
  } else if (number > numbers.newest) {
    slot.missed += static_cast<std::int32_t>(number - numbers.newest) - (itself ? 1 : 0);
    numbers.newest = number;
  } else if (itself && numbers.came.is_new(number)) {
    --slot.missed;
  }
  if (!itself || !numbers.came.is_new(number)) return;
  numbers.came.note(number);
  ++slot.came;
  slot.bytes += bytes;
}

Reception ReceptionBook::reception_of(VehicleId id, const Sender& sender, Instant now) {
  const std::int64_t second = second_of(now);
  std::int64_t came = 0;
  std::int64_t missed = 0;
  std::uint64_t bytes = 0;
  for (const Slot& slot : sender.slots) {
    if (slot.second <= second - kSlots || slot.second > second) continue;
    came += slot.came;
    missed += slot.missed;
    bytes += slot.bytes;
  }
  missed = std::max<std::int64_t>(0, missed);
  Reception reception{.sender = id};
  const auto fit = [](auto value, auto as) {
    using To = decltype(as);
    constexpr auto kMost = std::numeric_limits<To>::max();
    return static_cast<To>(std::min<std::uint64_t>(kMost, static_cast<std::uint64_t>(value)));
  };
  reception.datagrams = fit(came, std::uint16_t{});
  reception.bytes = fit(bytes, std::uint32_t{});
  if (came + missed > 0) {
    reception.lost_percent =
        static_cast<std::uint8_t>((100 * missed + (came + missed) / 2) / (came + missed));
  }
  return reception;
}

std::vector<Reception> ReceptionBook::all(Instant now) const {
  std::vector<Reception> all;
  const std::lock_guard lock{mutex_};
  for (const auto& [id, sender] : senders_) {
    const Reception reception = reception_of(id, sender, now);
    if (reception.lost_percent <= 100) all.push_back(reception);
  }
  return all;
}

void ReceptionBook::forget(Instant now) {
  if (now < next_forget_) return;
  next_forget_ = now + std::chrono::seconds{1};
  std::erase_if(senders_, [now](const auto& entry) {
    return reception_of(entry.first, entry.second, now).lost_percent > 100;
  });
}

}  // namespace skein::network
