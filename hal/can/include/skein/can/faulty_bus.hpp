// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "skein/base/random.hpp"
#include "skein/base/time.hpp"
#include "skein/can/bus.hpp"

namespace skein::can {

/// What goes wrong on a bus. Probabilities are of a frame, each way.
struct BusFaults {
  double loss = 0;
  double duplication = 0;
  /// That a frame and the one behind it change places, where there is one.
  double reorder = 0;
  /// Share of the bus that others take with higher priority, 0..1: so likely is it that what waits
  /// to be sent goes on waiting at a flush(). At 1 nothing is ever sent.
  double load = 0;
  /// Frames a second that this node babbles: extended id 0, before which every other waits, and
  /// random data. Sent at babble().
  double babble_hz = 0;
  bool bus_off = false;
  bool unplugged = false;
};

/// A bus on which things go wrong as they are told to, the same for the same seed. It is a bus for
/// tests and the bench: it may allocate.
class FaultyBus final : public Bus {
 public:
  FaultyBus(std::unique_ptr<Bus> bus, const Random& random, std::size_t queue_frames = 1024);

  using Bus::send;
  void set(const BusFaults& faults);
  [[nodiscard]] const BusFaults& faults() const { return faults_; }
  /// Sends what is to be babbled by `now`. Precondition: `now` never decreases.
  void babble(Instant now);

  [[nodiscard]] bool send(std::span<const Frame> frames) override;
  void flush() override;
  [[nodiscard]] std::size_t pending() const override { return outgoing_.size() + bus_->pending(); }
  void discard() override;
  [[nodiscard]] std::optional<Frame> receive() override;
  [[nodiscard]] int descriptor() const override { return bus_->descriptor(); }
  [[nodiscard]] Result<void> set_filters(std::span<const Filter> filters) override {
    return bus_->set_filters(filters);
  }
  /// That of the fault, or of the bus below.
  [[nodiscard]] State state() const override;
  /// Those of the bus below, and on top of them what was refused and discarded here; bus_offs and
  /// restarts are those of the faults.
  [[nodiscard]] const Statistics& statistics() const override;
  [[nodiscard]] const std::string& name() const override { return bus_->name(); }
  [[nodiscard]] bool fd() const override { return bus_->fd(); }
  /// Frames that were lost by intent, both ways.
  [[nodiscard]] std::uint64_t lost_by_intent() const { return lost_by_intent_; }

 private:
  [[nodiscard]] bool is_out() const { return faults_.bus_off || faults_.unplugged; }
  /// A frame with what goes wrong with it, to the end of `to`.
  void append(std::deque<Frame>& to, const Frame& frame);
  static void swap_last(std::deque<Frame>& frames);

  std::unique_ptr<Bus> bus_;
  Random random_;
  std::size_t queue_frames_;
  BusFaults faults_;
  std::deque<Frame> outgoing_;
  std::deque<Frame> incoming_;
  std::optional<Instant> babbled_until_;
  std::uint64_t lost_by_intent_ = 0;
  Statistics own_;
  mutable Statistics sum_;
};

}  // namespace skein::can
