// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "skein/checks/run_record.hpp"
#include "skein/hil/bench.hpp"
#include "skein/recording/recording.hpp"

namespace skein::hil {

/// What a node's programs have recorded, one after the other, as one recording in true time, with
/// what others heard of it and its own files have not: of who is killed the last second, of who has
/// a full disk all that comes then.
[[nodiscard]] recording::Recording whole_recording(const std::filesystem::path& run_folder,
                                                   VehicleId node, const BenchOutcome& outcome);

/// Adds to a record of such recordings, with truths, what faults have done to programs: when none
/// ran or it stood still, where the aircraft really was meanwhile, and what need not be done, as
/// the radio has healed and a part of the team is gone.
void add_faults_done(checks::RunRecord& record, const BenchOutcome& outcome);

}  // namespace skein::hil
