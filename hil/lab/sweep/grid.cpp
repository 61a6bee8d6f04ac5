// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/configuration/tasking.hpp"
#include "skein/groundstation/task_planning.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/mission/may_say.hpp"

namespace skein::experiments {
namespace {

using configuration::Experiment;
using configuration::ExperimentSettings;
using configuration::RandomTeam;
using configuration::Scenario;
using configuration::ScenarioVehicle;

constexpr int kDrawsMax = 100;
constexpr std::size_t kSearchPointsMax = 100;
/// Heights of a drawn team differ by this many times what the judges ask for.
constexpr double kHeightMargin = 1.8;

constexpr double kEverywhere_m = 1e6;

template <class T>
void put(const std::optional<T>& over, std::optional<T>& value) {
  if (over) value = over;
}

ExperimentSettings settings_of(const Experiment& experiment, const Cell& cell) {
  ExperimentSettings all = experiment.settings;
  for (std::size_t axis = 0; axis < cell.points.size(); ++axis) {
    const ExperimentSettings& own = experiment.axes.at(axis).points.at(cell.points[axis]).settings;
    put(own.vehicles, all.vehicles);
    put(own.allocation, all.allocation);
    put(own.tasked_by, all.tasked_by);
    put(own.mesh, all.mesh);
    put(own.radio_range_m, all.radio_range_m);
    put(own.relay_orbit_m, all.relay_orbit_m);
    put(own.message_delay_s, all.message_delay_s);
    put(own.radio_delay_s, all.radio_delay_s);
    put(own.allocation_time_s, all.allocation_time_s);
    put(own.formation_margin_s, all.formation_margin_s);
    put(own.lease_s, all.lease_s);
    put(own.silence_s, all.silence_s);
    put(own.authorisation_lead_s, all.authorisation_lead_s);
  }
  return all;
}

void put_duration(const std::optional<double>& over_s, Duration& value) {
  if (over_s) value = from_seconds(*over_s);
}

void apply(const ExperimentSettings& settings, Scenario& scenario) {
  coalition::ProtocolParams& protocol = scenario.protocol;
  if (settings.allocation) scenario.planning.method = *settings.allocation;
  if (settings.radio_range_m) {
    scenario.radio.range_m = *settings.radio_range_m;
    protocol.radio_range_m = *settings.radio_range_m;
  }
  if (settings.relay_orbit_m) protocol.relay_orbit_m = *settings.relay_orbit_m;
  if (settings.mesh) {
    scenario.radio.mesh = *settings.mesh;
    if (*settings.mesh != configuration::MeshKind::none) protocol.radio_range_m = kEverywhere_m;
  }
  if (settings.message_delay_s) {
    put_duration(settings.message_delay_s, protocol.message_delay);
    scenario.radio.delay_mean = protocol.message_delay / 2;
    scenario.radio.delay_jitter = protocol.message_delay / 2;
  }
  if (settings.radio_delay_s) {
    put_duration(settings.radio_delay_s, scenario.radio.delay_mean);
    scenario.radio.delay_jitter = {};
  }
  put_duration(settings.allocation_time_s, protocol.allocation_time);
  put_duration(settings.formation_margin_s, protocol.margin);
  put_duration(settings.lease_s, protocol.lease);
  put_duration(settings.silence_s, protocol.silence);
  put_duration(settings.authorisation_lead_s, protocol.authorisation_lead);
}

/// So far from every hazard that the vehicle can turn away on either side.
bool clear_of_hazards(const Vec2& point, const VehicleSpec& spec, const Scenario& base) {
  return std::none_of(base.hazards.begin(), base.hazards.end(), [&](const auto& h) {
    const double room = h.hazard.radius_m + 2.0 * spec.planning_radius_m();
    return (point - h.hazard.centre).squaredNorm() < room * room;
  });
}

template <class Draw>
Vec2 clear_point(const VehicleSpec& spec, const Scenario& base, Draw draw) {
  Vec2 point = draw();
  for (int i = 0; i < kDrawsMax && !clear_of_hazards(point, spec, base); ++i) point = draw();
  return point;
}

Vec2 near_a_site(const RandomTeam& team, const Scenario& base, Random& random) {
  const Site& site = base.sites[random.index(base.sites.size())];
  const double distance = team.search_radius_m * std::sqrt(random.uniform());
  return site.position + distance * unit_vector(random.uniform(-kPi, kPi));
}

ScenarioVehicle place(ScenarioVehicle vehicle, const RandomTeam& team, const Scenario& base,
                      Random random) {
  const Vec2 start = clear_point(vehicle.spec, base, [&] {
    const double x = random.uniform(team.west_m, team.east_m);
    return Vec2{x, random.uniform(team.south_m, team.north_m)};
  });
  vehicle.start = {start.x(), start.y(), random.uniform(-kPi, kPi)};
  vehicle.search.clear();
  double left_m = team.search_share * vehicle.spec.range_m;
  for (Vec2 from = start; vehicle.search.size() < kSearchPointsMax;) {
    const Vec2 next =
        clear_point(vehicle.spec, base, [&] { return near_a_site(team, base, random); });
    left_m -= (next - from).norm();
    if (left_m < 0.0) break;
    vehicle.search.push_back(next);
    from = next;
  }
  return vehicle;
}

/// From 1 on, without that of the sensors.
VehicleId nth_id(std::size_t n) {
  return VehicleId{static_cast<std::uint16_t>(n < mission::kSensors.value ? n : n + 1)};
}

std::string name_of(const Experiment& experiment, const Cell& cell) {
  std::string text;
  const auto words = labels(experiment, cell);
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i > 0 ? ", " : "") + experiment.axes[i].name + " " + words[i];
  }
  return text;
}

}  // namespace

std::vector<Cell> cells_of(const Experiment& experiment) {
  std::vector<Cell> cells{Cell{}};
  for (const auto& axis : experiment.axes) {
    std::vector<Cell> longer;
    for (const Cell& cell : cells) {
      for (std::size_t point = 0; point < axis.points.size(); ++point) {
        longer.push_back(cell);
        longer.back().points.push_back(point);
      }
    }
    cells = std::move(longer);
  }
  return cells;
}

std::vector<std::string> labels(const Experiment& experiment, const Cell& cell) {
  std::vector<std::string> words;
  for (std::size_t axis = 0; axis < cell.points.size(); ++axis) {
    words.push_back(experiment.axes.at(axis).points.at(cell.points[axis]).label);
  }
  return words;
}

std::vector<ScenarioVehicle> draw_team(const RandomTeam& team, const Scenario& base,
                                       std::size_t count, std::uint64_t seed) {
  Random random{seed};
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& v : base.vehicles) lowest = std::min(lowest, v.spec.height_m);
  std::vector<ScenarioVehicle> drawn;
  std::vector<std::size_t> kinds;
  while (drawn.size() < count) {
    if (kinds.empty()) {
      for (std::size_t i = 0; i < base.vehicles.size(); ++i) kinds.push_back(i);
    }
    const auto pick = kinds.begin() + static_cast<std::ptrdiff_t>(random.index(kinds.size()));
    drawn.push_back(place(base.vehicles[*pick], team, base, random.fork()));
    kinds.erase(pick);
    VehicleSpec& spec = drawn.back().spec;
    spec.id = nth_id(drawn.size());
    spec.height_m = lowest + kHeightMargin * base.expect.separation_vertical_m *
                                 static_cast<double>(drawn.size() - 1);
  }
  return drawn;
}

Result<Scenario> scenario_of(const Experiment& experiment, const Scenario& base, const Cell& cell,
                             std::uint64_t seed) {
  const ExperimentSettings settings = settings_of(experiment, cell);
  Scenario scenario = base;
  apply(settings, scenario);
  put_duration(experiment.duration_max_s, scenario.duration_max);
  scenario.seed = seed;
  scenario.reference.clear();
  scenario.expect.coalitions = 0;
  scenario.expect.first_attempt_fails.clear();
  for (const auto& reported : experiment.reported_sites) {
    const bool known = std::any_of(base.sites.begin(), base.sites.end(),
                                   [&](const Site& s) { return s.id == reported.site; });
    if (!known) {
      return Error{"reported_sites names site " + std::to_string(reported.site.value) +
                   ", which the scenario does not have; remove it or correct the number"};
    }
  }
  if (settings.vehicles && !experiment.team) {
    return Error{"settings.vehicles of " + name_of(experiment, cell) +
                 " needs a fleet that is drawn; add random_team, or leave vehicles out"};
  }
  Result<void> flyable = configuration::check(scenario);
  Random draws{seed};
  for (int i = 0; experiment.team && (i == 0 || (!flyable && i < kDrawsMax)); ++i) {
    const std::size_t count =
        settings.vehicles.value_or(static_cast<std::uint16_t>(base.vehicles.size()));
    scenario.vehicles = draw_team(*experiment.team, base, count, i == 0 ? seed : draws.next());
    flyable = configuration::check(scenario);
  }
  if (!flyable) {
    return Error{"with " + name_of(experiment, cell) + " and seed " + std::to_string(seed) + ": " +
                 flyable.error().message};
  }
  return scenario;
}

namespace {

/// So many nodes: less than a second for 32 vehicles.
constexpr std::uint64_t kTaskingSteps = 2'000;

/// Where there is no plan, the team flies as it would without.
Result<void> task(Scenario& scenario, planning::Criterion criterion) {
  scenario.tasking = {};
  scenario.tasking.criterion = criterion;
  for (const Site& site : scenario.sites) scenario.tasking.known.push_back(site.id);
  const auto planned = groundstation::plan_tasks(scenario, {kTaskingSteps, {}});
  if (!planned) return {};
  return configuration::give_tasks(planned->file, scenario);
}

}  // namespace

Result<hil::TeamMission> mission_of(const Experiment& experiment, const Scenario& base,
                                    const Cell& cell, std::uint64_t seed) {
  if (base.flies_routes()) {
    return Error{
        "scenario: its vehicles fly planned routes, which `skein-hil run` alone does; name "
        "a mission without routes.approaches"};
  }
  if (base.flies_formation()) {
    return Error{
        "scenario: its vehicles fly a formation, and a sweep flies coalitions; name a "
        "mission of sites"};
  }
  auto scenario = scenario_of(experiment, base, cell, seed);
  if (!scenario) return scenario.error();
  if (const auto by = settings_of(experiment, cell).tasked_by) {
    if (const auto tasked = task(*scenario, *by); !tasked) return tasked.error();
  }
  hil::TeamMission mission = hil::team_mission(*scenario);
  mission.allocation_takes =
      std::min(mission.allocation_takes, scenario->protocol.allocation_time / 2);
  for (const auto& reported : experiment.reported_sites)
    mission.reported[reported.site] = reported.at;
  return mission;
}

}  // namespace skein::experiments
