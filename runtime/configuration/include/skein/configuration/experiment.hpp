// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::configuration {

/// What an experiment puts in place of the scenario's own values. Absent: the scenario's.
struct ExperimentSettings {
  std::optional<std::uint16_t> vehicles;  ///< of a random team
  std::optional<planning::AllocationMethod> allocation;
  /// All sites are known, and tasked by it before take-off; absent: the team searches.
  std::optional<planning::Criterion> tasked_by;
  std::optional<MeshKind> mesh;         ///< with it nobody is out of the protocol's reach
  std::optional<double> radio_range_m;  ///< r_n, of the radio and of the protocol
  std::optional<double> relay_orbit_m;  ///< 0: no relay orbits
  /// dt_d of the protocol; the radio's own delays are spread evenly from 0 to it.
  std::optional<double> message_delay_s;
  std::optional<double> radio_delay_s;       ///< of every message, in place of that spread
  std::optional<double> allocation_time_s;   ///< t_TA
  std::optional<double> formation_margin_s;  ///< delta_t
  std::optional<double> lease_s;
  std::optional<double> silence_s;
  std::optional<double> authorisation_lead_s;
};

/// One value of an axis.
struct ExperimentPoint {
  std::string label;
  ExperimentSettings settings;
};

/// One parameter that is varied, or several that are varied together.
struct ExperimentAxis {
  std::string name;
  std::vector<ExperimentPoint> points;
};

/// Fleets drawn with the run's seed. Kinds follow in shuffled copies of the scenario's fleet, so
/// that their shares are the scenario's; of two counts the smaller team is part of the larger.
struct RandomTeam {
  double west_m = 0.0;  ///< starts lie evenly between these, clear of hazards
  double east_m = 0.0;
  double south_m = 0.0;
  double north_m = 0.0;
  /// Each vehicle searches from point to point, each near a site drawn by lot, as far as this share
  /// of its range; 0: it stays where it starts.
  double search_share = 1.0;
  double search_radius_m = 1000.0;  ///< how near
};

/// The site is told, from that time on, to the nearest vehicle that can survey and is searching.
struct ReportedSite {
  SiteId site;
  Instant at{};
};

enum class ExperimentChart : std::uint8_t { lines, bars, count };

/// A grid of parameters over a scenario, flown many times (docs/experiments.md).
struct Experiment {
  std::string title;
  std::string notes;
  std::string scenario;          ///< path, relative to the experiment's file
  std::size_t runs = 1;          ///< of each cell
  std::uint64_t first_seed = 1;  ///< run k of every cell has the seed first_seed + k
  std::optional<double> duration_max_s;
  std::vector<ReportedSite> reported_sites;  ///< the others are found by who flies near
  std::optional<RandomTeam> team;            ///< absent: the scenario's fleet
  ExperimentChart chart = ExperimentChart::lines;
  ExperimentSettings settings;       ///< of every cell; a point's go before them
  std::vector<ExperimentAxis> axes;  ///< the cells are all combinations of their points
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<Experiment> load_experiment(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<Experiment> parse_experiment(std::string_view yaml, const std::string& name);
/// What load_experiment reads back as the same struct.
[[nodiscard]] std::string to_yaml(const Experiment& experiment);

}  // namespace skein::configuration
