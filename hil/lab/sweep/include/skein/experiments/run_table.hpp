// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/measures.hpp"

namespace skein::experiments {

/// Runs that were flown, on disk as they come: FOLDER/runs.csv, a row a run, axes' labels first.
/// Beside it lie experiment.yaml and scenario.yaml, as they were when the first run was flown.
class RunTable {
 public:
  /// Of one run, one for each of columns(); nothing where the measure has no meaning.
  using Values = std::vector<std::optional<double>>;

  /// Opens the folder's table or begins one. A last row that was cut off is removed. Fails where
  /// the folder holds another experiment; how many runs are asked for, titles and notes may differ.
  [[nodiscard]] static Result<RunTable> open(const std::filesystem::path& folder,
                                             const configuration::Experiment& experiment,
                                             const configuration::Scenario& base);

  [[nodiscard]] bool has(std::size_t cell, std::uint64_t seed) const {
    return rows_.contains({seed, cell});
  }
  /// Appends a row and hands it to the system. Precondition: !has(cell, seed). Fails when the disk
  /// is full.
  [[nodiscard]] Result<void> append(std::size_t cell, std::uint64_t seed, const Measures& measures);

  /// The measures: measure_columns(), then when each site's coalition stood.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// What there is of one measure in one cell, by seed, of seeds below `seed_end`.
  [[nodiscard]] std::vector<double> values(std::size_t cell, std::size_t column,
                                           std::uint64_t seed_end) const;

 private:
  RunTable() = default;
  [[nodiscard]] Result<void> read(const std::filesystem::path& file);
  [[nodiscard]] std::string header() const;

  std::vector<std::string> axes_;
  std::vector<std::vector<std::string>> labels_;  ///< of each cell
  std::vector<SiteId> sites_;
  std::vector<std::string> columns_;
  std::map<std::pair<std::uint64_t, std::size_t>, Values> rows_;  ///< by seed, cell
  std::string name_;
  std::ofstream out_;
};

}  // namespace skein::experiments
