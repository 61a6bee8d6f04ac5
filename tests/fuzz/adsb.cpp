// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as what a receiver of ADS-B says: by lines, and as its file. What is taken is an
// aircraft in the mission's area, at a height and a speed that there are.
#include <cmath>
#include <string_view>

#include "fuzz_input.hpp"
#include "skein/agencies/adsb_intake.hpp"

namespace skein::fuzz {
namespace {

void check(const mission::SeenAircraft& seen) {
  const mission::Aircraft& aircraft = seen.aircraft;
  SKEIN_ASSERT(aircraft.address > 0 && aircraft.address <= 0xFFFFFF);
  SKEIN_ASSERT(std::abs(aircraft.position.x()) <= agencies::kAircraftPlaceMax_m);
  SKEIN_ASSERT(std::abs(aircraft.position.y()) <= agencies::kAircraftPlaceMax_m);
  SKEIN_ASSERT(std::abs(aircraft.height_m) < 30'000.0);
  SKEIN_ASSERT(std::hypot(aircraft.east_mps, aircraft.north_mps) < 800.0);
  SKEIN_ASSERT(std::abs(aircraft.climb_mps) < 110.0);
  SKEIN_ASSERT(seen.callsign.size() <= 8);
}

void run(std::string_view text) {
  static const MissionOrigin origin = *MissionOrigin::make({59.0, 17.0, 0.0});
  agencies::AdsbIntake intake{origin, {}};
  for (const auto& seen : intake.take_json(text, 1000.0, at_seconds(1.0))) check(seen);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto seen = intake.take_sbs(text.substr(0, end), at_seconds(1.0))) check(*seen);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
