// SPDX-License-Identifier: Apache-2.0
//
// Any datagram as what another agency's program sends. What is accepted is a place in the mission's
// area, of nobody's vehicle.
#include <cmath>
#include <string_view>

#include "fuzz_input.hpp"
#include "skein/agencies/marker_intake.hpp"

namespace skein::fuzz {
namespace {

void run(std::string_view text) {
  static const MissionOrigin origin = *MissionOrigin::make({59.0, 17.0, 0.0});
  const auto read = agencies::read_marker(text, origin);
  if (!read) {
    SKEIN_ASSERT(!read.error().message.empty());
    return;
  }
  if (!*read) return;
  const mission::Detection& seen = (*read)->detection;
  SKEIN_ASSERT(std::abs(seen.position.x()) <= agencies::kMarkerPlaceMax_m);
  SKEIN_ASSERT(std::abs(seen.position.y()) <= agencies::kMarkerPlaceMax_m);
  SKEIN_ASSERT(seen.vehicle == kGroundStation);
  SKEIN_ASSERT(seen.kind < mission::IncidentKind::count);
  SKEIN_ASSERT(seen.detector.size() <= 100);
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
