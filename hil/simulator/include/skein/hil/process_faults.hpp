// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/fault.hpp"

/// Faults for a mission of processes, drawn from its seed: those of the simulator's profiles that
/// can be done to processes, and what only processes have. As there, all lie in a phase at the
/// start; then the radio heals, and what remains of the team must finish its work.
namespace skein::hil {

/// The names of the profiles, in the order of the documentation.
[[nodiscard]] std::vector<std::string_view> process_profiles();

/// "stall", "crash,disk", ...: the profiles together; `nemesis` draws several with the seed. The
/// scenario is given what is not of one moment: later hazards, the operator's decisions, the
/// longest duration, fuel and reach (add_faults()); what goes wrong besides is the result.
/// `other_release`: there is one to fly some vehicles with. Fails with the names that there are,
/// for a formation, and for another release that is not there.
[[nodiscard]] Result<std::vector<Fault>> spoil(configuration::Scenario& scenario,
                                               const std::string& profiles, bool other_release);

}  // namespace skein::hil
