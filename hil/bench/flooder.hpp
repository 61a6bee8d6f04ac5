// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil {

/// Says noise in a vehicle's name, as a broken program or radio of it would: what looks like a
/// sealed datagram, until it is opened.
class Flooder {
 public:
  /// Does a fault of the scenario flood?
  [[nodiscard]] static bool is_wanted(const configuration::Scenario& scenario);
  /// To that group of the air, from that address of this machine.
  [[nodiscard]] static Result<Flooder> open(const std::string& group, std::uint16_t port,
                                            const std::string& address);
  ~Flooder();
  Flooder(Flooder&& other) noexcept;
  Flooder& operator=(Flooder&&) = delete;
  Flooder(const Flooder&) = delete;
  Flooder& operator=(const Flooder&) = delete;

  /// What is said of that flood in so long.
  void say(const radio::Flood& flood, std::chrono::duration<double> time);

 private:
  explicit Flooder(int socket) : socket_{socket} {}
  int socket_;
  Random random_{1};
};

}  // namespace skein::hil
