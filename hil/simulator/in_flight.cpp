// SPDX-License-Identifier: Apache-2.0
#include "in_flight.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace skein::hil {

void InFlight::post(Parcel parcel) {
  parcel.order = order_++;
  const Slot slot = slot_of(parcel.at);
  if (slot <= opened_) {
    urgent_.push(std::move(parcel));
    return;
  }
  const auto ahead = static_cast<std::size_t>(slot - opened_ - 1);
  if (ahead >= slots_.size()) slots_.resize(ahead + 1);
  auto& parcels = slots_[ahead];
  if (parcels.capacity() == 0 && !spare_.empty()) {
    parcels = std::move(spare_.back());
    spare_.pop_back();
  }
  parcels.push_back(std::move(parcel));
}

void InFlight::open_slots(Slot until) {
  due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  for (; opened_ < until && !slots_.empty(); ++opened_) {
    auto& parcels = slots_.front();
    if (due_.empty()) due_.swap(parcels);
    std::move(parcels.begin(), parcels.end(), std::back_inserter(due_));
    parcels.clear();
    if (parcels.capacity() > 0) spare_.push_back(std::move(parcels));
    slots_.pop_front();
  }
  opened_ = until;
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
