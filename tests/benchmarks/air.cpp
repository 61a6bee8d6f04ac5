// SPDX-License-Identifier: Apache-2.0
//
// What each of a large team sends on an air that all share: the first seconds of a mission flown in
// virtual time, and what its vehicles say there carried by links that all hear each other.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "air_channels.hpp"
#include "signatures.hpp"
#include "skein/air/link.hpp"
#include "skein/base/random.hpp"
#include "skein/codec/codec.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/mission/may_say.hpp"
#include "thousand.hpp"

namespace {

using namespace skein;                 // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

constexpr double kLoss = 0.02;
constexpr Duration kDelay = 5ms;
constexpr std::size_t kCertificateBytes = 200;

struct Sample {
  Instant at;
  std::uint8_t channel;
  std::vector<std::uint8_t> bytes;
};

/// What all vehicles say in the first seconds, paced as where the air has its price.
Result<std::vector<Sample>> said(Duration duration) {
  constexpr double kAllInRange_m = 100'000.0;
  constexpr double kRoomForAll = 1e12;
  auto scenario = hil::thousand_vehicles(kAllInRange_m, duration);
  if (!scenario) return scenario.error();
  scenario->radio.bytes_per_s = kRoomForAll;
  std::vector<Sample> samples;
  Instant now{};
  hil::TeamObserver observer;
  observer.track = [&](VehicleId, const VehicleState& state, const mission::FlightPlan&) {
    now = std::max(now, state.time);
  };
  observer.message = [&](const mission::Message& message) {
    auto bytes = codec::encode(message);
    if (!bytes) return;
    if (mission::is_signed(message)) bytes->resize(bytes->size() + network::kSignatureBytes);
    samples.push_back({now, static_cast<std::uint8_t>(message.index()), std::move(*bytes)});
  };
  (void)hil::simulate_team(hil::team_mission(*scenario), observer);
  return samples;
}

struct Node final : air::LinkSink {
  std::unique_ptr<air::Link> link;
  std::uint32_t counter = 0;
  std::uint64_t bytes_before = 0;
  std::optional<air::Opened> open(std::span<const std::uint8_t> /*passed_on*/) override {
    return {};
  }
  void on_sample(std::uint8_t /*channel*/, const air::Author& /*author*/,
                 std::span<const std::uint8_t> /*bytes*/) override {}
  void on_certificate(const air::Author& /*author*/,
                      std::span<const std::uint8_t> /*bytes*/) override {}
};

struct Datagram {
  std::size_t from;
  std::uint32_t counter;
  std::vector<std::uint8_t> content;
};

class Air {
 public:
  explicit Air(std::size_t count) : nodes_(count) {
    air::LinkConfig config;
    config.channels = network::air_channels();
    config.certificate.resize(kCertificateBytes);
    for (std::size_t i = 0; i < count; ++i) {
      config.self = author(i);
      config.seed = i + 1;
      nodes_[i].link = std::make_unique<air::Link>(config, nodes_[i], now_);
    }
  }

  void say(std::size_t node, const Sample& sample) {
    (void)nodes_[node].link->send(sample.channel, sample.bytes, now_);
  }
  void run_until(Instant end) {
    while (true) {
      Instant next = flying_.empty() ? Instant::max() : flying_.begin()->first;
      for (const Node& node : nodes_) next = std::min(next, node.link->due());
      if (next > end) break;
      now_ = std::max(now_, next);
      step();
    }
    now_ = end;
  }
  /// Whom a node knows of, on average.
  [[nodiscard]] double known() const {
    double sum = 0.0;
    for (const Node& node : nodes_) sum += static_cast<double>(node.link->peers(now_).size());
    return sum / static_cast<double>(nodes_.size());
  }
  /// What each has sent since the last call.
  std::vector<double> sent() {
    std::vector<double> bytes;
    for (Node& node : nodes_) {
      const std::uint64_t all = node.link->counts().bytes;
      bytes.push_back(static_cast<double>(all - std::exchange(node.bytes_before, all)));
    }
    return bytes;
  }

 private:
  static air::Author author(std::size_t i) {
    return {VehicleId{static_cast<std::uint16_t>(i + 1)}, InstanceId{7}};
  }
  void step() {
    while (!flying_.empty() && flying_.begin()->first <= now_) {
      const Datagram datagram = std::move(flying_.begin()->second);
      flying_.erase(flying_.begin());
      const air::Opened opened{author(datagram.from), datagram.counter, datagram.content};
      for (std::size_t to = 0; to < nodes_.size(); ++to) {
        if (to == datagram.from || random_.chance(kLoss)) continue;
        nodes_[to].link->hear(opened, datagram.content, now_);
      }
    }
    for (std::size_t from = 0; from < nodes_.size(); ++from) {
      while (auto content = nodes_[from].link->poll(now_)) {
        flying_.emplace(now_ + kDelay, Datagram{from, ++nodes_[from].counter, std::move(*content)});
      }
    }
  }

  Instant now_{};
  Random random_{1};
  std::vector<Node> nodes_;
  std::multimap<Instant, Datagram> flying_;
};

/// 1,000 nodes start together, find each other, and say what the mission's vehicles say.
void thousand(benchmark::State& state) {
  constexpr Duration kBegins = 5s;
  constexpr Duration kDuration = 20s;
  constexpr std::size_t kNodes = 1000;
  const auto samples = said(kDuration);
  if (!samples) return state.SkipWithError(samples.error().message.c_str());
  while (state.KeepRunning()) {
    Air air{kNodes};
    air.run_until(Instant{} + kBegins);
    state.counters["known_after_5_s"] = air.known();
    const auto finding = air.sent();
    std::size_t node = 0;
    for (const Sample& sample : *samples) {
      air.run_until(sample.at + kBegins);
      air.say(node++ % kNodes, sample);
    }
    air.run_until(Instant{} + kBegins + kDuration);
    const auto flying = air.sent();
    const auto mean_per_s = [](const std::vector<double>& bytes, Duration of) {
      double sum = 0.0;
      for (const double b : bytes) sum += b;
      return sum / static_cast<double>(bytes.size()) / to_seconds(of);
    };
    state.counters["finding_bytes_per_s"] = mean_per_s(finding, kBegins);
    state.counters["flying_bytes_per_s"] = mean_per_s(flying, kDuration);
    state.counters["samples_per_s"] =
        static_cast<double>(samples->size()) / kNodes / to_seconds(kDuration);
  }
}

BENCHMARK(thousand)->Name("air_1000/skein")->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
