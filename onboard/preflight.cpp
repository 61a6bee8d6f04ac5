// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/preflight.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "check_makers.hpp"
#include "link_params.hpp"
#include "skein/ardupilot/survey.hpp"
#include "skein/can/bus.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::onboard {
namespace {

std::int64_t unix_ns() {
  return std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count();
}

/// Asks an autopilot in real time, until it has answered or cannot be expected to.
Checks check_bus(const configuration::VehicleConfig& config) {
  const std::string& name = config.flight_controller.ardupilot.can;
  auto bus = can::open(name);
  if (!bus) {
    return in_group(CheckGroup::bus,
                    {fail("CAN bus", "cannot be opened", std::move(bus).error().message)});
  }
  const auto begun = std::chrono::steady_clock::now();
  auto params = can_params(config, unix_ns() / 1000);
  if (!params) {
    return in_group(CheckGroup::bus,
                    {fail("MAVLink signing", "no key", std::move(params).error().message)});
  }
  const auto now = [begun] { return Instant{std::chrono::steady_clock::now() - begun}; };
  ardupilot::Survey survey{std::move(bus).value(), *params, now()};
  while (!survey.step(now())) {
    constexpr int kTick_ms = 5;
    pollfd item{survey.bus().descriptor(), POLLIN, 0};
    (void)::poll(&item, 1, kTick_ms);
  }
  const auto& facts = survey.facts();
  const auto since = std::chrono::duration_cast<std::chrono::seconds>(now() - facts.time_at);
  return check_autopilot(config, facts, unix_ns() / 1'000'000'000 - since.count());
}

}  // namespace

std::string text_of(const Checks& checks) {
  std::string text;
  for (const Check& check : checks) {
    text += wording::check_line(check.verdict, check.what, check.found, check.remedy) + "\n";
  }
  return text;
}

std::string json_of(const Checks& checks) {
  codec::Json json{{"good", is_good(checks)}, {"checks", codec::Json::array()}};
  for (const Check& check : checks) {
    json["checks"].push_back({{"group", to_string(check.group)},
                              {"what", check.what},
                              {"verdict", to_string(check.verdict)},
                              {"found", check.found},
                              {"remedy", check.remedy}});
  }
  return codec::json_text(json);
}

bool is_good(const Checks& checks) {
  return std::ranges::none_of(checks,
                              [](const Check& check) { return check.verdict == Verdict::fail; });
}

Checks check_before_flight(const configuration::VehicleConfig& config) {
  Checks all = check_host(config, unix_ns());
  if (config.flight_controller.kind != configuration::FlightControllerKind::ardupilot) {
    append(all,
           in_group(CheckGroup::bus, {ok("flight controller", "simulated: no bus is looked at")}));
    return all;
  }
  append(all, check_interface(can::interface_of(config.flight_controller.ardupilot.can)));
  append(all, check_bus(config));
  return all;
}

}  // namespace skein::onboard
