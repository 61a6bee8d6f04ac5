// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/measures.hpp"
#include "skein/shards/row_file.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::experiments {

/// Kind of shards::Series.
inline constexpr const char* kSweep = "sweep";

/// Runs that were flown, on disk as they come: FOLDER/runs.csv, a row a run, axes' labels first.
/// Beside it lie experiment.yaml, scenario.yaml and series.txt: what was flown.
class RunTable {
 public:
  /// Opens the folder's table or begins one. A last row that was cut off is removed. Fails where
  /// the folder holds another experiment, or runs of another version of the program; how many runs
  /// are asked for, titles and notes may differ, and so may the shard and the experiment's `file`,
  /// which are noted for who merges.
  [[nodiscard]] static Result<RunTable> open(const std::filesystem::path& folder,
                                             const configuration::Experiment& experiment,
                                             const configuration::Scenario& base,
                                             const shards::Shard& shard = {},
                                             const std::filesystem::path& file = {});

  [[nodiscard]] bool has(std::size_t cell, std::uint64_t seed) const {
    return rows_.contains({cell, seed});
  }
  /// Appends a row and hands it to the system. Precondition: !has(cell, seed). Fails when the disk
  /// is full.
  [[nodiscard]] Result<void> append(std::size_t cell, std::uint64_t seed, const Measures& measures);

  /// Takes over the rows of another folder of the same experiment. Fails where a run is here
  /// already with other values.
  [[nodiscard]] Result<void> take_over(const std::filesystem::path& folder);
  /// Brings the rows into the order in which one machine flies them.
  [[nodiscard]] Result<void> sort() { return file_->sort(); }

  /// The measures: measure_columns(), then when each site's coalition stood.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// What there is of one measure in one cell, by seed, of seeds below `seed_end`.
  [[nodiscard]] std::vector<double> values(std::size_t cell, std::size_t column,
                                           std::uint64_t seed_end) const;

 private:
  /// Of one run, one for each of columns(); no number where the measure has no meaning.
  using Values = std::vector<double>;

  RunTable() = default;
  [[nodiscard]] std::vector<std::string> header() const;
  [[nodiscard]] Result<shards::RowKey> read(const std::vector<std::string>& fields);

  std::vector<std::string> axes_;
  std::vector<std::vector<std::string>> labels_;  ///< of each cell
  std::vector<SiteId> sites_;
  std::vector<std::string> columns_;
  std::map<std::pair<std::size_t, std::uint64_t>, Values> rows_;  ///< by cell, seed
  std::optional<shards::RunFolder> folder_;
  std::optional<shards::RowFile> file_;
};

/// Whether the experiments and scenarios that two folders keep are the same; the sentence names
/// both files.
[[nodiscard]] Result<void> same_experiment(const std::filesystem::path& folder,
                                           const std::filesystem::path& other);

}  // namespace skein::experiments
