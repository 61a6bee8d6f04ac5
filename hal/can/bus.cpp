// SPDX-License-Identifier: Apache-2.0
#include "skein/can/bus.hpp"

#include <charconv>

#include "mcast_bus.hpp"
#include "skein/base/assert.hpp"
#include "socketcan_bus.hpp"

namespace skein::can {
namespace {

constexpr std::size_t kInterfaceMax = 15;  // IFNAMSIZ with its zero is 16

}  // namespace

Result<std::unique_ptr<Bus>> open(const std::string& name, const BusOptions& options) {
  SKEIN_ASSERT(options.queue_frames > 0);
  if (name.starts_with(kMcast)) {
    const std::size_t at = name.find('@');
    const std::string_view number = std::string_view{name}.substr(
        kMcast.size(), at == std::string::npos ? at : at - kMcast.size());
    const std::string interface = interface_in(name);
    std::uint8_t index = 0;
    const auto [end, failed] = std::from_chars(number.data(), number.data() + number.size(), index);
    if (failed != std::errc{} || end != number.data() + number.size() || interface.empty()) {
      return Error{"'" + name +
                   "': a multicast bus is 'mcast:NUMBER' with a number from 0 to 255, "
                   "or 'mcast:NUMBER@INTERFACE'"};
    }
    return open_mcast(name, index, interface, options);
  }
  if (name.empty() || name.size() > kInterfaceMax ||
      name.find_first_of(" /:@") != std::string::npos) {
    return Error{"'" + name +
                 "' names no bus: an interface such as 'can0' or 'vcan0', or 'mcast:0'"};
  }
  return open_socketcan(name, options);
}

}  // namespace skein::can
