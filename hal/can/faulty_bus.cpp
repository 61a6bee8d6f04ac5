// SPDX-License-Identifier: Apache-2.0
#include "skein/can/faulty_bus.hpp"

#include <algorithm>
#include <utility>

namespace skein::can {
namespace {

/// A pause of the caller must not become a burst that no bus could carry.
constexpr double kBabbleAtOnceMax = 1000;
/// Frames that are read ahead of the reader, so that there is something to change places with.
constexpr std::size_t kReadAhead = 2;

}  // namespace

FaultyBus::FaultyBus(std::unique_ptr<Bus> bus, const Random& random, std::size_t queue_frames)
    : bus_{std::move(bus)}, random_{random}, queue_frames_{queue_frames} {}

void FaultyBus::set(const BusFaults& faults) {
  const bool was_out = is_out();
  if (faults.bus_off && !faults_.bus_off) ++own_.bus_offs;
  faults_ = faults;
  if (was_out && !is_out()) ++own_.restarts;
  if (is_out()) {
    own_.discarded += outgoing_.size();
    outgoing_.clear();
    incoming_.clear();
  }
}

void FaultyBus::babble(Instant now) {
  const double passed_s = babbled_until_ ? to_seconds(now - *babbled_until_) : 0.0;
  if (is_out() || faults_.babble_hz <= 0) {
    babbled_until_ = now;
    return;
  }
  if (!babbled_until_) babbled_until_ = now;
  const double due = passed_s * faults_.babble_hz;
  const auto count = static_cast<std::size_t>(due < kBabbleAtOnceMax ? due : kBabbleAtOnceMax);
  if (count == 0) return;
  babbled_until_ =
      due < kBabbleAtOnceMax
          ? *babbled_until_ + from_seconds(static_cast<double>(count) / faults_.babble_hz)
          : now;
  for (std::size_t i = 0; i < count; ++i) {
    Frame frame;
    frame.extended = true;
    frame.size = kClassicDataMax;
    for (std::size_t byte = 0; byte < kClassicDataMax; ++byte) {
      frame.data[byte] = static_cast<std::uint8_t>(random_.next());
    }
    (void)bus_->send(frame);
  }
}

void FaultyBus::swap_last(std::deque<Frame>& frames) {
  if (frames.size() >= 2) std::swap(frames[frames.size() - 1], frames[frames.size() - 2]);
}

void FaultyBus::append(std::deque<Frame>& to, const Frame& frame) {
  if (random_.chance(faults_.loss)) {
    ++lost_by_intent_;
    return;
  }
  to.push_back(frame);
  if (random_.chance(faults_.duplication)) to.push_back(frame);
  if (random_.chance(faults_.reorder)) swap_last(to);
}

bool FaultyBus::send(std::span<const Frame> frames) {
  flush();
  if (is_out() || frames.size() > queue_frames_ - std::min(outgoing_.size(), queue_frames_)) {
    own_.refused += frames.size();
    return false;
  }
  for (const Frame& frame : frames) append(outgoing_, frame);
  flush();
  return true;
}

void FaultyBus::flush() {
  bus_->flush();
  while (!outgoing_.empty() && !random_.chance(faults_.load)) {
    if (!bus_->send(outgoing_.front())) return;
    outgoing_.pop_front();
  }
}

void FaultyBus::discard() {
  own_.discarded += outgoing_.size();
  outgoing_.clear();
  bus_->discard();
}

std::optional<Frame> FaultyBus::receive() {
  if (is_out()) {
    while (bus_->receive()) {
    }
    return std::nullopt;
  }
  while (incoming_.size() < kReadAhead) {
    const auto frame = bus_->receive();
    if (!frame) break;
    append(incoming_, *frame);
  }
  if (incoming_.empty()) return std::nullopt;
  const Frame frame = incoming_.front();
  incoming_.pop_front();
  return frame;
}

State FaultyBus::state() const {
  if (faults_.unplugged) return State::gone;
  return faults_.bus_off ? State::bus_off : bus_->state();
}

const Statistics& FaultyBus::statistics() const {
  sum_ = bus_->statistics();
  sum_.refused += own_.refused;
  sum_.discarded += own_.discarded;
  sum_.bus_offs += own_.bus_offs;
  sum_.restarts += own_.restarts;
  return sum_;
}

}  // namespace skein::can
