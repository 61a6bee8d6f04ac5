// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "skein/series/run_row.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::series {

/// Kinds of shards::Series.
inline constexpr const char* kSites = "sites";
inline constexpr const char* kFormation = "formation";

/// What was broken, a line each: the first violation of each check; of a formation every pair's.
[[nodiscard]] std::string broken_lines(const RunRow& row, bool formation);

/// What a series of runs came to, for people: failures first, each with the command that flies it
/// again. It grows with the failures that it shows, not with the runs.
class Summary {
 public:
  /// `program` is how it was called.
  Summary(shards::Series series, std::string program);
  /// In the order of seeds, so that its means are the same to the last bit wherever it was flown.
  void add(const RunRow& row);
  /// Several lines. Precondition: one run was added.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::size_t runs() const { return runs_; }
  /// Every check of every run.
  [[nodiscard]] bool held() const { return violated_ == 0; }

 private:
  [[nodiscard]] std::string again(const RunRow& row) const;
  [[nodiscard]] std::string of_sites() const;
  [[nodiscard]] std::string of_formation() const;

  shards::Series series_;
  std::string program_;
  bool formation_;
  std::size_t runs_ = 0;
  std::size_t violated_ = 0;
  std::size_t done_ = 0;
  std::uint64_t first_seed_ = 0;
  std::uint64_t last_seed_ = 0;
  std::string failures_;                       ///< those that are told of in full
  std::map<std::string, std::size_t> checks_;  ///< in how many runs each was broken
  double done_s_ = 0.0;                        ///< of the runs that were done, all together
  double least_s_ = 0.0;
  double most_s_ = 0.0;
  std::size_t excused_runs_ = 0;
  std::size_t excused_ = 0;
  std::string excused_seeds_;
  double all_s_ = 0.0;
  double least_m_ = 1e9;
  std::size_t lost_ = 0;
  std::map<std::string, std::size_t> reasons_;  ///< without their numbers
};

}  // namespace skein::series
