// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "process_fields.hpp"
#include "skein/configuration/utc.hpp"

namespace skein::configuration {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(HostFlightController::count)>
    kHostFlightControllers{"own", "emulated"};

void radio_fields(FieldVisitor& v, RadioConfig& radio) {
  v.number({"range_m", "vehicle to vehicle; beyond it nothing arrives"}, {10.0, 1e6, "m"},
           radio.range_m);
  v.number({"ground_range_m", "ground station to vehicle"}, {10.0, 1e6, "m"}, radio.ground_range_m);
  milliseconds(v, {"delay_ms_mean", "of a message"}, {0.0, 60000.0, "ms"}, radio.delay_mean);
  milliseconds(v, {"delay_ms_jitter", "delays lie within mean +- jitter"}, {0.0, 60000.0, "ms"},
               radio.delay_jitter);
  v.require(radio.delay_jitter <= radio.delay_mean, "delay_ms_jitter",
            "must not exceed delay_ms_mean; mend one of them");
  v.number({"loss_ratio", "share of the messages that are lost"}, {0.0, 1.0}, radio.loss_ratio);
  auto mesh = static_cast<std::size_t>(radio.mesh);
  v.choice({"mesh", "who passes on what others say"}, kMeshKinds, mesh);
  radio.mesh = static_cast<MeshKind>(mesh);
  v.number({"bytes_per_s",
            "of the channel that a node shares with all whom it hears, each hop by itself; what "
            "would wait for more than a second is lost; 0: there is always room"},
           {0.0, 1e9, "bytes/s"}, radio.bytes_per_s);
}

void scenario_hazard_fields(FieldVisitor& v, TimedHazard& hazard) {
  hazard_fields(v, hazard.hazard);
  seconds(v, {"known_from_s", "mission time when the vehicles are told; 0: known before"}, kSeconds,
          hazard.known_from);
}

void partition_list(FieldVisitor& v, std::vector<std::vector<VehicleId>>& groups) {
  v.list({"partition", "groups of ids that hear only each other; 0 is the ground station"},
         list_of(groups, kNodesMax, [](FieldVisitor& inner, std::vector<VehicleId>& group) {
           ids(inner, {}, group, "vehicle", 0);
         }));
}

void fault_fields(FieldVisitor& v, Fault& fault) {
  std::optional<std::uint16_t> killed;
  std::optional<double> loss;
  std::optional<std::uint16_t> floods;
  std::optional<std::uint16_t> falls;
  std::optional<double> falls_to;
  if (fault.kind == FaultKind::kill_vehicle) killed = fault.vehicle.value;
  if (fault.kind == FaultKind::flood) floods = fault.vehicle.value;
  if (fault.kind == FaultKind::battery) {
    falls = fault.vehicle.value;
    falls_to = fault.battery_percent;
  }
  if (fault.kind == FaultKind::loss) loss = fault.loss_ratio;
  seconds(v, {"at_s", "mission time", kRequired}, kSeconds, fault.at);
  seconds(v, {"for_s", "how long a partition, a loss or a flood lasts"}, kSeconds, fault.duration);
  whole(v, {"kill_vehicle", "id of the vehicle whose process is killed; 0: the ground station's"},
        {0.0, 65535.0}, killed);
  partition_list(v, fault.groups);
  v.number({"loss_ratio", "share of the messages that are lost meanwhile"}, {0.0, 1.0}, loss);
  whole(v, {"flood_vehicle", "id of the vehicle that says 500 kB/s of noise meanwhile"},
        {1.0, 65535.0}, floods);
  whole(v, {"battery_vehicle", "id of the vehicle whose battery falls to battery_percent at once"},
        {1.0, 65535.0}, falls);
  v.number({"battery_percent", "what is left of it then; flying takes more"}, {0.0, 100.0, "%"},
           falls_to);
  v.require(falls.has_value() == falls_to.has_value(), "battery_percent",
            "goes with battery_vehicle; add the one that is missing");
  const int kinds = (killed ? 1 : 0) + (fault.groups.empty() ? 0 : 1) + (loss ? 1 : 0) +
                    (floods ? 1 : 0) + (falls ? 1 : 0);
  v.require(kinds == 1, "at_s",
            "a fault has exactly one of kill_vehicle, partition, loss_ratio, flood_vehicle and "
            "battery_vehicle; split it or add one");
  v.require(killed.has_value() || falls.has_value() || fault.duration > Duration{}, "for_s",
            "a partition, loss or flood lasts for some time; add for_s above 0 s");
  fault.kind = FaultKind::partition;
  if (killed) fault.kind = FaultKind::kill_vehicle;
  if (loss) fault.kind = FaultKind::loss;
  if (floods) fault.kind = FaultKind::flood;
  if (falls) fault.kind = FaultKind::battery;
  if (falls_to) fault.battery_percent = *falls_to;
  for (const auto& named : {killed, floods, falls}) {
    if (named) fault.vehicle = VehicleId{*named};
  }
  if (loss) fault.loss_ratio = *loss;
}

void reference_fields(FieldVisitor& v, ReferenceSite& site) {
  id(v, {"site", "that the values are of", kRequired}, site.site);
  std::optional<std::uint16_t> finder;
  if (site.found_by) finder = site.found_by->value;
  whole(v, {"found_by", "id of the vehicle that surveyed it"}, {1.0, 65535.0}, finder);
  site.found_by = finder ? std::optional{VehicleId{*finder}} : std::nullopt;
  v.number({"survey_done_s", "mission time"}, kSeconds, site.survey_done_s);
  v.number({"formed_s", "mission time when the coalition stood"}, kSeconds, site.formed_s);
  whole(v, {"coalition_size", "vehicles in it"}, {1.0, 65535.0}, site.coalition_size);
  v.list({"delivery_times_s", "mission times, in order"},
         list_of(site.delivery_times_s, kTasksPerKindMax,
                 [](FieldVisitor& inner, double& t) { inner.number({}, kSeconds, t); }));
  v.number({"assessment_done_s", "mission time when the last one ended"}, kSeconds,
           site.assessment_done_s);
  v.number({"allocation_time_s", "how long the allocation took"}, kSeconds, site.allocation_time_s);
}

void expect_fields(FieldVisitor& v, Expectations& e) {
  const Range limit_m{0.0, 1e5, "m"};
  v.number({"delivery_spread_s", "most between the first and last simultaneous delivery"}, kSeconds,
           e.delivery_spread_s);
  v.number({"slot_error_s", "most from a sequential delivery to its slot"}, kSeconds,
           e.slot_error_s);
  angle(v, {"bearing_error_deg", "most between flown and required bearing"}, {0.0, 180.0, "deg"},
        e.bearing_error_rad);
  v.number({"miss_distance_m", "most between the site and a delivery"}, limit_m, e.miss_distance_m);
  v.number({"assess_start_error_s", "most from the start of an assessment to its time"}, kSeconds,
           e.assess_start_error_s);
  v.number(
      {"place_rms_m",
       "root mean square of the distance from its place, of any vehicle while a formation holds"},
      limit_m, e.place_rms_m);
  v.number({"arrival_spread_s", "most between the first and the last vehicle to reach its place"},
           kSeconds, e.arrival_spread_s);
  v.number({"separation_horizontal_m", "two vehicles closer than this ..."}, limit_m,
           e.separation_horizontal_m);
  v.number({"separation_vertical_m", "... are at least that far apart in height"}, limit_m,
           e.separation_vertical_m);
  whole(v, {"coalitions", "that form and finish"}, {0.0, 1000.0}, e.coalitions);
  ids(v, {"first_attempt_fails", "ids of sites whose leader must monitor before it can form"},
      e.first_attempt_fails, "site");
  ids(v, {"vehicles_lost", "ids of vehicles that faults end"}, e.vehicles_lost, "vehicle");
  task_kinds(v, {"copters_fly", "kinds of tasks of which copters have flown one at least"},
             e.copters_fly);
}

void epoch_field(FieldVisitor& v, std::optional<std::int64_t>& epoch_unix_ns) {
  std::string text = epoch_unix_ns ? utc_text(*epoch_unix_ns) : "";
  v.text({"epoch",
          "of a fleet: mission time zero, UTC, such as 2026-11-23T08:00:00Z; empty: given when it "
          "is rendered"},
         text);
  epoch_unix_ns = parse_utc(text);
  v.require(text.empty() || epoch_unix_ns, "epoch",
            "is no time in UTC; write one such as 2026-11-23T08:00:00Z");
}

/// A folder on a host, where no relative path has a meaning.
void host_path(FieldVisitor& v, const Field& field, std::string& path) {
  v.text(field, path);
  v.require(path.empty() || path.front() == '/', field.key, "is no absolute path; begin it with /");
}

void host_fields(FieldVisitor& v, Host& host) {
  id(v, {"vehicle", "whose program runs there; 0: the ground station's", kRequired}, host.node, 0);
  ipv4(v, {"address", "IPv4 address in the mission network", kRequired}, host.address);
  v.text({"ssh", "how the host is reached: user@name; empty: it is this machine"}, host.ssh);
  v.text({"run", "words before every command there: `sudo -n`, `ip netns exec v1`"}, host.run);
  host_path(v,
            {"programs",
             "folder of the programs there, which are started directly; empty: they are "
             "`skein-onboard@ID` and `skein-ground` of systemd"},
            host.programs);
  host_path(v, {"configurations", "folder of the configuration there"}, host.configurations);
  host_path(v, {"recordings", "folder of what is recorded there"}, host.recordings);
  v.text({"can", "bus of the flight controller there; empty: as the vehicle says"}, host.can);
  host_path(v,
            {"radio_plugin",
             "`libskein_radio.so` there, with which a mixed mission's radio holds for what the "
             "host hears; empty: it hears everybody"},
            host.radio_plugin);
  auto fc = static_cast<std::size_t>(host.flight_controller);
  v.choice(
      {"flight_controller", "in a mixed mission: the host's own, or `skein-fc` emulates it there"},
      kHostFlightControllers, fc);
  host.flight_controller = static_cast<HostFlightController>(fc);
  v.require(!host.configurations.empty() && !host.recordings.empty(), "vehicle",
            "needs folders for configurations and recordings; leave these keys out, or name some");
  v.require(host.flight_controller == HostFlightController::own ||
                (!host.programs.empty() && !host.can.empty()),
            "flight_controller", "is emulated; name its bus in `can`, and `programs`");
}

void world_fields(FieldVisitor& v, Scenario& s) {
  origin_section(v, s.origin);
  seconds(v, {"duration_max_s", "the run is stopped, and fails, at this mission time", kRequired},
          {1.0, 86400.0, "s"}, s.duration_max);
  v.section({"radio", "what lies between the nodes"},
            [&s](FieldVisitor& inner) { radio_fields(inner, s.radio); });
  v.section({"air", "how the nodes share it"}, [&s](FieldVisitor& inner) {
    whole(inner, {"port", "UDP, of a fleet in the field"}, {1024.0, 65535.0}, s.air_port);
    air_fields(inner, s.air);
  });
  v.section({"wind", "in the whole area"},
            [&s](FieldVisitor& inner) { wind_fields(inner, s.wind, ""); });
  v.section({"protocol", "the contract net"},
            [&s](FieldVisitor& inner) { protocol_fields(inner, s.protocol); });
  v.section({"planning", "how tasks are given to vehicles"},
            [&s](FieldVisitor& inner) { planning_fields(inner, s.planning); });
  v.section({"traffic", "aircraft that are not of the team, and how vehicles keep clear of them"},
            [&s](FieldVisitor& inner) {
              traffic_fields(inner, s.traffic);
              passing_aircraft_list(inner, s.aircraft);
            });
}

}  // namespace

void fields(FieldVisitor& v, ScenarioVehicle& vehicle) {
  v.text({"type", "one of `types`"}, vehicle.type);
  spec_fields(v, vehicle.spec);
  pose_fields(v, vehicle.start);
  search_list(v, vehicle.search);
  v.section({"flight_controller", "what flies it"}, [&vehicle](FieldVisitor& inner) {
    flight_controller_fields(inner, vehicle.flight_controller, vehicle.spec.airframe, false);
  });
  turn_rules(v, vehicle.spec, "");
}

void fields(FieldVisitor& v, Scenario& s) {
  version_field(v);
  v.text({"title", "one line, shown in every report", kRequired}, s.title);
  v.text({"notes", "what the mission is about, and why its numbers are what they are"}, s.notes);
  whole(v, {"seed", "of everything random in the run"}, {0.0, 9e18}, s.seed);
  world_fields(v, s);
  v.fleet(s.vehicles);
  v.list({"sites", "places with tasks; a vehicle finds one within its sensor radius"},
         unique_groups_of(s.sites, kListMax, site_fields, "site",
                          [](const Site& site) { return site.id.value; }));
  site_templates_list(v, s.site_templates);
  v.list({"hazards", "circles to keep out of"},
         unique_groups_of(s.hazards, kListMax, scenario_hazard_fields, "hazard",
                          [](const TimedHazard& hazard) { return hazard.hazard.id.value; }));
  fence_section(v, s.fence);
  operator_decisions_list(v, s.operator_decisions);
  formation_section(v, s.formation);
  routes_section(v, s.routes);
  tasking_section(v, s.tasking);
  auto ends = static_cast<std::size_t>(s.ends);
  v.choice({"ends", "where the work leaves everybody, or ordered home and landed"}, kEndings, ends);
  s.ends = static_cast<Ending>(ends);
  v.list({"faults", "things that go wrong, on the time line"},
         groups_of(s.faults, kListMax, fault_fields));
  v.list({"reference", "published values, printed beside the run's"},
         unique_groups_of(s.reference, kListMax, reference_fields, "site",
                          [](const ReferenceSite& site) { return site.site.value; }));
  v.section({"expect", "what the run is judged by"},
            [&s](FieldVisitor& inner) { expect_fields(inner, s.expect); });
  epoch_field(v, s.epoch_unix_ns);
  console_section(v, s.console);
  agencies_section(v, s.agencies);
  team_remote_id_section(v, s.remote_id);
  v.list({"hosts",
          "where the programs run in the field (docs/fleet.md); a bench heeds those of external "
          "vehicles only"},
         unique_groups_of(s.hosts, kNodesMax, host_fields, "vehicle",
                          [](const Host& host) { return host.node.value; }));
}

}  // namespace skein::configuration
