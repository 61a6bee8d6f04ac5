// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <algorithm>

namespace skein::network {
namespace {

std::int64_t count_of(Instant at) { return at.time_since_epoch().count(); }

}  // namespace

Progress::Receiving::Receiving(Progress& progress, Instant now) {
  for (auto& slot : progress.receiving_since_) {
    std::int64_t free = kNever;
    if (slot.compare_exchange_strong(free, count_of(now), std::memory_order_relaxed)) {
      slot_ = &slot;
      return;
    }
  }
}

Progress::Receiving::~Receiving() {
  if (slot_ != nullptr) slot_->store(kNever, std::memory_order_relaxed);
}

void Progress::written(Instant now) {
  std::int64_t none = kNever;
  unsent_since_.compare_exchange_strong(none, count_of(now), std::memory_order_relaxed);
}

Duration Progress::longest(Instant now) const {
  std::int64_t since = unsent_since_.load(std::memory_order_relaxed);
  for (const auto& slot : receiving_since_) {
    const std::int64_t one = slot.load(std::memory_order_relaxed);
    if (one != kNever && (since == kNever || one < since)) since = one;
  }
  return since == kNever ? Duration{} : std::max(Duration{}, Duration{count_of(now) - since});
}

}  // namespace skein::network
