// SPDX-License-Identifier: Apache-2.0
//
// What it costs one process to record a fleet of 32. An iteration is a second of a mission: the
// telemetry of all at 10 Hz, everybody's health, plans and events, its own track and what its agent
// is given, and the flush. `share_of_a_core` is CPU time by time; sizes are those of the file.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>

#include "skein/base/random.hpp"
#include "skein/recording/log.hpp"
#include "skein/recording/writer.hpp"

namespace skein::recording {
namespace {

constexpr int kVehicles = 32;
constexpr VehicleId kSelf{7};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Circles at 50 m/s, each its own, with the noise of sensors.
VehicleState state_of(int vehicle, Instant now, Random& random) {
  const double radius = 300.0 + 20.0 * vehicle;
  const double angle = 50.0 * to_seconds(now) / radius;
  VehicleState s;
  s.time = now;
  s.x_m = 100.0 * vehicle + radius * std::cos(angle) + random.normal(0.0, 0.3);
  s.y_m = radius * std::sin(angle) + random.normal(0.0, 0.3);
  s.z_m = 100.0 + 20.0 * vehicle + random.normal(0.0, 0.3);
  s.heading_rad = s.course_rad = std::remainder(angle + 1.57, 6.28);
  s.groundspeed_mps = 50.0 + random.normal(0.0, 0.1);
  s.airspeed_mps = 50.0 + random.normal(0.0, 0.1);
  s.distance_flown_m = 50.0 * to_seconds(now);
  return s;
}

VehicleId id(int vehicle) { return VehicleId{static_cast<std::uint16_t>(vehicle + 1)}; }

/// All that a vehicle in the middle of a mission is told, says and does in one second.
class Second {
 public:
  void write(Writer& writer) {
    for (int tenth = 0; tenth < 10; ++tenth) {
      const Instant now = at_seconds(second_ + 0.1 * tenth);
      for (int v = 0; v < kVehicles; ++v) {
        mission::Telemetry telemetry;
        telemetry.vehicle = id(v);
        telemetry.instance = InstanceId{0x1234567812345678U + static_cast<unsigned>(v)};
        telemetry.state = state_of(v, now, random_);
        telemetry.range_left_m = 40000.0 - telemetry.state.distance_flown_m;
        writer.write(telemetry, id(v), now);
      }
      for (int half = 0; half < 2; ++half) {
        const Instant step = now + std::chrono::milliseconds{50 * half};
        const VehicleState state = state_of(6, step, random_);
        writer.write(TrackPoint{state, 3, 0.01, -0.02});
        writer.write(AgentRecord{StateGiven{state, step}});
        writer.write(AgentRecord{TimeoutGiven{step}});
      }
    }
    const Instant now = at_seconds(second_);
    for (int v = 0; v < kVehicles; ++v) {
      mission::MissionEvent event;
      event.vehicle = id(v);
      event.time = now;
      event.body = mission::event::AllocationFailed{5, "3 of 5 vehicles"};
      writer.write(mission::Message{event}, id(v), now);
      coalition::MemberStatus status;
      status.member = id(v);
      status.tasks.resize(2);
      writer.write(coalition::Message{status}, id(v), now);
    }
    benchmark::DoNotOptimize(writer.flush());
    second_ += 1.0;
  }
  [[nodiscard]] double seconds() const { return second_; }

 private:
  Random random_{1};
  double second_ = 0.0;
};

std::filesystem::path scratch() {
  return std::filesystem::temp_directory_path() / ("skein-bench-" + std::to_string(::getpid()));
}

void record(benchmark::State& state, bool compress) {
  const auto folder = scratch() / "vehicle-07";
  Second second;
  double cpu = 0.0;
  {
    Writer::Options options;
    options.session.node = kSelf;
    options.compress = compress;
    auto writer = Writer::open(folder, options);
    if (!writer) return state.SkipWithError(writer.error().message.c_str());
    const double begun = cpu_seconds();
    for (auto _ : state) second.write(*writer);
    cpu = cpu_seconds() - begun;
  }
  state.counters["share_of_a_core"] = cpu / second.seconds();
  state.counters["MB_per_hour"] =
      static_cast<double>(std::filesystem::file_size(folder / kFileName)) / second.seconds() *
      3600.0 / 1e6;
  std::filesystem::remove_all(scratch());
}

void with_zstd(benchmark::State& state) { record(state, true); }
void uncompressed(benchmark::State& state) { record(state, false); }
BENCHMARK(with_zstd)->Name("record_a_second_of_32/skein/zstd")->Unit(benchmark::kMicrosecond);
BENCHMARK(uncompressed)->Name("record_a_second_of_32/skein/none")->Unit(benchmark::kMicrosecond);

/// Ten minutes, read by time.
void replay(benchmark::State& state) {
  const auto folder = scratch() / "vehicle-07";
  {
    auto writer = Writer::open(folder);
    if (!writer) return state.SkipWithError(writer.error().message.c_str());
    Second second;
    while (second.seconds() < 600.0) second.write(*writer);
  }
  auto log = Log::open(folder);
  if (!log) return state.SkipWithError(log.error().message.c_str());
  std::int64_t records = 0;
  for (auto _ : state) {
    log->seek(log->begin());
    while (log->next()) ++records;
  }
  state.SetItemsProcessed(records);
  std::filesystem::remove_all(scratch());
}
BENCHMARK(replay)->Name("read_ten_minutes/skein")->Unit(benchmark::kMillisecond);

/// A second from a random moment of ten minutes.
void seek(benchmark::State& state) {
  const auto folder = scratch() / "vehicle-07";
  {
    auto writer = Writer::open(folder);
    if (!writer) return state.SkipWithError(writer.error().message.c_str());
    Second second;
    while (second.seconds() < 600.0) second.write(*writer);
  }
  auto log = Log::open(folder);
  if (!log) return state.SkipWithError(log.error().message.c_str());
  Random random{2};
  for (auto _ : state) {
    log->seek(at_seconds(random.uniform(0.0, 599.0)));
    benchmark::DoNotOptimize(log->next());
  }
  std::filesystem::remove_all(scratch());
}
BENCHMARK(seek)->Name("seek_in_ten_minutes/skein")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace skein::recording
