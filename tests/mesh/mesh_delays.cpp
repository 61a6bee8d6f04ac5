// SPDX-License-Identifier: Apache-2.0
//
// mesh_delays SCENARIO RUN TOLERANCE
//   From the recordings of a mission that was flown over a mesh: how late telemetry was where it
//   was heard, and how much of it was not, by the hops that the modelled radio says it took. What
//   is sent waits for its node's next step and for other things that are ready within milliseconds,
//   so each hop after the first is compared. Loss is shown only: the model takes one way, where a
//   datagram comes by several. The exit status is 1 where the delay differs from the model by more
//   than TOLERANCE times it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <variant>
#include <vector>

#include "skein/configuration/scenario.hpp"
#include "skein/hil/radio/mesh.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/recording/log.hpp"
#include "skein/recording/recording.hpp"

namespace skein::hil {
namespace {

constexpr double kFrom_s = 5.0;  ///< of the mission; then all is found
constexpr std::size_t kEnough = 100;

struct Sent {
  Instant at{};
  Vec2 position;
  std::map<VehicleId, Instant> heard;
};
using OfVehicle = std::map<Instant, Sent>;  ///< by the time of the state in it

struct Way {
  std::size_t sent = 0;
  std::size_t heard = 0;
  double delay_s = 0.0;

  [[nodiscard]] double delay_ms() const { return 1e3 * delay_s / static_cast<double>(heard); }
};

/// Of what a node has recorded.
template <class Take>
bool for_each_telemetry(const std::filesystem::path& run, VehicleId node, Take take) {
  auto log = recording::Log::open(run / recording::folder_name(node));
  if (!log) {
    fmt::print(stderr, "{}\n", log.error().message);
    return false;
  }
  while (const auto entry = log->next()) {
    const auto* message = std::get_if<mission::Message>(&entry->content);
    const auto* telemetry = message ? std::get_if<mission::Telemetry>(message) : nullptr;
    if (telemetry != nullptr) take(*telemetry, entry->time);
  }
  return true;
}

class Flight {
 public:
  explicit Flight(const configuration::Scenario& scenario) : radio_{radio_params(scenario.radio)} {
    nodes_.push_back({kGroundStation, std::nullopt});
    for (const auto& v : scenario.vehicles) nodes_.push_back({v.spec.id, std::nullopt});
  }

  bool read(const std::filesystem::path& run) {
    const bool own = std::all_of(nodes_.begin() + 1, nodes_.end(), [&](const radio::Node& node) {
      return for_each_telemetry(run, node.id, [&](const mission::Telemetry& t, Instant at) {
        if (t.vehicle != node.id || to_seconds(at) < kFrom_s) return;
        said_[t.vehicle].try_emplace(t.state.time, Sent{at, t.state.position().horizontal(), {}});
      });
    });
    return own && std::all_of(nodes_.begin(), nodes_.end(), [&](const radio::Node& node) {
             return for_each_telemetry(run, node.id, [&](const mission::Telemetry& t, Instant at) {
               const auto sent = said_[t.vehicle].find(t.state.time);
               if (t.vehicle == node.id || sent == said_[t.vehicle].end()) return;
               sent->second.heard.emplace(node.id, at);
             });
           });
  }

  /// By hops; of the last second nothing, which may be on its way.
  [[nodiscard]] std::map<int, Way> ways() {
    std::map<int, Way> ways;
    std::multimap<Instant, std::size_t> order;
    for (std::size_t from = 1; from < nodes_.size(); ++from) {
      for (const auto& [time, sent] : said_[nodes_[from].id]) order.emplace(time, from);
    }
    if (order.empty()) return ways;
    const Instant end = order.rbegin()->first - std::chrono::seconds{1};
    radio::Mesh mesh{*radio_.mesh};
    const radio::Interference quiet;
    for (const auto& [time, from] : order) {
      const Sent& sent = said_[nodes_[from].id][time];
      nodes_[from].position = sent.position;
      if (time > end) break;
      mesh.move(radio_, quiet, nodes_, time);
      for (std::size_t to = 0; to < nodes_.size(); ++to) {
        if (to == from) continue;
        Way& way = ways[mesh.hops(from, to)];
        ++way.sent;
        const auto heard = sent.heard.find(nodes_[to].id);
        if (heard == sent.heard.end()) continue;
        ++way.heard;
        way.delay_s += to_seconds(heard->second - sent.at);
      }
    }
    ways.erase(0);  // before all positions are known
    return ways;
  }

  [[nodiscard]] const radio::RadioParams& radio() const { return radio_; }

 private:
  radio::RadioParams radio_;
  std::vector<radio::Node> nodes_;
  std::map<VehicleId, OfVehicle> said_;
};

bool print(const std::map<int, Way>& ways, const radio::RadioParams& radio, double tolerance) {
  bool held = ways.size() > 1 && ways.begin()->first == 1;
  const radio::Link link = radio::link_when_up(radio, {});
  const double first_ms = held ? ways.begin()->second.delay_ms() : 0.0;
  fmt::print("{:>4} {:>7} {:>10} {:>14} {:>9} {:>6} {:>8} {:>8}\n", "hops", "sent", "delay, ms",
             "after hop 1, ms", "model, ms", "ratio", "loss", "model");
  for (const auto& [hops, way] : ways) {
    const double more_ms = way.delay_ms() - first_ms;
    const double model_ms = 1e3 * to_seconds((hops - 1) * link.delay);
    const bool near =
        hops == 1 || way.heard < kEnough || std::abs(more_ms - model_ms) <= tolerance * model_ms;
    held = held && near;
    fmt::print("{:4} {:7} {:10.1f} {:15.1f} {:9.1f} {:6.2f} {:8.4f} {:8.4f}{}\n", hops, way.sent,
               way.delay_ms(), more_ms, model_ms, hops == 1 ? 1.0 : more_ms / model_ms,
               1.0 - static_cast<double>(way.heard) / static_cast<double>(way.sent),
               radio::over_hops(link, hops).loss, near ? "" : "  FAIL");
  }
  return held;
}

}  // namespace
}  // namespace skein::hil

int main(int argc, char** argv) {
  namespace hil = skein::hil;
  namespace configuration = skein::configuration;
  if (argc != 4) {
    fmt::print(stderr, "mesh_delays SCENARIO RUN TOLERANCE\n");
    return 2;
  }
  const auto scenario = configuration::load_flyable_scenario(argv[1]);
  if (!scenario || scenario->radio.mesh == configuration::MeshKind::none) {
    fmt::print(stderr, "{}\n",
               scenario ? "the scenario's radio has no mesh" : scenario.error().message);
    return 2;
  }
  hil::Flight flight{*scenario};
  if (!flight.read(argv[2])) return 2;
  return hil::print(flight.ways(), flight.radio(), std::strtod(argv[3], nullptr)) ? 0 : 1;
}
