// SPDX-License-Identifier: Apache-2.0
#include "vehicle.hpp"

namespace skein::hil {

std::optional<double> down_of(double altitude_m, std::uint8_t frame, const Earth& earth,
                              const Vec3& home_m) {
  switch (static_cast<mavlink::Frame>(frame)) {
    case mavlink::Frame::global:
    case mavlink::Frame::global_int:
      return earth.origin_height_m() - altitude_m;
    case mavlink::Frame::global_relative_alt:
    case mavlink::Frame::global_relative_alt_int:
      return home_m.z() - altitude_m;
    default:
      return std::nullopt;
  }
}

}  // namespace skein::hil
