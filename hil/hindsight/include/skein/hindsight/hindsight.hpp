// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/checks/run_record.hpp"

/// How near a flown mission came to the best that could have been flown by somebody who knew every
/// site, hazard and vehicle from its start: no searching, no radio, no bids, no operator to wait
/// for. What is best is a coupled problem (skein/coupled/coupled.hpp).
namespace skein::hindsight {

/// A figure as flown, as it could have been, and what it could not have been better than.
struct Figure {
  std::optional<double> flown;  ///< none where not all tasks were done
  double best = 0.0;            ///< of a plan that was found
  std::optional<double> bound;  ///< of every plan; none where the search has none
  bool proven = false;          ///< no plan is better than `best`
};

struct SiteFigure {
  SiteId site;
  Figure end_s;  ///< when its last task ended, in mission time; the best is of this site alone
};

struct Hindsight {
  Figure end_s;   ///< when the last task of all ended, in mission time
  Figure reward;  ///< J1 of Wang 2022, eq. (9): of each task F exp(-beta t), over the sum of F
  std::vector<SiteFigure> sites;
};

/// Nodes of each search. 32 vehicles and 3 sites of 14 tasks each take some 7 s with the first, and
/// 1 s with the second.
inline constexpr std::uint64_t kSteps = 20'000;
inline constexpr std::uint64_t kFewSteps = 2'000;

/// Vehicles are where their tracks begin, and fly at cruise speed and their planning radius as they
/// do when they plan; hazards that appear in the mission are left out. Times begin with it. Fails
/// where there is nothing to compare (no sites, no vehicle's track), the problem is larger than the
/// search takes, or nobody can do a task.
[[nodiscard]] Result<Hindsight> look_back(const checks::RunRecord& record,
                                          const checks::Limits& limits,
                                          std::uint64_t steps = kSteps);

/// What people read of a figure, with its unit; "-" where there is none.
struct Row {
  std::string what;
  std::string flown;
  std::string best;
  std::string bound;  ///< "proven": the best is it
  std::string ratio;  ///< flown over best
};
/// The mission's figures, then each site's.
[[nodiscard]] std::vector<Row> table_of(const Hindsight& hindsight);
/// The same as text, with a head.
[[nodiscard]] std::string text_of(const Hindsight& hindsight);
/// The same of what look_back() gave, or why nothing is compared.
[[nodiscard]] std::string comparison_text(const Result<Hindsight>& looked);

}  // namespace skein::hindsight
