// SPDX-License-Identifier: Apache-2.0
#include "in_flight.hpp"

#include <algorithm>
#include <utility>

namespace skein::hil {

void InFlight::post(Parcel parcel) {
  parcel.order = order_++;
  const Slot slot = slot_of(parcel.at);
  if (slot <= opened_) {
    urgent_.push(std::move(parcel));
  } else {
    slots_[slot].push_back(std::move(parcel));
  }
}

void InFlight::open_slots(Slot until) {
  opened_ = until;
  due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  while (!slots_.empty() && slots_.begin()->first <= until) {
    auto& parcels = slots_.begin()->second;
    std::move(parcels.begin(), parcels.end(), std::back_inserter(due_));
    slots_.erase(slots_.begin());
  }
  std::sort(due_.begin(), due_.end());
}

std::optional<Parcel> InFlight::pop_due(Instant now) {
  const Slot slot = now.time_since_epoch() / step_;
  if (slot > opened_) open_slots(slot);
  const bool listed = next_ < due_.size();
  if (!urgent_.empty() && (!listed || urgent_.top() < due_[next_])) {
    if (urgent_.top().at > now) return std::nullopt;
    Parcel parcel = urgent_.top();
    urgent_.pop();
    return parcel;
  }
  if (!listed) return std::nullopt;
  return std::move(due_[next_++]);
}

}  // namespace skein::hil
