// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include "process_fields.hpp"
#include "skein/configuration/experiment.hpp"

namespace skein::configuration {
namespace {

constexpr std::size_t kAxesMax = 4;
constexpr std::size_t kPointsMax = 32;
constexpr std::array<std::string_view, static_cast<std::size_t>(ExperimentChart::count)> kCharts{
    "lines", "bars"};

/// The methods, and before them a word for "as in the scenario".
void allocation_field(FieldVisitor& v, std::optional<planning::AllocationMethod>& method) {
  constexpr auto kMethods = static_cast<std::size_t>(planning::AllocationMethod::count);
  std::array<std::string_view, kMethods + 1> names{"scenario"};
  for (std::size_t i = 0; i < kMethods; ++i) {
    names.at(i + 1) = planning::to_string(static_cast<planning::AllocationMethod>(i));
  }
  std::size_t chosen = method ? static_cast<std::size_t>(*method) + 1 : 0;
  v.choice({"allocation", "method of the leaders; `scenario`: the scenario's"}, names, chosen);
  method = chosen > 0 ? std::optional{static_cast<planning::AllocationMethod>(chosen - 1)}
                      : std::nullopt;
}

void mesh_field(FieldVisitor& v, std::optional<MeshKind>& mesh) {
  std::array<std::string_view, kMeshKinds.size() + 1> names{"scenario"};
  std::ranges::copy(kMeshKinds, names.begin() + 1);
  std::size_t chosen = mesh ? static_cast<std::size_t>(*mesh) + 1 : 0;
  v.choice({"mesh", "who passes on what others say; nobody is out of the protocol's reach then"},
           names, chosen);
  mesh = chosen > 0 ? std::optional{static_cast<MeshKind>(chosen - 1)} : std::nullopt;
}

void tasked_by_field(FieldVisitor& v, std::optional<planning::Criterion>& criterion) {
  std::array<std::string_view, kCriteria.size() + 1> names{"nobody"};
  std::ranges::copy(kCriteria, names.begin() + 1);
  std::size_t chosen = criterion ? static_cast<std::size_t>(*criterion) + 1 : 0;
  v.choice({"tasked_by",
            "all sites are known, and tasked before take-off by this criterion; `nobody`: the team "
            "searches"},
           names, chosen);
  criterion =
      chosen > 0 ? std::optional{static_cast<planning::Criterion>(chosen - 1)} : std::nullopt;
}

void settings_fields(FieldVisitor& v, ExperimentSettings& s) {
  const Range short_time{0.001, 60.0, "s"};
  const Range long_time{0.1, 600.0, "s"};
  whole(v, {"vehicles", "how many a random team has"}, {1.0, double{kVehiclesMax}}, s.vehicles);
  allocation_field(v, s.allocation);
  tasked_by_field(v, s.tasked_by);
  mesh_field(v, s.mesh);
  v.number({"radio_range_m", "r_n, of the radio and of the protocol"}, {10.0, 1e6, "m"},
           s.radio_range_m);
  v.number({"relay_orbit_m", "as in the scenario's protocol; 0: none"}, {0.0, 1e6, "m"},
           s.relay_orbit_m);
  v.number({"message_delay_s", "dt_d; the radio's own delays are spread evenly from 0 to it"},
           short_time, s.message_delay_s);
  v.number({"radio_delay_s", "of every message, in place of that spread"}, {0.0, 60.0, "s"},
           s.radio_delay_s);
  v.number({"allocation_time_s", "t_TA"}, short_time, s.allocation_time_s);
  v.number({"formation_margin_s", "delta_t"}, {0.0, 60.0, "s"}, s.formation_margin_s);
  v.number({"lease_s", "as in the scenario's protocol"}, long_time, s.lease_s);
  v.number({"silence_s", "as in the scenario's protocol"}, long_time, s.silence_s);
  v.number({"authorisation_lead_s", "as in the scenario's protocol"}, {0.0, 600.0, "s"},
           s.authorisation_lead_s);
}

void team_fields(FieldVisitor& v, RandomTeam& team) {
  v.number({"west_m", "of the area of the starts", kRequired}, kMetres, team.west_m);
  v.number({"east_m", "of the area of the starts", kRequired}, kMetres, team.east_m);
  v.require(team.west_m < team.east_m, "east_m", "must be greater than west_m; mend one of them");
  v.number({"south_m", "of the area of the starts", kRequired}, kMetres, team.south_m);
  v.number({"north_m", "of the area of the starts", kRequired}, kMetres, team.north_m);
  v.require(team.south_m < team.north_m, "north_m",
            "must be greater than south_m; mend one of them");
  v.number({"search_share",
            "of its range that a vehicle searches for, from point to point, each near a site drawn "
            "by lot; 0: it stays where it starts"},
           {0.0, 1.0}, team.search_share);
  v.number({"search_radius_m", "how near"}, {0.0, 1e6, "m"}, team.search_radius_m);
}

void reported_site_fields(FieldVisitor& v, ReportedSite& reported) {
  id(v, {"site", "number of the site in the scenario", kRequired}, reported.site);
  seconds(v, {"at_s", "mission time", kRequired}, kSeconds, reported.at);
}

template <class Named>
bool names_differ(const std::vector<Named>& values, std::string Named::*name) {
  std::set<std::string> seen;
  return std::all_of(values.begin(), values.end(), [&](const Named& value) {
    const std::string& text = value.*name;
    return !text.empty() && text.find('\n') == std::string::npos && seen.insert(text).second;
  });
}

void axis_fields(FieldVisitor& v, ExperimentAxis& axis) {
  v.text({"name", "for tables and plots", kRequired}, axis.name);
  v.list({"points", "its values; each is a label and settings", kRequired},
         groups_of(axis.points, kPointsMax, [](FieldVisitor& inner, ExperimentPoint& point) {
           inner.text({"label", "for tables and plots", kRequired}, point.label);
           settings_fields(inner, point.settings);
         }));
  v.require(!axis.points.empty(), "points", "is empty; give it one point at least");
  v.require(names_differ(axis.points, &ExperimentPoint::label), "points",
            "has a label twice, or an empty one; give each a line of its own");
}

}  // namespace

void fields(FieldVisitor& v, Experiment& e) {
  version_field(v);
  v.text({"title", "one line, over every plot", kRequired}, e.title);
  v.text({"notes", "what is asked, and why the numbers are what they are"}, e.notes);
  v.text({"scenario", "the file that is varied, relative to this one", kRequired}, e.scenario);
  whole(v, {"runs", "of each cell", kRequired}, {1.0, 1e6}, e.runs);
  whole(v, {"first_seed", "of the first run of every cell; the next one's is greater by 1"},
        {0.0, 9e15}, e.first_seed);
  v.number({"duration_max_s", "in place of the scenario's"}, {1.0, 86400.0, "s"}, e.duration_max_s);
  v.list({"reported_sites", "told to the nearest free vehicle that can survey, at fixed times"},
         unique_groups_of(e.reported_sites, kListMax, reported_site_fields, "site",
                          [](const ReportedSite& reported) { return reported.site.value; }));
  // A list of one, so that it can be left out and its keys be required all the same.
  std::vector<RandomTeam> teams;
  if (e.team) teams.push_back(*e.team);
  v.list({"random_team", "fleets drawn with the run's seed; left out: the scenario's fleet"},
         groups_of(teams, 1, team_fields));
  e.team = teams.empty() ? std::nullopt : std::optional{teams.front()};
  auto chart = static_cast<std::size_t>(e.chart);
  v.choice({"chart", "how the first axis is drawn"}, kCharts, chart);
  e.chart = static_cast<ExperimentChart>(chart);
  v.section({"settings", "of every cell; a point's go before them"},
            [&e](FieldVisitor& inner) { settings_fields(inner, e.settings); });
  v.list({"axes", "the cells are all combinations of their points", kRequired},
         groups_of(e.axes, kAxesMax, axis_fields));
  v.require(!e.axes.empty(), "axes", "is empty; give it one axis at least");
  v.require(names_differ(e.axes, &ExperimentAxis::name), "axes",
            "has a name twice, or an empty one; give each a line of its own");
}

}  // namespace skein::configuration
