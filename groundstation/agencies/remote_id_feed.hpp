// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "skein/agencies/shown.hpp"
#include "skein/base/time.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::agencies {

/// What that vehicle says of itself by Remote ID: nothing where it has no id. `unix_ns` is `now` by
/// the clock that others have. Of those that are shown and have one the group is made.
void say_remote_id(mavlink::Encoder& encoder, const Shown& shown, const ShownVehicle& vehicle,
                   const Wgs84& take_off, Instant now, std::int64_t unix_ns,
                   std::vector<mavlink::WireBytes>& due);

}  // namespace skein::agencies
