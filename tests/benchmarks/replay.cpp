// SPDX-License-Identifier: Apache-2.0
//
// A recording of ten minutes of 32 vehicles, as a ground station makes it: how long it takes to
// open, and to look at a moment of it, anywhere (what the page then draws included).
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/console/sections.hpp"
#include "skein/groundstation/playback.hpp"
#include "skein/recording/writer.hpp"

namespace {

using namespace skein;

constexpr std::uint16_t kVehicles = 32;
constexpr int kSeconds = 600;

/// Telemetry at 10 Hz, health and an event a second, a plan every 20 s.
class Flight {
 public:
  Flight()
      : folder_{std::filesystem::temp_directory_path() /
                ("skein-replay-" + std::to_string(::getpid()))} {
    configuration::GroundConfig config;
    config.time.epoch_unix_ns = 1'700'000'000'000'000'000;
    config.origin = {47.0, 8.0, 500.0};
    for (std::uint16_t i = 1; i <= kVehicles; ++i) config.vehicles.push_back({i});
    recording::Writer::Options options;
    options.session.version = "1.0";
    options.session.configuration = configuration::to_yaml(config);
    auto writer = recording::Writer::open(folder_, options);
    if (!writer) {
      std::fprintf(stderr, "%s\n", writer.error().message.c_str());
      std::exit(1);
    }
    Random random{1};
    for (int tick = 0; tick < 10 * kSeconds; ++tick) {
      const Instant now = at_seconds(0.1 * tick);
      for (const VehicleId vehicle : config.vehicles) write(*writer, vehicle, tick, now, random);
    }
  }
  ~Flight() { std::filesystem::remove_all(folder_); }
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  static void write(recording::Writer& writer, VehicleId vehicle, int tick, Instant now,
                    Random& random) {
    mission::Telemetry t;
    t.vehicle = vehicle;
    t.instance = {vehicle.value};
    t.state.time = now;
    t.state.x_m = random.uniform(-5000.0, 5000.0);
    t.state.y_m = random.uniform(-5000.0, 5000.0);
    t.state.groundspeed_mps = random.uniform(40.0, 60.0);
    t.activity = static_cast<mission::Activity>(tick / 300 % 6);
    writer.write(mission::Message{t}, vehicle, now);
    if (tick % 10 != 0) return;
    mission::Health health;
    health.vehicle = vehicle;
    health.instance = {vehicle.value};
    health.program = "skein-onboard 1.0";
    for (std::uint16_t i = 1; i <= kVehicles; ++i) health.heard.push_back({{i}, Duration{i}});
    writer.write(mission::Message{health}, vehicle, now);
    mission::MissionEvent event;
    event.vehicle = vehicle;
    event.time = now;
    event.body = mission::event::Authorised{"something happened"};
    writer.write(event);
    if (tick % 200 != 0) return;
    mission::PlanReport plan;
    plan.vehicle = vehicle;
    plan.plan.timed.speed_mps = 50.0;
    for (int i = 0; i < 10; ++i) {
      static_cast<void>(plan.plan.timed.path.append(Segment{0.001 * (i % 3 - 1), 200.0}));
    }
    writer.write(mission::Message{plan}, vehicle, now);
  }

  std::filesystem::path folder_;
};

const Flight& flight() {
  static const Flight made;
  return made;
}

void open(benchmark::State& state) {
  const auto& folder = flight().folder();
  for (auto _ : state) benchmark::DoNotOptimize(groundstation::Playback::open(folder).ok());
}
BENCHMARK(open)->Name("open/skein")->Unit(benchmark::kMillisecond)->Iterations(3);

void look(benchmark::State& state) {
  auto playback = groundstation::Playback::open(flight().folder());
  Random random{2};
  std::vector<double> all;
  for (auto _ : state) {
    const auto begun = std::chrono::steady_clock::now();
    playback->go_to(at_seconds(random.uniform(0.0, kSeconds)));
    benchmark::DoNotOptimize(console::sections_of(playback->picture(), playback->fleet(),
                                                  playback->origin(), "1.0", playback->now()));
    benchmark::DoNotOptimize(console::series_of(playback->picture()));
    all.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
            .count());
  }
  std::sort(all.begin(), all.end());
  state.counters["median_ms"] = all[all.size() / 2];
  state.counters["most_ms"] = all.back();
}
BENCHMARK(look)->Name("look/skein")->Unit(benchmark::kMillisecond)->Iterations(200);

}  // namespace
