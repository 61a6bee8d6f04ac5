// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

namespace skein::hil {

/// What was done to a node's program for a while, on purpose.
struct ProgramSpan {
  enum class Kind : std::uint8_t {
    down,  ///< killed, and started anew at `until`
    gone,  ///< killed for good
    still,
    slow,
    disk_full
  };
  VehicleId node;
  Kind kind = Kind::down;
  Instant from{};
  std::optional<Instant> until;  ///< nothing: to the end of the run
};
using ProgramSpans = std::vector<ProgramSpan>;

}  // namespace skein::hil
