// SPDX-License-Identifier: Apache-2.0
#include "queued_bus.hpp"

#include <array>

#include "skein/base/assert.hpp"

namespace skein::can {

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 4> kNames{"error-active", "error-passive", "bus-off",
                                                   "gone"};
  return kNames.at(static_cast<std::size_t>(state));
}

bool QueuedBus::send(std::span<const Frame> frames) {
  flush();
  const bool can_send = state_ == State::error_active || state_ == State::error_passive;
  if (!can_send || frames.size() > queue_.size() - count_) {
    statistics_.refused += frames.size();
    return false;
  }
  for (const Frame& frame : frames) {
    SKEIN_ASSERT(is_valid(frame) && (fd() || !frame.fd));
    queue_[(first_ + count_) % queue_.size()] = frame;
    ++count_;
  }
  flush();
  return true;
}

void QueuedBus::flush() {
  if (state_ == State::gone) look_for_interface();
  while (count_ > 0) {
    switch (write(queue_[first_])) {
      case Written::done:
        first_ = (first_ + 1) % queue_.size();
        --count_;
        ++statistics_.sent;
        break;
      case Written::no_room:
        ++statistics_.retries;
        return;
      case Written::gone:
        enter(State::gone);
        return;
    }
  }
}

std::optional<Frame> QueuedBus::receive() {
  // Read while it is gone too: an error or a frame that is left makes the descriptor ready for
  // ever.
  if (state_ == State::gone) look_for_interface();
  auto frame = read();
  if (frame) {
    ++statistics_.received;
    if (frame->error) ++statistics_.error_frames;
  }
  return frame;
}

void QueuedBus::enter(State state) {
  if (state == state_) return;
  const bool was_out = state_ == State::bus_off || state_ == State::gone;
  const bool is_out = state == State::bus_off || state == State::gone;
  if (state == State::bus_off) ++statistics_.bus_offs;
  if (was_out && !is_out) ++statistics_.restarts;
  state_ = state;
  // What waited is old when the bus is back, and a receiver drops the transfer that was cut.
  if (is_out) discard();
}

void QueuedBus::discard() {
  statistics_.discarded += count_;
  first_ = 0;
  count_ = 0;
}

void QueuedBus::look_for_interface() {
  const auto now = std::chrono::steady_clock::now();
  if (now < look_at_) return;
  look_at_ = now + kLookAgain;
  if (reattach()) enter(State::error_active);
}

}  // namespace skein::can
