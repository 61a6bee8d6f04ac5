// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/formation_runs.hpp"
#include "skein/hil/judged_runs.hpp"

/// Many seeds of one scenario: what is kept of each run, and what they come to.
namespace skein::series {

/// A check that did not hold. Of a formation there is one for each pair of vehicles.
struct Broken {
  std::string check;
  std::size_t violations = 1;
  double first_s = 0.0;  ///< of the mission; of the first of them
  VehicleId vehicle;     ///< whose it is; with sites
  std::string sentence;
  auto operator<=>(const Broken&) const = default;
};

/// What is kept of a run: what the list of failures and the summary need.
struct RunRow {
  std::uint64_t seed = 0;
  bool done = false;     ///< all sites, or the script
  double ended_s = 0.0;  ///< of the mission
  std::vector<Broken> broken;
  std::size_t excused = 0;  ///< with sites: violations that were proven to be unavoidable
  double least_m = 0.0;     ///< of a formation, from here on: as FormationRun says
  std::size_t lost = 0;
  std::string reason;
  [[nodiscard]] bool held() const { return broken.empty(); }
  bool operator==(const RunRow&) const = default;
};

[[nodiscard]] RunRow row_of(const hil::JudgedRun& run);
[[nodiscard]] RunRow row_of(const hil::FormationRun& run);

/// Flies the seed in the calling thread. Fails where the fault profiles or a script are wrong.
using Flight = std::function<Result<RunRow>(std::uint64_t seed)>;
/// Of the scenario, which the caller keeps.
[[nodiscard]] Flight flight_of(const configuration::Scenario& scenario, const std::string& faults);

/// Columns of a table on disk; formations have others. A row reads back as the same.
[[nodiscard]] std::vector<std::string> row_columns(bool formation);
[[nodiscard]] std::vector<std::string> row_fields(const RunRow& row, bool formation);
/// Fails with what is wrong: "has no seed". Precondition: as many as row_columns().
[[nodiscard]] Result<RunRow> parse_row(const std::vector<std::string>& fields, bool formation);

}  // namespace skein::series
