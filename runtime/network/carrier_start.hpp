// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/system/descriptor.hpp"

namespace skein::network {

/// By which run_carrier() knows that it is one.
inline constexpr const char* kCarrierArgument = "--carry-network";
/// Where a carrier's process has its end of the socket.
inline constexpr int kCarrierDescriptor = 3;

/// A carrier's process as its parent has it. Whoever starts it must go on: the process ends with
/// the thread.
class CarrierChild {
 public:
  /// This program again, with nothing of this process but the environment and its end of a socket.
  [[nodiscard]] static Result<CarrierChild> start(VehicleId self);
  CarrierChild(CarrierChild&& other) noexcept
      : pid_{std::exchange(other.pid_, -1)},
        socket_{std::move(other.socket_)},
        ended_{std::move(other.ended_)} {}
  CarrierChild& operator=(CarrierChild&&) = delete;
  CarrierChild(const CarrierChild&) = delete;
  CarrierChild& operator=(const CarrierChild&) = delete;
  ~CarrierChild();

  [[nodiscard]] int socket() const { return socket_.get(); }
  [[nodiscard]] int ended() const { return ended_.get(); }  ///< becomes readable when it has
  /// Processor time that it has taken.
  [[nodiscard]] std::chrono::nanoseconds computed() const;
  /// Whether a thread of it computes or is ready to; nothing where processes are hidden from each
  /// other.
  [[nodiscard]] std::optional<bool> is_ready() const;
  /// Ends it, if it has not, and gives how it ended: "signal 11 (Segmentation fault)".
  std::string end();
  /// Lets it take its leave of the network, at most so long.
  void end_in_order(int milliseconds);

 private:
  CarrierChild(pid_t pid, system::Descriptor socket, system::Descriptor ended)
      : pid_{pid}, socket_{std::move(socket)}, ended_{std::move(ended)} {}
  pid_t pid_;
  system::Descriptor socket_;
  system::Descriptor ended_;
};

}  // namespace skein::network
