// SPDX-License-Identifier: Apache-2.0
//
// Any messages of an autopilot, with checksums that hold, at any times. However it lies, nothing is
// armed where that was not asked for, no state is later than now, and the table has every event.
#include "skein/ardupilot/companion.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "fuzz_input.hpp"
#include "skein/base/frames.hpp"

namespace skein::fuzz {
namespace {

using ardupilot::Companion;

/// What a companion listens to.
constexpr std::array<std::uint32_t, 10> kIds{0, 1, 30, 33, 74, 77, 111, 148, 245, 253};

void drain(Companion& companion, mavlink::Parser& parser, bool may_arm) {
  while (const auto bytes = companion.poll_packet()) {
    parser.parse(*bytes, [may_arm](const mavlink::Packet& packet) {
      const auto command = mavlink::decode<mavlink::CommandLong>(packet);
      if (!command) return;
      const auto kind = static_cast<mavlink::Command>(command->command);
      SKEIN_ASSERT(kind != mavlink::Command::component_arm_disarm || may_arm);
    });
  }
  while (companion.poll_notice()) continue;
}

void run(Input input) {
  const std::uint8_t flags = input.byte();
  ardupilot::CompanionParams params;
  params.vehicle.speed_min_mps = 40.0;
  params.vehicle.speed_max_mps = 60.0;
  params.vehicle.turn_radius_m = 150.0;
  constexpr auto kAirframes = static_cast<unsigned>(Airframe::count);
  params.vehicle.airframe = static_cast<Airframe>(flags % kAirframes);
  params.take_over = static_cast<ardupilot::TakeOver>(flags / kAirframes % 3U);
  const bool may_arm = params.take_over == ardupilot::TakeOver::from_ground;
  Instant now{std::chrono::seconds{-20}};
  Companion companion{params, MissionOrigin::make({31.5, 105.0, 480.0}).value(), now};
  mavlink::Encoder encoder{1, 1};
  mavlink::Parser parser;
  while (!input.empty()) {
    const std::uint8_t what = input.byte();
    now += std::chrono::milliseconds{5} * input.byte();
    if (what < 200) {
      const mavlink::MessageInfo* info = mavlink::find_message(kIds.at(what % kIds.size()));
      SKEIN_ASSERT(info != nullptr);
      mavlink::Payload payload{};
      const auto bytes = input.take(info->length);
      std::copy(bytes.begin(), bytes.end(), payload.begin());
      companion.on_bytes(encoder.encode(*info, payload), now);
    } else if (what < 210) {
      companion.on_reboot(now);
    } else if (what < 215) {
      companion.on_duplicate(10, now);
    } else if (what < 235) {
      (void)companion.give_back(now, now - std::chrono::milliseconds{input.byte()});
    } else if (what < 245) {
      // A copter lands where this is: at its place, below its home.
      PositionSetpoint point;
      if (const auto sample = companion.sample()) {
        point.x_m = sample->state.x_m;
        point.y_m = sample->state.y_m;
        point.z_m = sample->state.z_m - 10.0 * (what - 235);
      }
      companion.command(point, now);
    } else {
      companion.command(
          Setpoint{.heading_rad = 0.1 * what, .airspeed_mps = 50.0, .height_m = 300.0}, now);
    }
    companion.step(now);
    drain(companion, parser, may_arm);
    SKEIN_ASSERT(companion.protocol_errors() == 0);
    if (const auto sample = companion.sample()) {
      SKEIN_ASSERT(sample->state.time <= now);
      SKEIN_ASSERT(std::isfinite(carried_to(*sample, now).heading_rad));
    }
  }
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
