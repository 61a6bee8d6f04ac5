// SPDX-License-Identifier: Apache-2.0
//
// console_load VEHICLES [PACE]: serves the console with so many vehicles that fly circles and
// report ten times a second, through the same picture and server as the ground station's. Prints
// the address and the Unix time, in ms, of mission time 0, and goes on until its input ends. With a
// PACE the mission goes so many times as fast: as many messages in less time.
//
// Vehicle 1's x is ten times the mission second at which its telemetry was made, so that whoever
// looks can say how old it is.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>
#include <variant>

#include "skein/console/picture.hpp"
#include "skein/console/sections.hpp"
#include "skein/console/server.hpp"

namespace {

using namespace skein;
using Clock = std::chrono::steady_clock;

constexpr auto kPeriod = std::chrono::milliseconds{10};  // of the mission
constexpr int kTelemetryEvery = 10;                      // periods; each vehicle at another one
constexpr double kRadius_m = 200.0;
constexpr double kSpeed_mps = 25.0;

mission::Telemetry telemetry(VehicleId vehicle, double now_s) {
  mission::Telemetry t;
  t.vehicle = vehicle;
  t.instance = {vehicle.value};
  t.state.time = at_seconds(now_s);
  const double angle = kSpeed_mps / kRadius_m * now_s + vehicle.value;
  t.state.x_m = 500.0 * (vehicle.value % 8) + kRadius_m * std::cos(angle);
  t.state.y_m = 500.0 * (vehicle.value / 8) + kRadius_m * std::sin(angle);
  if (vehicle.value == 1) t.state.x_m = 10.0 * now_s;
  t.state.z_m = 100.0;
  t.state.heading_rad = angle + std::numbers::pi / 2.0;
  t.state.course_rad = t.state.heading_rad;
  t.state.groundspeed_mps = kSpeed_mps;
  t.state.airspeed_mps = kSpeed_mps;
  t.range_left_m = 50'000.0 - kSpeed_mps * now_s;
  t.activity = static_cast<mission::Activity>(static_cast<int>(now_s / 20.0 + vehicle.value) % 6);
  return t;
}

mission::Health health(VehicleId vehicle, std::uint16_t vehicles, double now_s) {
  mission::Health h;
  h.vehicle = vehicle;
  h.instance = {vehicle.value};
  h.time = at_seconds(now_s);
  h.program = "load 1.0";
  h.flight_controller = "simulated";
  for (std::uint16_t i = 1; i <= 4; ++i) {
    h.heard.push_back({{static_cast<std::uint16_t>((vehicle.value + i) % vehicles + 1)},
                       std::chrono::milliseconds{100}});
  }
  return h;
}

std::string hello(const console::PictureParams& params) {
  nlohmann::json said{
      {"program", "load 1.0"},
      {"origin", {{"latitude_deg", 47.0}, {"longitude_deg", 8.0}, {"height_m", 500.0}}},
      {"shapes", nlohmann::json::array()},
      {"replay", nullptr},
      {"expected", nlohmann::json::array()}};
  for (const VehicleId vehicle : params.expected) said["expected"].push_back(vehicle.value);
  return said.dump();
}

}  // namespace

int main(int argc, char** argv) {
  const int wanted = argc > 1 ? std::atoi(argv[1]) : 50;
  const int pace = argc > 2 ? std::atoi(argv[2]) : 1;
  if (wanted < 1 || wanted > 1000 || pace < 1 || pace > 100) {
    std::fprintf(stderr, "console_load VEHICLES [PACE]: 1 to 1000, 1 to 100\n");
    return 2;
  }
  const auto vehicles = static_cast<std::uint16_t>(wanted);
  console::PictureParams params;
  for (std::uint16_t i = 1; i <= vehicles; ++i) params.expected.push_back({i});
  console::Picture picture{params};
  mission::Fleet fleet{{.expected = params.expected}};
  const auto origin = MissionOrigin::make({47.0, 8.0, 500.0});
  console::ServerConfig config;
  config.port = 0;
  config.hello = hello(params);
  auto server = console::Server::open(std::move(config), [] {});
  if (!server) {
    std::fprintf(stderr, "%s\n", server.error().message.c_str());
    return 3;
  }
  const auto begun = Clock::now();
  const auto epoch_ms =
      std::chrono::duration<double, std::milli>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  std::printf("%s %.3f\n", (*server)->url().c_str(), epoch_ms);
  std::fflush(stdout);

  std::atomic<bool> ended{false};
  std::thread input{[&ended] {
    while (std::getchar() != EOF) {
    }
    ended = true;
  }};
  const auto hear = [&](const mission::Message& message, VehicleId sender, Instant now) {
    fleet.on_message(message, now);
    picture.on_message(message, sender, now);
  };
  std::uint64_t seq = 0;
  for (long period = 0; !ended; ++period) {
    const double now_s = pace * std::chrono::duration<double>(Clock::now() - begun).count();
    for (const VehicleId vehicle : params.expected) {
      if ((period + vehicle.value) % kTelemetryEvery == 0) {
        hear(telemetry(vehicle, now_s), vehicle, at_seconds(now_s));
      }
      if ((period + vehicle.value) % (10 * kTelemetryEvery) == 0) {
        hear(health(vehicle, vehicles, now_s), vehicle, at_seconds(now_s));
      }
    }
    if (period % 100 == 0) {
      mission::MissionEvent event;
      event.time = at_seconds(now_s);
      event.vehicle = {static_cast<std::uint16_t>(seq % vehicles + 1)};
      (*server)->append({console::event_json(event, seq)});
      ++seq;
    }
    while (const auto request = (*server)->next()) {
      if (const auto* join = std::get_if<console::Server::Join>(&*request)) {
        join->reply(console::series_of(picture));
      }
    }
    if (period % kTelemetryEvery == 0) {
      auto sections = console::sections_of(picture, fleet, *origin, "1.0", at_seconds(now_s));
      (*server)->publish(now_s, std::move(sections));
    }
    std::this_thread::sleep_until(begun + (period + 1) * std::chrono::microseconds{kPeriod} / pace);
  }
  input.join();
  return 0;
}
