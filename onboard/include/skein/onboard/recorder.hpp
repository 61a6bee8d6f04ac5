// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>

#include "skein/onboard/agent_loop.hpp"
#include "skein/onboard/control_loop.hpp"
#include "skein/onboard/load_book.hpp"
#include "skein/process/wake.hpp"
#include "skein/recording/writer.hpp"

namespace skein::onboard {

/// Writes what control and agent leave in their rings, in a thread of its own: run() is that
/// thread. Without a writer it only empties the rings. A disk error is logged once; the flight goes
/// on.
class Recorder {
 public:
  /// The rings must outlive this object. In the book it notes each load as it is used: when its
  /// approach begins.
  Recorder(std::optional<recording::Writer> writer, ControlPorts& control, EventRing& events,
           AgentRing& agent, LoadBook loads);

  /// Works until stop(), then writes what is left. Flushes every second.
  void run();
  void stop();

 private:
  void empty_rings();
  void flush();
  void note_load(const mission::MissionEvent& event);

  std::optional<recording::Writer> writer_;
  ControlPorts* control_;
  EventRing* events_;
  AgentRing* agent_;
  LoadBook loads_;
  std::uint64_t lost_ = 0;  ///< as far as the recording says
  process::Wake wake_;
  std::atomic<bool> stopping_{false};
};

}  // namespace skein::onboard
