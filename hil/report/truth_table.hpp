// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "skein/checks/run_record.hpp"

namespace skein::report {

/// What was planned, believed and true, in cells: aircraft first, then deliveries.
struct TruthTable {
  static constexpr std::size_t kColumns = 5;
  using Row = std::array<std::string, kColumns>;
  Row head{"", "", "across / in time", "along / miss", "height / bearing"};
  std::vector<Row> rows;  ///< none where no truth is known
};
[[nodiscard]] TruthTable truth_table(const checks::RunRecord& record, const checks::Limits& limits);

}  // namespace skein::report
