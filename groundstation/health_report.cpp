// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/health_report.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

#include "skein/codec/json_text.hpp"
#include "skein/mission/host_watch.hpp"

namespace skein::groundstation {
namespace {

/// The text format of Prometheus, version 0.0.4.
class Metrics {
 public:
  Metrics& family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP {0} {2}\n# TYPE {0} {1}\n", name, type, help);
    return *this;
  }
  template <class Number>
  Metrics& value(Number number) {
    fmt::format_to(std::back_inserter(text_), "{} {}\n", name_, number);
    return *this;
  }
  template <class Number>
  Metrics& of(VehicleId vehicle, Number number) {
    fmt::format_to(std::back_inserter(text_), "{}{{vehicle=\"{}\"}} {}\n", name_, vehicle.value,
                   number);
    return *this;
  }
  void build(const std::string& version) {
    family("skein_build_info", "gauge", "The program; always 1");
    fmt::format_to(std::back_inserter(text_), "{}{{version=\"{}\"}} 1\n", name_, version);
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
  std::string_view name_;
};

bool is_heard(const mission::FleetEntry& entry) { return entry.telemetry && !entry.silent; }

struct Count {
  std::size_t expected = 0;
  std::size_t heard = 0;
};

Count count(const mission::Fleet& fleet) {
  Count count;
  for (const auto& [vehicle, entry] : fleet.vehicles()) {
    if (entry.expected) ++count.expected;
    if (is_heard(entry)) ++count.heard;
  }
  return count;
}

/// A family with a line for each vehicle; `number` gives nothing where there is none to tell.
template <class NumberOf>
void add_fleet(Metrics& metrics, const mission::Fleet& fleet, std::string_view name,
               std::string_view type, std::string_view help, const NumberOf& number) {
  metrics.family(name, type, help);
  for (const auto& [vehicle, entry] : fleet.vehicles()) {
    if (const auto value = number(entry)) metrics.of(vehicle, *value);
  }
}

void add_vehicles(Metrics& metrics, const mission::Fleet& fleet, Instant now) {
  using Entry = mission::FleetEntry;
  add_fleet(metrics, fleet, "skein_vehicle_up", "gauge", "1 while its telemetry is heard",
            [](const Entry& entry) { return std::optional{is_heard(entry) ? 1 : 0}; });
  add_fleet(metrics, fleet, "skein_vehicle_telemetry_age_seconds", "gauge",
            "Since its newest telemetry came", [now](const Entry& entry) {
              return entry.telemetry ? std::optional{to_seconds(now - entry.heard_at)}
                                     : std::nullopt;
            });
  add_fleet(metrics, fleet, "skein_vehicle_control_overruns_total", "counter",
            "Periods that its control has missed since its start", [](const Entry& entry) {
              return entry.telemetry ? std::optional{entry.telemetry->control_overruns}
                                     : std::nullopt;
            });
  add_fleet(metrics, fleet, "skein_vehicle_messages_dropped_total", "counter",
            "Messages that it has dropped since its start", [](const Entry& entry) {
              return entry.telemetry ? std::optional{entry.telemetry->messages_dropped}
                                     : std::nullopt;
            });
  add_fleet(metrics, fleet, "skein_vehicle_problems", "gauge", "Problems that it names",
            [](const Entry& entry) {
              return entry.health ? std::optional{entry.health->problems.size()} : std::nullopt;
            });
  add_fleet(metrics, fleet, "skein_vehicle_duplicate", "gauge", "1 while two answer to its number",
            [](const Entry& entry) { return std::optional{entry.duplicate ? 1 : 0}; });
}

std::string metrics_text(const HealthFacts& facts, const mission::Fleet& fleet) {
  const Count vehicles = count(fleet);
  Metrics metrics;
  metrics.build(facts.version);
  metrics.family("skein_mission_time_seconds", "gauge", "Mission time")
      .value(to_seconds(facts.now));
  metrics.family("skein_vehicles_expected", "gauge", "Vehicles of the fleet")
      .value(vehicles.expected);
  metrics.family("skein_vehicles_heard", "gauge", "Vehicles whose telemetry is heard")
      .value(vehicles.heard);
  metrics.family("skein_messages_sent_total", "counter", "Messages sent").value(facts.sent);
  metrics.family("skein_messages_received_total", "counter", "Messages received")
      .value(facts.received);
  metrics.family("skein_messages_dropped_total", "counter", "Messages dropped, for any reason")
      .value(facts.dropped);
  metrics
      .family("skein_datagrams_of_strangers_total", "counter",
              "Datagrams that nobody sealed with the team's key, or not just now")
      .value(facts.of_strangers);
  metrics
      .family("skein_decisions_unproven_total", "counter",
              "Decisions without a good signature of the member that they name")
      .value(facts.unproven);
  metrics
      .family("skein_network_restarts_total", "counter",
              "Starts of the process that carries the network after it had ended")
      .value(facts.restarts);
  metrics.family("skein_messages_refused_total", "counter", "Messages not their sender's to say")
      .value(facts.refused);
  metrics.family("skein_authorisations_waiting", "gauge", "Deliveries that wait for a decision")
      .value(facts.authorisations_waiting);
  metrics.family("skein_recordings", "gauge", "Recordings that run").value(facts.recordings);
  if (facts.disk_free_bytes) {
    metrics.family("skein_recording_free_bytes", "gauge", "Free where it records")
        .value(*facts.disk_free_bytes);
  }
  if (facts.clock) {
    metrics.family("skein_clock_synchronised", "gauge", "1 while the kernel's clock is")
        .value(facts.clock->synchronised ? 1 : 0);
    metrics.family("skein_clock_error_max_seconds", "gauge", "As far as it may be off")
        .value(std::chrono::duration<double>(facts.clock->error_max).count());
  }
  add_vehicles(metrics, fleet, facts.now);
  return std::move(metrics).text();
}

std::vector<std::string> problems(const HealthFacts& facts) {
  std::vector<std::string> all;
  if (facts.shall_record && facts.recordings == 0) all.emplace_back("nothing is recorded");
  mission::HostFacts host{.disk_free_bytes = facts.disk_free_bytes, .clock = {}};
  if (facts.clock && facts.among_machines) {
    host.clock = mission::HostFacts::Clock{facts.clock->synchronised, facts.clock->error_max};
  }
  for (std::string& problem : mission::host_problems(host)) all.push_back(std::move(problem));
  return all;
}

}  // namespace

console::Server::MachineReport machine_report(const HealthFacts& facts,
                                              const mission::Fleet& fleet) {
  const auto wrong = problems(facts);
  const Count vehicles = count(fleet);
  codec::Json json{{"healthy", wrong.empty()},
                   {"problems", wrong},
                   {"version", facts.version},
                   {"mission_time_s", to_seconds(facts.now)},
                   {"vehicles", {{"expected", vehicles.expected}, {"heard", vehicles.heard}}},
                   {"authorisations_waiting", facts.authorisations_waiting}};
  return {wrong.empty(), codec::json_text(json) + "\n", metrics_text(facts, fleet)};
}

}  // namespace skein::groundstation
