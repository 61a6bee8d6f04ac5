// SPDX-License-Identifier: Apache-2.0
//
// Any text as what a detector writes. What is accepted is a place in the mission's area.
#include <cmath>

#include "fuzz_input.hpp"
#include "skein/detectors/detection_text.hpp"

namespace skein::fuzz {
namespace {

void run(std::string_view text) {
  static const MissionOrigin origin = *MissionOrigin::make({59.0, 17.0, 0.0});
  const auto read = detectors::read_detection(text, origin);
  if (!read) {
    SKEIN_ASSERT(!read.error().message.empty());
    return;
  }
  SKEIN_ASSERT(std::abs(read->position.x()) <= detectors::kPlaceMax_m);
  SKEIN_ASSERT(std::abs(read->position.y()) <= detectors::kPlaceMax_m);
  SKEIN_ASSERT(read->confidence >= 0.0 && read->confidence <= 1.0);
  SKEIN_ASSERT(read->kind < mission::IncidentKind::count);
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
