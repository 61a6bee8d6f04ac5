// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/process_faults.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "skein/base/contains.hpp"
#include "skein/base/random.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Keeps the draw apart from that of the simulator's faults, which starts from the same seed.
constexpr std::uint64_t kProcessStream = 0x70726f6365737301;
constexpr std::uint64_t kNemesisStream = 0x70726f6365737302;
/// Real seconds: about half of the simulator's.
constexpr Duration kPhase = seconds{40};

/// How much of what only processes have; counts are the most that is drawn.
struct Params {
  std::size_t stalls = 0;
  std::size_t slow = 0;
  std::size_t flapping = 0;
  std::size_t disks = 0;
  std::size_t steps = 0;
  std::size_t others = 0;  ///< vehicles of the other release
  std::size_t ground = 0;  ///< restarts of the ground station while somebody leads
};

struct Profile {
  std::string_view name;
  void (*add)(Params&) = nullptr;  ///< null: the simulator's of that name, alone
  bool of_simulator = false;       ///< and the simulator's
  double chance = 0.0;             ///< that `nemesis` has it
};

constexpr std::array kProfiles{Profile{"none"},
                               Profile{"lossy", nullptr, true, 0.2},
                               Profile{"partition", nullptr, true, 0.35},
                               Profile{"flapping", [](Params& p) { p.flapping = 2; }, false, 0.25},
                               Profile{"crash", nullptr, true, 0.45},
                               Profile{"ground", [](Params& p) { p.ground = 2; }, false, 0.4},
                               Profile{"stall", [](Params& p) { p.stalls = 4; }, false, 0.4},
                               Profile{"slow", [](Params& p) { p.slow = 3; }, false, 0.3},
                               Profile{"disk", [](Params& p) { p.disks = 3; }, false, 0.3},
                               Profile{"steps", [](Params& p) { p.steps = 2; }, false, 0.3},
                               Profile{"clocks", nullptr, true, 0.2},
                               Profile{"clock", nullptr, true, 0.0},
                               Profile{"hazards", nullptr, true, 0.0},
                               Profile{"operator", nullptr, true, 0.0},
                               Profile{"versions", [](Params& p) { p.others = 4; }, false, 0.3}};

const Profile* profile_of(std::string_view name) {
  const auto* const found = std::ranges::find(kProfiles, name, &Profile::name);
  return found == kProfiles.end() ? nullptr : &*found;
}

Duration between(Random& random, Duration low, Duration high) {
  return from_seconds(random.uniform(to_seconds(low), to_seconds(high)));
}

/// At least one.
std::size_t some(Random& random, std::size_t most) {
  return most == 0 ? 0 : 1 + static_cast<std::size_t>(random.index(most));
}

class Draw {
 public:
  Draw(const configuration::Scenario& scenario, const Params& params)
      : scenario_{scenario}, params_{params}, random_{scenario.seed ^ kProcessStream} {}

  std::vector<Fault> faults() {
    for (std::size_t n = some(random_, params_.ground); n > 0; --n) restart_ground();
    for (std::size_t n = some(random_, params_.stalls); n > 0; --n) {
      faults_.push_back(draw_stall(random_, kPhase));
    }
    for (std::size_t n = some(random_, params_.slow); n > 0; --n) slow();
    for (std::size_t n = some(random_, params_.flapping); n > 0; --n) flap();
    for (std::size_t n = some(random_, params_.disks); n > 0; --n) fill_disk();
    for (std::size_t n = some(random_, params_.steps); n > 0; --n) step_clock();
    std::vector<VehicleId> others;
    for (std::size_t n = some(random_, params_.others); n > 0; --n) {
      const VehicleId one = anyone();
      if (contains(others, one)) continue;
      others.push_back(one);
      faults_.push_back({{}, {}, OtherRelease{one}});
    }
    return std::move(faults_);
  }

 private:
  VehicleId anyone() {
    return scenario_.vehicles[random_.index(scenario_.vehicles.size())].spec.id;
  }
  Instant moment() { return Instant{} + between(random_, seconds{1}, kPhase); }

  /// At any moment, or where a request for authorisation may wait for its answer.
  void restart_ground() {
    Fault fault;
    fault.when.not_before = moment();
    fault.when.not_after = Instant{} + kPhase;
    if (random_.chance(0.5)) {
      fault.when.not_before = Instant{};
      fault.when.role = Role::leader;
      fault.when.after = between(random_, Duration{}, seconds{8});
    }
    fault.what = ProgramsEnd{{kGroundStation}};
    fault.lasts = between(random_, milliseconds{200}, seconds{15});
    faults_.push_back(std::move(fault));
  }

  void slow() {
    const VehicleId node = random_.chance(0.15) ? kGroundStation : anyone();
    const Instant from = Instant{} + between(random_, Duration{}, kPhase * 2 / 3);
    const Duration lasts = between(random_, seconds{3}, kPhase);
    faults_.push_back({{.not_before = from}, lasts, ProgramSlow{node, random_.uniform(0.3, 0.7)}});
  }

  /// A link that comes and goes.
  void flap() {
    std::vector<VehicleId> group;
    for (const auto& vehicle : scenario_.vehicles) {
      if (random_.chance(0.4)) group.push_back(vehicle.spec.id);
    }
    if (random_.chance(0.3)) group.push_back(kGroundStation);
    const auto kind = random_.chance(0.5) ? radio::Cut::Kind::both_ways : radio::Cut::Kind::one_way;
    Instant at = Instant{} + between(random_, Duration{}, kPhase / 2);
    for (std::size_t n = 3 + random_.index(8); n > 0 && at < Instant{} + kPhase; --n) {
      const Duration cut = between(random_, milliseconds{200}, seconds{3});
      const Duration lasts = std::min(cut, Instant{} + kPhase - at);
      faults_.push_back({{.not_before = at}, lasts, radio::cut_off(group, kind)});
      at += cut + between(random_, milliseconds{200}, seconds{3});
    }
  }

  void fill_disk() {
    const VehicleId node = random_.chance(0.2) ? kGroundStation : anyone();
    faults_.push_back({{.not_before = moment()}, {}, DiskFull{node}});
  }

  /// A program that runs does not look at it: what starts anew afterwards does.
  void step_clock() {
    const VehicleId vehicle = anyone();
    const bool much = random_.chance(0.5);
    const Duration by = much ? between(random_, seconds{1}, seconds{5})
                             : between(random_, milliseconds{20}, milliseconds{240});
    const Instant at = moment();
    faults_.push_back({{.not_before = at}, {}, ClockStep{vehicle, random_.chance(0.5) ? by : -by}});
    faults_.push_back({{.not_before = at + between(random_, milliseconds{100}, seconds{4})},
                       between(random_, milliseconds{300}, seconds{6}),
                       ProgramsEnd{{vehicle}}});
  }

  const configuration::Scenario& scenario_;
  Params params_;
  Random random_;
  std::vector<Fault> faults_;
};

Result<std::vector<std::string>> names_in(const std::string& list) {
  return fault_names(list, process_profiles(), [](const std::string& name) {
    return contains(fault_profiles(MissionKind::sites), std::string_view{name})
               ? "the faults '" + name + "' are done in virtual time only"
               : "there is no fault profile '" + name + "' of processes";
  });
}

/// What `nemesis` is with that seed.
std::vector<std::string> several(std::uint64_t seed, bool other_release) {
  Random random{seed ^ kNemesisStream};
  std::vector<std::string> names;
  for (const Profile& profile : kProfiles) {
    const bool drawn = random.chance(profile.chance);
    if (drawn && (profile.name != "versions" || other_release)) names.emplace_back(profile.name);
  }
  if (names.empty()) names.emplace_back("crash");
  return names;
}

/// What the draw has done to a mission that is not a fault of one moment.
void take_over(const TeamMission& mission, configuration::Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
    scenario.vehicles[i].spec.range_m = mission.vehicles[i].spec.range_m;
  }
  scenario.hazards = mission.hazards;
  scenario.operator_decisions.clear();
  for (const auto& d : mission.decisions) {
    scenario.operator_decisions.push_back({d.site, d.grant, d.reaction, d.not_before});
  }
  scenario.protocol.radio_range_m = mission.protocol.radio_range_m;
  scenario.duration_max = mission.duration_max;
}

/// Another release may not know how to be told its clock. Taken out last, so that what else is
/// drawn is what it was.
std::vector<Fault> without_clocks_of_others(const std::vector<Fault>& faults) {
  std::vector<Fault> kept;
  for (const Fault& fault : faults) {
    const auto* off = std::get_if<ClockOff>(&fault.what);
    const auto* step = std::get_if<ClockStep>(&fault.what);
    const bool of_other = (off != nullptr && is_of_other_release(faults, off->node)) ||
                          (step != nullptr && is_of_other_release(faults, step->vehicle));
    if (!of_other) kept.push_back(fault);
  }
  return kept;
}

}  // namespace

std::vector<std::string_view> process_profiles() {
  std::vector<std::string_view> names;
  for (const Profile& profile : kProfiles) names.push_back(profile.name);
  names.emplace_back("nemesis");
  return names;
}

Result<std::vector<Fault>> spoil(configuration::Scenario& scenario, const std::string& profiles,
                                 bool other_release) {
  auto listed = names_in(profiles);
  if (!listed) return listed.error();
  std::vector<std::string> names;
  for (const std::string& name : *listed) {
    if (name == "nemesis") {
      for (auto& one : several(scenario.seed, other_release)) names.push_back(std::move(one));
    } else if (name != "none") {
      names.push_back(name);
    }
  }
  if (names.empty()) return std::vector<Fault>{};
  if (scenario.flies_formation() || scenario.sites.empty()) {
    return Error{"faults are drawn for missions with sites; leave --faults out"};
  }
  if (contains(names, "versions") && !other_release) {
    return Error{"the faults 'versions' need another release; --other-bin names its programs"};
  }
  Params params;
  std::string of_simulator;
  for (const std::string& name : names) {
    const Profile* const profile = profile_of(name);
    if (profile->add != nullptr) profile->add(params);
    if (profile->of_simulator) of_simulator += (of_simulator.empty() ? "" : ",") + name;
  }
  auto drawn = fault_params(of_simulator.empty() ? "none" : of_simulator, scenario.seed);
  if (!drawn) return drawn.error();
  drawn->phase = kPhase;
  drawn->bound = kDoneWithin;
  TeamMission mission = team_mission(scenario);
  const std::size_t own = mission.faults.size();
  add_faults(mission, *drawn);
  take_over(mission, scenario);
  std::vector<Fault> faults{mission.faults.begin() + static_cast<std::ptrdiff_t>(own),
                            mission.faults.end()};
  for (Fault& fault : Draw{scenario, params}.faults()) faults.push_back(std::move(fault));
  return without_clocks_of_others(faults);
}

}  // namespace skein::hil
