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
  if (slot <= opened_) return post({at, 0, to, from, 0, what, true});
  Step& step = step_of(slot);
  if (step.said.empty() || step.said.back().what != what) step.said.push_back({from, what});
  step.wakes.push_back({place_in(step, at, order_++), static_cast<std::uint32_t>(to),
                        static_cast<std::uint32_t>(step.said.size() - 1)});
}

void InFlight::on_moved(const Parcel& by) {
  if (by.to >= waking_.size() || by.at < open_.from || by.order < open_.order) return;
  Waking& waking = waking_[by.to];
  const Place now = place_in(open_, by.at, by.order);
  if (waking.begin == waking.end || waking.next > now) return;  // one is to come
  Place next = std::numeric_limits<Place>::max();
  for (std::uint32_t i = waking.begin; i < waking.end; ++i) {
    if (wakes_[i].place > now) next = std::min(next, wakes_[i].place);
  }
  if (next == std::numeric_limits<Place>::max()) return;
  waking.next = next;
  urgent_.push(wake_of(by.to));
}

InFlight::Place InFlight::place_in(const Step& step, Instant at, std::uint64_t order) {
  constexpr unsigned kOrderBits = 32;
  return static_cast<Place>((at - step.from).count()) << kOrderBits | (order - step.order);
}

/// The first that was posted stands for all.
Parcel InFlight::wake_of(std::size_t to) const {
  constexpr Place kOrder = 0xFFFFFFFF;
  const Waking& waking = waking_[to];
  const Said& said = open_.said[wakes_[waking.begin].said];
  const Duration after{static_cast<Duration::rep>(waking.next / (kOrder + 1))};
  return {
      open_.from + after, open_.order + (waking.next & kOrder), to, said.from, 0, said.what, true};
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
    std::swap(open_, step);
    open_wakes();
    step.parcels.clear();
    step.wakes.clear();
    step.said.clear();
    spare_.push_back(std::move(step));
    slots_.pop_front();
  }
  opened_ = until;
  std::sort(due_.begin(), due_.end());
}

/// Sorts them by node, by counting: they are many.
void InFlight::open_wakes() {
  for (Waking& waking : waking_) waking = {};
  for (const Wake& wake : open_.wakes) {
    if (waking_.size() <= wake.to) waking_.resize(wake.to + std::size_t{1});
    ++waking_[wake.to].end;
  }
  std::uint32_t begin = 0;
  for (Waking& waking : waking_) {
    const std::uint32_t count = waking.end;
    waking = {begin, begin, std::numeric_limits<Place>::max()};
    begin += count;
  }
  wakes_.resize(open_.wakes.size());
  for (const Wake& wake : open_.wakes) {
    Waking& waking = waking_[wake.to];
    wakes_[waking.end++] = wake;
    waking.next = std::min(waking.next, wake.place);
  }
  for (std::size_t to = 0; to < waking_.size(); ++to) {
    if (waking_[to].begin != waking_[to].end) due_.push_back(wake_of(to));
  }
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
