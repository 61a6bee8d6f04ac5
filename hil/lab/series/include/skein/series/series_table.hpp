// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/series/run_row.hpp"
#include "skein/series/summary.hpp"
#include "skein/shards/row_file.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::series {

/// The scenario's text by which two are told apart, wherever their files lie: its shapes and tracks
/// are in it, its title, notes and seed are not.
[[nodiscard]] std::string identity(configuration::Scenario scenario);

/// Runs of one scenario on disk as they come: FOLDER/runs.csv, a row a run; scenario.yaml and
/// series.txt say of what.
class SeriesTable {
 public:
  /// Opens the folder's table or begins one; `scenario` is the text of identity(). A last row that
  /// was cut off is removed. Fails where the folder's runs are of another scenario, other faults,
  /// or another version of the program.
  [[nodiscard]] static Result<SeriesTable> open(const std::filesystem::path& folder,
                                                const shards::Series& series,
                                                const std::string& scenario);

  /// The seeds of the series, or of its shard, of which there is no row.
  [[nodiscard]] std::vector<std::uint64_t> missing() const;
  /// How many runs are here that are none of the series, or of its shard.
  [[nodiscard]] std::size_t others() const;
  /// Precondition: none of this seed is there.
  [[nodiscard]] Result<void> append(const RunRow& row);
  /// Takes over the rows of another folder of the same series. Fails where a run is here already
  /// with other values.
  [[nodiscard]] Result<void> take_over(const std::filesystem::path& folder);
  /// Brings the rows into the order of seeds.
  [[nodiscard]] Result<void> sort() { return rows_.sort(); }
  /// Of the series' runs that are here; `program` as Summary takes it.
  [[nodiscard]] Result<Summary> summary(const std::string& program) const;

 private:
  SeriesTable(shards::RunFolder folder, shards::RowFile rows, shards::Series series)
      : folder_{std::move(folder)}, rows_{std::move(rows)}, series_{std::move(series)} {}

  /// Of the series, or of its shard.
  [[nodiscard]] std::vector<std::uint64_t> seeds() const;

  shards::RunFolder folder_;
  shards::RowFile rows_;
  shards::Series series_;
};

/// The text of identity() that a folder keeps.
[[nodiscard]] std::string scenario_of(const std::filesystem::path& folder);
/// Whether two folders keep the same scenario; the sentence names both files.
[[nodiscard]] Result<void> same_scenario(const std::filesystem::path& folder,
                                         const std::filesystem::path& other);
/// FOLDER/summary.txt.
[[nodiscard]] Result<void> write_summary(const Summary& summary,
                                         const std::filesystem::path& folder);

}  // namespace skein::series
