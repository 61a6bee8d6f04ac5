// SPDX-License-Identifier: Apache-2.0
#include "introductions.hpp"

#include <algorithm>
#include <chrono>

#include "relay.hpp"

namespace skein::air {
namespace {

constexpr Duration kWantedFor = std::chrono::seconds{5};

}  // namespace

void Introductions::asked(const Author& of, VehicleId by, bool is_known, Instant now,
                          Random& random) {
  const auto same = [&](const Asked& asked) { return asked.of == of && asked.by == by; };
  if (std::ranges::any_of(asked_, same)) return;
  if (asked_.size() == kMax) asked_.pop_front();
  asked_.push_back(
      {of, by, now, is_known ? std::optional{now + Relay::wait(random)} : std::nullopt});
}

void Introductions::known(const Author& author, Instant now, Random& random) {
  for (Asked& asked : asked_) {
    if (asked.of == author && !asked.at) asked.at = now + Relay::wait(random);
  }
}

void Introductions::told(const Author& author, VehicleId teller, const Neighbours& neighbours) {
  std::erase_if(asked_, [&](const Asked& asked) {
    return asked.of == author && (asked.by == teller || neighbours.hears(asked.by, teller));
  });
}

std::optional<Instant> Introductions::due() const {
  std::optional<Instant> due;
  for (const Asked& asked : asked_) {
    if (asked.at) due = std::min(due.value_or(*asked.at), *asked.at);
  }
  return due;
}

std::optional<Author> Introductions::next(Instant now) const {
  const auto next = std::ranges::find_if(
      asked_, [now](const Asked& asked) { return asked.at && *asked.at <= now; });
  return next != asked_.end() ? std::optional{next->of} : std::nullopt;
}

void Introductions::done(const Author& author) {
  std::erase_if(asked_, [&](const Asked& asked) { return asked.of == author; });
}

void Introductions::forget(Instant now) {
  while (!asked_.empty() && now - asked_.front().since > kWantedFor) asked_.pop_front();
}

}  // namespace skein::air
