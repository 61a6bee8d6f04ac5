// SPDX-License-Identifier: Apache-2.0
//
// A radio for tests: each node hears those alone whose ids are next to its own.
#include <type_traits>

#include "skein/network/air_radio.hpp"

namespace skein::network {
namespace {

class ChainRadio final : public AirRadio {
 public:
  explicit ChainRadio(VehicleId self) : self_{self} {}
  std::vector<Duration> arrivals(VehicleId sender, std::size_t /*bytes*/) override {
    const int apart = int{sender.value} - int{self_.value};
    if (apart < -1 || apart > 1) return {};
    return {Duration{}};
  }

 private:
  VehicleId self_;
};

}  // namespace
}  // namespace skein::network

extern "C" __attribute__((visibility("default"))) skein::network::AirRadio* skein_open_air_radio(
    std::uint16_t self, const char** /*reason*/) {
  return new skein::network::ChainRadio{skein::VehicleId{self}};
}
static_assert(std::is_same_v<decltype(&skein_open_air_radio), skein::network::OpenAirRadio>);
