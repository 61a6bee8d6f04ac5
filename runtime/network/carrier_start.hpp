// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"

namespace skein::network {

/// By which run_carrier() knows that it is one.
inline constexpr const char* kCarrierArgument = "--carry-network";
/// Where a carrier's process has its end of the socket.
inline constexpr int kCarrierDescriptor = 3;

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_{number} {}
  Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { reset(); }
  void reset();
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

/// A carrier's process as its parent has it. Whoever starts it must go on: the process ends with
/// the thread.
class CarrierChild {
 public:
  /// This program again, with nothing of this process but the environment and its end of a socket.
  [[nodiscard]] static Result<CarrierChild> start(VehicleId self);
  CarrierChild(CarrierChild&&) = default;
  CarrierChild& operator=(CarrierChild&&) = delete;
  ~CarrierChild();

  [[nodiscard]] int socket() const { return socket_.get(); }
  [[nodiscard]] int ended() const { return ended_.get(); }  ///< becomes readable when it has
  /// Ends it, if it has not, and gives how it ended: "signal 11 (Segmentation fault)".
  std::string end();
  /// Lets it take its leave of the network, at most so long.
  void end_in_order(int milliseconds);

 private:
  CarrierChild(pid_t pid, Descriptor socket, Descriptor ended)
      : pid_{pid}, socket_{std::move(socket)}, ended_{std::move(ended)} {}
  struct Pid {
    explicit Pid(pid_t number) : value{number} {}
    Pid(Pid&& other) noexcept : value{std::exchange(other.value, -1)} {}
    pid_t value;
  };
  Pid pid_;
  Descriptor socket_;
  Descriptor ended_;
};

}  // namespace skein::network
