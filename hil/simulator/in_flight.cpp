// SPDX-License-Identifier: Apache-2.0
#include "in_flight.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace skein::hil {

void InFlight::post(Parcel parcel) {
  const Slot slot = slot_of(parcel.at);
  Step* const step = slot > opened_ ? &step_of(slot) : nullptr;  // before: its order begins here
  parcel.order = order_++;
  if (step == nullptr) {
    urgent_.push(std::move(parcel));
  } else {
    step->parcels.push_back(std::move(parcel));
  }
}

void InFlight::post_wake(Instant at, std::size_t to, VehicleId from,
                         const std::shared_ptr<const Content>& what) {
  const Slot slot = slot_of(at);
  if (slot <= opened_) return post({at, 0, to, from, 0, what});
  Step& step = step_of(slot);
  if (step.wakes.size() <= to) step.wakes.resize(to + 1);
  Wakes& wakes = step.wakes[to];
  const Place place = place_in(step, at, order_++);
  if (wakes.all.empty()) {
    wakes.from = from;
    wakes.what = what;
  }
  if (wakes.all.empty() || place < wakes.next) wakes.next = place;
  wakes.all.push_back(place);
}

void InFlight::on_moved(const Parcel& by) {
  if (by.to >= open_.wakes.size() || by.at < open_.from || by.order < open_.order) return;
  Wakes& wakes = open_.wakes[by.to];
  const Place now = place_in(open_, by.at, by.order);
  if (wakes.all.empty() || wakes.next > now) return;  // one is to come
  Place next = std::numeric_limits<Place>::max();
  for (const Place place : wakes.all) {
    if (place > now) next = std::min(next, place);
  }
  if (next == std::numeric_limits<Place>::max()) return;
  wakes.next = next;
  urgent_.push(wake_of(open_, by.to));
}

InFlight::Place InFlight::place_in(const Step& step, Instant at, std::uint64_t order) {
  constexpr unsigned kOrderBits = 32;
  return static_cast<Place>((at - step.from).count()) << kOrderBits | (order - step.order);
}

Parcel InFlight::wake_of(const Step& step, std::size_t to) {
  constexpr Place kOrder = 0xFFFFFFFF;
  const Wakes& wakes = step.wakes[to];
  const Duration after{static_cast<Duration::rep>(wakes.next / (kOrder + 1))};
  return {step.from + after, step.order + (wakes.next & kOrder), to, wakes.from, 0, wakes.what};
}

InFlight::Step& InFlight::step_of(Slot slot) {
  const auto ahead = static_cast<std::size_t>(slot - opened_ - 1);
  while (slots_.size() <= ahead) {
    Step step;
    if (!spare_.empty()) {
      step = std::move(spare_.back());
      spare_.pop_back();
    }
    step.from = Instant{(opened_ + static_cast<Slot>(slots_.size())) * kStep};
    step.order = order_;
    slots_.push_back(std::move(step));
  }
  return slots_[ahead];
}

void InFlight::open_slots(Slot until) {
  due_.erase(due_.begin(), due_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  for (; opened_ < until && !slots_.empty(); ++opened_) {
    Step& step = slots_.front();
    if (due_.empty()) due_.swap(step.parcels);
    std::move(step.parcels.begin(), step.parcels.end(), std::back_inserter(due_));
    for (std::size_t to = 0; to < step.wakes.size(); ++to) {
      if (!step.wakes[to].all.empty()) due_.push_back(wake_of(step, to));
    }
    std::swap(open_, step);
    step.parcels.clear();
    for (Wakes& wakes : step.wakes) wakes.all.clear();
    spare_.push_back(std::move(step));
    slots_.pop_front();
  }
  opened_ = until;
  std::sort(due_.begin(), due_.end());
}

std::optional<Parcel> InFlight::pop_due(Instant now) {
  const Slot slot = now.time_since_epoch() / kStep;
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
