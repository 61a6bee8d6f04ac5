// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

/// What a shared library must export to stand between a node and the air.
namespace skein::network {

class AirRadio {
 public:
  AirRadio() = default;
  AirRadio(const AirRadio&) = delete;
  AirRadio& operator=(const AirRadio&) = delete;
  virtual ~AirRadio() = default;
  /// When a datagram of that many bytes that is just being received arrives: none where it is lost,
  /// several where it is doubled.
  [[nodiscard]] virtual std::vector<Duration> arrivals(VehicleId sender, std::size_t bytes) = 0;
};

/// The caller's to delete; null where it cannot be had, and then `reason` is a sentence that says
/// why not, and stays valid.
using OpenAirRadio = AirRadio* (*)(std::uint16_t self, const char** reason);
inline constexpr const char* kOpenAirRadioSymbol = "skein_open_air_radio";

}  // namespace skein::network
