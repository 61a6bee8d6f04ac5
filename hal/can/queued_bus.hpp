// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "skein/can/bus.hpp"

namespace skein::can {

/// The part of a Bus that does not depend on its socket: frames kept in order until the kernel
/// takes them, states, and looking now and then whether an interface that went away is back.
class QueuedBus : public Bus {
 public:
  using Bus::send;
  [[nodiscard]] bool send(std::span<const Frame> frames) final;
  void flush() final;
  [[nodiscard]] std::size_t pending() const final { return count_; }
  void discard() final;
  [[nodiscard]] std::optional<Frame> receive() final;
  [[nodiscard]] State state() const final { return state_; }
  [[nodiscard]] const Statistics& statistics() const final { return statistics_; }
  [[nodiscard]] const std::string& name() const final { return name_; }

 protected:
  enum class Written : std::uint8_t { done, no_room, gone };

  QueuedBus(std::string name, std::size_t capacity) : name_{std::move(name)}, queue_(capacity) {}

  /// Hands a frame to the kernel.
  virtual Written write(const Frame& frame) = 0;
  /// The next frame from the kernel. Reports what it learns with enter() and count().
  virtual std::optional<Frame> read() = 0;
  /// Whether the interface is there and up; makes the socket fit to use it again.
  virtual bool reattach() = 0;

  void enter(State state);
  [[nodiscard]] Statistics& count() { return statistics_; }

 private:
  /// An interface that is gone is looked for this often.
  static constexpr std::chrono::milliseconds kLookAgain{20};

  void look_for_interface();

  std::string name_;
  std::vector<Frame> queue_;  ///< a ring
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  State state_ = State::error_active;
  Statistics statistics_;
  std::chrono::steady_clock::time_point look_at_;
};

}  // namespace skein::can
