// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/checks/run_record.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// Tasks that a team that lost vehicles need not have done: deliveries that may have been flown by
/// who fell silent, and all open tasks of a site for which those that are left are too few, each
/// doing one of them, with the loads that they still have.
[[nodiscard]] std::vector<checks::Excuse> excuses(const checks::RunRecord& record,
                                                  const std::vector<VehicleEnd>& vehicles);

}  // namespace skein::hil
