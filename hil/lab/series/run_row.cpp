// SPDX-License-Identifier: Apache-2.0
#include "skein/series/run_row.hpp"

#include <fmt/format.h>

#include <optional>

#include "skein/hil/team_mission.hpp"
#include "skein/shards/csv.hpp"

namespace skein::series {
namespace {

using shards::number_of;

constexpr std::size_t kTexts = 5;  ///< of a broken check

std::string field_of(const std::vector<Broken>& broken) {
  if (broken.empty()) return "";
  std::vector<std::string> texts;
  for (const Broken& check : broken) {
    texts.insert(texts.end(),
                 {check.check, std::to_string(check.violations), fmt::format("{}", check.first_s),
                  std::to_string(check.vehicle.value), check.sentence});
  }
  return shards::joined(texts);
}

std::optional<std::vector<Broken>> broken_of(const std::string& field) {
  std::vector<Broken> broken;
  if (field.empty()) return broken;
  const auto texts = shards::parted(field);
  if (texts.size() % kTexts != 0) return {};
  for (std::size_t i = 0; i < texts.size(); i += kTexts) {
    const auto violations = number_of<std::size_t>(texts[i + 1]);
    const auto first_s = number_of<double>(texts[i + 2]);
    const auto vehicle = number_of<decltype(VehicleId::value)>(texts[i + 3]);
    if (!violations || !first_s || !vehicle) return {};
    broken.push_back({texts[i], *violations, *first_s, VehicleId{*vehicle}, texts[i + 4]});
  }
  return broken;
}

}  // namespace

RunRow row_of(const hil::JudgedRun& run) {
  RunRow row;
  row.seed = run.seed;
  row.done = run.sites_done;
  row.ended_s = to_seconds(run.result.ended_at);
  row.excused = run.excused.size();
  for (const auto& check : run.broken) {
    const auto& first = check.violations.front();
    row.broken.push_back({check.name, check.violations.size(), to_seconds(first.time),
                          first.vehicle, first.sentence});
  }
  return row;
}

RunRow row_of(const hil::FormationRun& run) {
  RunRow row;
  row.seed = run.seed;
  row.done = run.script_done;
  row.ended_s = to_seconds(run.ended_at);
  row.least_m = run.least_m;
  row.lost = run.lost;
  row.reason = run.script_done ? "" : run.reason;
  for (const auto& violation : run.violations)
    row.broken.push_back({violation.check, 1, to_seconds(violation.time), {}, violation.sentence});
  return row;
}

Flight flight_of(const configuration::Scenario& scenario, const std::string& faults) {
  const bool formation = scenario.flies_formation();
  return [&scenario, faults, formation,
          limits = hil::limits_of(scenario.expect)](std::uint64_t seed) -> Result<RunRow> {
    const auto mission = hil::seeded_mission(scenario, seed, faults);
    if (!mission) return mission.error();
    if (!formation) return row_of(hil::fly_judged(*mission, limits));
    const auto run = hil::fly_formation(*mission);
    if (!run) return run.error();
    return row_of(*run);
  };
}

std::vector<std::string> row_columns(bool formation) {
  if (formation) return {"seed", "script_done", "ended_s", "broken", "least_m", "lost", "reason"};
  return {"seed", "sites_done", "ended_s", "broken", "excused"};
}

std::vector<std::string> row_fields(const RunRow& row, bool formation) {
  // Numbers are the shortest text that reads back as the same.
  std::vector<std::string> fields{std::to_string(row.seed), row.done ? "1" : "0",
                                  fmt::format("{}", row.ended_s), field_of(row.broken)};
  if (!formation) {
    fields.push_back(std::to_string(row.excused));
    return fields;
  }
  fields.push_back(fmt::format("{}", row.least_m));
  fields.push_back(std::to_string(row.lost));
  fields.push_back(shards::joined({row.reason}));
  return fields;
}

Result<RunRow> parse_row(const std::vector<std::string>& fields, bool formation) {
  RunRow row;
  const auto seed = number_of<std::uint64_t>(fields[0]);
  if (!seed) return Error{"has no seed"};
  row.seed = *seed;
  row.done = fields[1] == "1";
  const auto ended_s = number_of<double>(fields[2]);
  auto broken = broken_of(fields[3]);
  const auto bad = [](const std::string& field) {
    return Error{"has \"" + field + "\", which this program does not write there"};
  };
  if (!row.done && fields[1] != "0") return bad(fields[1]);
  if (!ended_s) return bad(fields[2]);
  if (!broken) return bad(fields[3]);
  row.ended_s = *ended_s;
  row.broken = std::move(*broken);
  if (!formation) {
    const auto excused = number_of<std::size_t>(fields[4]);
    if (!excused) return bad(fields[4]);
    row.excused = *excused;
    return row;
  }
  const auto least_m = number_of<double>(fields[4]);
  if (!least_m) return bad(fields[4]);
  const auto lost = number_of<std::size_t>(fields[5]);
  if (!lost) return bad(fields[5]);
  row.least_m = *least_m;
  row.lost = *lost;
  row.reason = shards::parted(fields[6]).front();
  return row;
}

}  // namespace skein::series
