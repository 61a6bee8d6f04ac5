// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/fault_profiles.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"
#include "skein/base/random.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Keeps the draw of faults apart from the radio's, which starts from the same seed.
constexpr std::uint64_t kFaultStream = 0x6661756c74730001;
constexpr std::uint64_t kMixStream = 0x6661756c74730002;
/// A hazard that appears leaves this much room around a site's final approaches.
constexpr double kSiteRoom_m = 60.0;
constexpr double kEverywhere_m = 1e6;
constexpr Duration kHeldBackMax = seconds{2};
constexpr std::size_t kLostMax = 2;
constexpr double kLayer_m = 15.0;
/// From here on vehicles are numbered that fly under a number of the team.
constexpr std::size_t kDoubles = 60000;
/// Of all together: as much as a coalition of eight needs for its bids to arrive in time.
constexpr double kNarrow_bytes_per_s = 12e3;
/// What the operator orders whose battery has fallen, and when; once more where it was not heard.
constexpr std::array<std::pair<Duration, mission::CommandKind>, 4> kBringDown{
    {{seconds{40}, mission::CommandKind::return_home},
     {seconds{80}, mission::CommandKind::land},
     {seconds{120}, mission::CommandKind::return_home},
     {seconds{160}, mission::CommandKind::land}}};

// --- in the changes of a formation ---

/// Keeps the draw apart from what else starts from the same seed.
constexpr std::uint64_t kFormationStream = 0x666f726d66617501;
constexpr Duration kClockMax = milliseconds{10};
constexpr Duration kHeldBackInFormation = seconds{1};
/// A change takes about so long.
constexpr Duration kChange = seconds{9};

struct Draw {
  const std::vector<VehicleId>& vehicles;
  std::size_t changes = 1;
  Random random;
  std::vector<Fault> faults = {};

  Duration between(Duration low, Duration high) {
    return from_seconds(random.uniform(to_seconds(low), to_seconds(high)));
  }
  VehicleId anyone() { return vehicles[random.index(vehicles.size())]; }
  When in_a_change() {
    When when;
    when.change = random.index(changes);
    when.after = between(Duration{}, kChange);
    return when;
  }
};

void no_fault(Draw& /*draw*/) {}

void lose(Draw& draw, std::optional<VehicleId> who) {
  const When when = draw.in_a_change();
  const VehicleId other = draw.vehicles[1 + draw.random.index(draw.vehicles.size() - 1)];
  ProgramsEnd lost{{who.value_or(other)}};
  const bool sinks = draw.random.chance(0.5);
  const Duration after = draw.between(seconds{0}, seconds{30});
  if (sinks) lost.sinks_after = after;
  draw.faults.push_back({when, std::nullopt, lost});
}
void lost_vehicle(Draw& draw) { lose(draw, std::nullopt); }
void lost_leader(Draw& draw) { lose(draw, draw.vehicles.front()); }

void lost_ground(Draw& draw) {
  const When when = draw.in_a_change();
  const bool for_good = draw.random.chance(0.3);
  const Duration lasts = draw.between(seconds{1}, seconds{20});
  draw.faults.push_back(
      {when, for_good ? std::nullopt : std::optional{lasts}, ProgramsEnd{{kGroundStation}}});
}

void heavy_loss(Draw& draw) {
  const When when = draw.in_a_change();
  const Duration lasts = draw.between(seconds{10}, seconds{60});
  radio::Disorder disorder;
  disorder.duplicates = draw.random.uniform(0.0, 0.3);
  disorder.held_back = draw.random.uniform(0.0, 0.2);
  disorder.held_back_max = kHeldBackInFormation;
  draw.faults.push_back({when, lasts, radio::Disturbance{0.5, {}, {}, disorder}});
}

void short_silence(Draw& draw) {
  const bool everybody = draw.random.chance(0.5);
  const bool one_way = !everybody && draw.random.chance(0.5);
  const When when = draw.in_a_change();
  std::vector<VehicleId> who{draw.anyone()};
  if (everybody) {
    who = draw.vehicles;
    who.push_back(kGroundStation);
  }
  draw.faults.push_back(
      {when, seconds{2},
       radio::silence(who, one_way ? radio::Cut::Kind::one_way : radio::Cut::Kind::both_ways)});
}

void apart(Draw& draw) {
  const bool both_ways = draw.random.chance(0.5);
  const When when = draw.in_a_change();
  const Duration lasts = draw.between(seconds{1}, seconds{15});
  std::vector<VehicleId> who;
  for (const VehicleId vehicle : draw.vehicles) {
    if (draw.random.chance(0.4)) who.push_back(vehicle);
  }
  if (draw.random.chance(0.2)) who.push_back(kGroundStation);
  draw.faults.push_back(
      {when, lasts,
       both_ways ? radio::cut_off(who) : radio::silence(who, radio::Cut::Kind::one_way)});
}

void restart(Draw& draw) {
  const When when = draw.in_a_change();
  const Duration lasts = draw.between(milliseconds{100}, seconds{6});
  draw.faults.push_back({when, lasts, ProgramsEnd{{draw.anyone()}}});
}

void taken_by_pilot(Draw& draw) {
  const When when = draw.in_a_change();
  const Duration lasts = draw.between(seconds{2}, seconds{60});
  draw.faults.push_back({when, lasts, PilotsTake{{draw.anyone()}}});
}

void stalled(Draw& draw) {
  const When when = draw.in_a_change();
  const Duration lasts = draw.between(milliseconds{100}, seconds{8});
  draw.faults.push_back({when, lasts, ProgramsStall{{draw.anyone()}}});
}

void small_clocks(Draw& draw) {
  for (const VehicleId vehicle : draw.vehicles) {
    draw.faults.push_back({{}, {}, ClockOff{vehicle, draw.between(-kClockMax, kClockMax)}});
  }
  draw.faults.push_back({{}, {}, ClockOff{kGroundStation, draw.between(-kClockMax, kClockMax)}});
}

// --- the one vocabulary ---

/// Sets the most of what it draws, where more is not set already.
using Raise = void (*)(FaultParams& params);

template <typename Amount>
void raise(Amount& amount, const std::type_identity_t<Amount>& most) {
  amount = std::max(amount, most);
}

struct Profile {
  std::string_view name;
  Raise sites = nullptr;  ///< null: not of missions with sites
  void (*formation)(Draw&) = nullptr;
  double share = 0.45;  ///< of `mixed` missions with sites that have it

  [[nodiscard]] bool of(MissionKind kind) const {
    return kind == MissionKind::sites ? sites != nullptr : formation != nullptr;
  }
};

constexpr Raise kLossy = [](FaultParams& p) {
  raise(p.loss, 0.6);
  raise(p.delay, milliseconds{300});
  raise(p.jitter, milliseconds{200});
  raise(p.duplicates, 0.3);
  raise(p.held_back, 0.1);
};
constexpr Raise kPartition = [](FaultParams& p) { raise(p.partitions, 3); };
constexpr Raise kCrash = [](FaultParams& p) {
  raise(p.crashes, 2);
  raise(p.restarts, 2);
};
constexpr Raise kGround = [](FaultParams& p) { raise(p.ground, 2); };
/// Two of them are within the guard of 500 ms.
constexpr Raise kClocks = [](FaultParams& p) { raise(p.clock_offset, milliseconds{245}); };
constexpr Raise kHazards = [](FaultParams& p) { raise(p.hazards, 3); };
constexpr Raise kOperator = [](FaultParams& p) { p.slow_operator = true; };
constexpr Raise kJoining = [](FaultParams& p) {
  raise(p.joiners, 3);
  p.sites_together = true;
};
constexpr Raise kPlanner = [](FaultParams& p) { raise(p.planning, seconds{3}); };
constexpr Raise kSites = [](FaultParams& p) {
  raise(p.seen, 3);
  raise(p.withdrawn, 1);
};
constexpr Raise kOrders = [](FaultParams& p) {
  raise(p.orders, 6);
  raise(p.restarts, 2);
};
constexpr Raise kClock = [](FaultParams& p) { p.wrong_clock = true; };
constexpr Raise kTakenBack = [](FaultParams& p) { raise(p.taken_back, 2); };
constexpr Raise kStall = [](FaultParams& p) { raise(p.stalls, 4); };
constexpr Raise kDouble = [](FaultParams& p) { raise(p.doubles, 1); };
constexpr Raise kAirframe = [](FaultParams& p) { raise(p.airframes, 1); };
constexpr Raise kCovered = [](FaultParams& p) { raise(p.covered, 1); };
constexpr Raise kStations = [](FaultParams& p) { raise(p.taken_over, 3); };
constexpr Raise kPilot = [](FaultParams& p) { raise(p.pilots, 3); };
constexpr Raise kBattery = [](FaultParams& p) { raise(p.batteries, 2); };
constexpr Raise kWind = [](FaultParams& p) {
  raise(p.wind_mps, 5.0);
  raise(p.gust_mps, 2.0);
};
constexpr Raise kNarrow = [](FaultParams& p) { p.narrow = true; };

/// Of what takes vehicles, or the air, from the team: more of it would leave too little.
constexpr double kRare = 0.15;

/// `mixed` draws from them in this order.
constexpr std::array kProfiles{Profile{"none", nullptr, no_fault},
                               Profile{"lossy", kLossy},
                               Profile{"vehicle", nullptr, lost_vehicle},
                               Profile{"leader", nullptr, lost_leader},
                               Profile{"ground", kGround, lost_ground},
                               Profile{"loss", nullptr, heavy_loss},
                               Profile{"silence", nullptr, short_silence},
                               Profile{"partition", kPartition, apart},
                               Profile{"crash", kCrash},
                               Profile{"restart", nullptr, restart},
                               Profile{"clocks", kClocks, small_clocks},
                               Profile{"hazards", kHazards},
                               Profile{"operator", kOperator},
                               Profile{"joining", kJoining},
                               Profile{"planner", kPlanner},
                               Profile{"sites", kSites},
                               Profile{"orders", kOrders},
                               Profile{"clock", kClock},
                               Profile{"taken-back", kTakenBack},
                               Profile{"stall", kStall, stalled},
                               Profile{"covered", kCovered},
                               Profile{"double", kDouble, nullptr, kRare},
                               Profile{"airframe", kAirframe, nullptr, kRare},
                               Profile{"pilot", kPilot, taken_by_pilot, kRare},
                               Profile{"stations", kStations, nullptr, kRare},
                               Profile{"battery", kBattery, nullptr, kRare},
                               Profile{"wind", kWind, nullptr, kRare},
                               Profile{"narrow", kNarrow, nullptr, kRare}};

/// Each of these takes a vehicle from the team, besides crashes.
constexpr std::array<Raise, 4> kLosing{kClock, kDouble, kAirframe, kBattery};

void mixed(FaultParams& params, std::uint64_t seed) {
  Random random{seed ^ kMixStream};
  const std::size_t crashes = params.crashes;
  const std::size_t batteries = params.batteries;
  std::size_t lost_besides = 0;
  // Two are lost at most: with fewer vehicles a leader whose site is beyond them can keep the last
  // one that another site needs.
  for (const Profile& profile : kProfiles) {
    if (profile.sites == nullptr || !random.chance(profile.share)) continue;
    const bool loses = contains(kLosing, profile.sites);
    if (loses && lost_besides == kLostMax) continue;
    profile.sites(params);
    if (loses) ++lost_besides;
  }
  params.batteries = std::max(batteries, std::min<std::size_t>(params.batteries, 1));
  params.crashes = std::max(crashes, std::min(params.crashes, kLostMax - lost_besides));
}

void mix(Draw& draw) {
  for (const Profile& profile : kProfiles) {
    if (profile.formation != nullptr && draw.random.chance(0.4)) profile.formation(draw);
  }
}

/// Fails where such a mission does not have one.
Result<std::vector<std::string>> names_in(const std::string& list, MissionKind kind) {
  return fault_names(list, fault_profiles(kind), [kind](const std::string& name) {
    const bool elsewhere = std::any_of(kProfiles.begin(), kProfiles.end(),
                                       [&](const Profile& p) { return p.name == name; });
    const bool sites = kind == MissionKind::sites;
    return elsewhere ? "the faults '" + name + "' are of " +
                           (sites ? "formations, and this mission has sites"
                                  : "missions with sites, and this is a formation")
                     : "there is no fault profile '" + name + "'";
  });
}

const Profile& profile_of(const std::string& name) {
  const auto* const profile = std::find_if(kProfiles.begin(), kProfiles.end(),
                                           [&](const Profile& p) { return p.name == name; });
  SKEIN_ASSERT(profile != kProfiles.end());
  return *profile;
}

// --- a mission with sites ---

Duration between(Random& random, Duration low, Duration high) {
  return from_seconds(random.uniform(to_seconds(low), to_seconds(high)));
}
/// Up to `most`, more often than not at least one.
std::size_t count(Random& random, std::size_t most) {
  return static_cast<std::size_t>(random.index(most + 1));
}

Fault draw_partition(Random& random, const TeamMission& mission, Duration phase) {
  static constexpr std::array kKinds{radio::Cut::Kind::both_ways, radio::Cut::Kind::one_way,
                                     radio::Cut::Kind::bridge};
  radio::Cut cut;
  cut.kind = kKinds.at(random.index(kKinds.size()));
  const Duration from = between(random, Duration{}, phase * 3 / 4);
  const Duration lasts = std::min(between(random, seconds{2}, seconds{40}), phase - from);
  std::vector<VehicleId> group;
  for (const auto& v : mission.vehicles) {
    if (random.chance(0.5)) group.push_back(v.spec.id);
  }
  if (random.chance(0.3)) group.push_back(kGroundStation);
  cut.groups.push_back(group);
  cut.bridge = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
  return {{.not_before = Instant{} + from}, lasts, cut};
}

Fault draw_crash(Random& random, Duration phase, bool for_good) {
  static constexpr std::array kRoles{Role::any, Role::leader, Role::member};
  Fault fault;
  fault.when.role = kRoles.at(random.index(kRoles.size()));
  fault.when.not_before = Instant{} + between(random, seconds{1}, phase);
  fault.when.not_after = Instant{} + phase;
  fault.when.after = between(random, Duration{}, seconds{12});
  fault.what = ProgramsEnd{{}, random.next()};
  if (!for_good) fault.lasts = between(random, milliseconds{500}, seconds{15});
  return fault;
}

/// But for one site: `except`.
bool is_free(const Hazard& hazard, const TeamMission& mission,
             const std::optional<SiteId>& except = std::nullopt) {
  double approach = 0.0;
  double circle = 0.0;
  double turn = 0.0;
  for (const auto& v : mission.vehicles) {
    approach = std::max(approach, v.spec.final_approach_m);
    circle = std::max({circle, v.spec.sensor_radius_m, v.spec.assess_radius_m});
    turn = std::max(turn, v.spec.planning_radius_m());
  }
  const double room = hazard.radius_m + kSiteRoom_m + std::max(approach + turn, circle);
  for (const auto& site : mission.sites) {
    if (site.id != except && (site.position - hazard.centre).norm() < room) return false;
  }
  for (const auto& h : mission.hazards) {
    if ((h.hazard.centre - hazard.centre).norm() < h.hazard.radius_m + hazard.radius_m + 4.0 * turn)
      return false;
  }
  for (const auto& v : mission.vehicles) {  // where it waits, it must be able to wait
    if (v.search.empty()) continue;
    if ((v.search.back() - hazard.centre).norm() < hazard.radius_m + 3.0 * turn) return false;
  }
  return true;
}

/// A place on some vehicle's way.
Vec2 draw_place(Random& random, const TeamMission& mission) {
  const SimulatedVehicle& v = mission.vehicles[random.index(mission.vehicles.size())];
  Vec2 from{v.start.x_m, v.start.y_m};
  const std::size_t leg = v.search.empty() ? 0 : random.index(v.search.size());
  if (leg > 0) from = v.search[leg - 1];
  const Vec2 to = v.search.empty() ? from : v.search[leg];
  const double share = random.uniform(0.2, 0.8);
  const double east = random.uniform(-60.0, 60.0);
  const double north = random.uniform(-60.0, 60.0);
  return from + share * (to - from) + Vec2{east, north};
}

void draw_hazards(Random& random, TeamMission& mission, const FaultParams& params) {
  std::uint16_t id = 1000;
  const std::size_t wanted = count(random, params.hazards);
  for (std::size_t drawn = 0, tries = 0; drawn < wanted && tries < 200; ++tries) {
    Hazard hazard;
    hazard.radius_m = random.uniform(20.0, 60.0);
    hazard.centre = draw_place(random, mission);
    const Instant known_from = Instant{} + between(random, seconds{3}, params.phase);
    if (!is_free(hazard, mission)) continue;
    hazard.id = HazardId{++id};
    mission.hazards.push_back({hazard, known_from});
    ++drawn;
  }
}

/// A site that lies in a hazard cannot be worked at any more.
void draw_covered(Random& random, TeamMission& mission, const FaultParams& params) {
  if (mission.sites.empty()) return;
  std::uint16_t id = 1100;
  for (std::size_t n = count(random, params.covered); n > 0; --n) {
    const Site& site = mission.sites[random.index(mission.sites.size())];
    Hazard hazard;
    hazard.radius_m = random.uniform(20.0, 60.0);
    const Vec2 aside = unit_vector(random.uniform(-kPi, kPi));
    hazard.centre = site.position + random.uniform(0.0, 0.8) * hazard.radius_m * aside;
    const Instant known_from = Instant{} + between(random, seconds{3}, params.phase);
    if (!is_free(hazard, mission, site.id)) continue;
    hazard.id = HazardId{++id};
    mission.hazards.push_back({hazard, known_from});
  }
}

/// What detectors see: where there is nothing, or at a site of the mission; by one of them or by
/// two. Some of that, and of the mission's sites, the operator withdraws.
void draw_sites(Random& random, TeamMission& mission, const FaultParams& params) {
  if (params.seen == 0 || mission.sites.empty()) return;
  const Instant end = Instant{} + params.phase;
  for (std::size_t n = count(random, params.seen); n > 0; --n) {
    const Instant at = Instant{} + between(random, seconds{2}, params.phase * 3 / 4);
    PlaceSeen seen;
    seen.place = random.chance(0.3) ? mission.sites[random.index(mission.sites.size())].position
                                    : draw_place(random, mission);
    for (std::size_t i = random.chance(0.5) ? 2 : 1; i > 0; --i) {
      seen.by.push_back(mission.vehicles[random.index(mission.vehicles.size())].spec.id);
    }
    mission.faults.push_back({{.not_before = at}, {}, seen});
    if (!random.chance(0.5)) continue;
    const Instant gone = at + between(random, seconds{2}, seconds{20});
    mission.faults.push_back({{.not_before = gone, .not_after = end}, {}, SiteWithdrawal{}});
  }
  for (std::size_t n = count(random, params.withdrawn); n > 0; --n) {
    const SiteId site = mission.sites[random.index(mission.sites.size())].id;
    const Instant at = Instant{} + between(random, seconds{5}, params.phase);
    mission.faults.push_back({{.not_before = at, .not_after = end}, {}, SiteWithdrawal{site}});
  }
}

/// Late, refused, or only from some moment on; a plan is always decided about in the end.
void draw_decisions(Random& random, TeamMission& mission, const FaultParams& params) {
  mission.decisions.clear();
  for (const auto& site : mission.sites) {
    mission::ScriptedDecision decision;
    decision.site = site.id;
    decision.reaction = between(random, milliseconds{200}, seconds{2});
    const double kind = random.uniform();
    if (kind < 0.15) decision.grant = false;
    if (kind >= 0.15 && kind < 0.5)
      decision.not_before = Instant{} + between(random, seconds{10}, params.phase);
    mission.decisions.push_back(decision);
    // Who asks again, because the plan fell through, is answered with another delay.
    decision.reaction = between(random, milliseconds{200}, seconds{2});
    mission.decisions.push_back(decision);
  }
}

}  // namespace

Result<std::vector<std::string>> fault_names(
    const std::string& list, const std::vector<std::string_view>& known,
    const std::function<std::string(const std::string& name)>& why_not) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    names.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const std::string& name : names) {
    if (contains(known, name)) continue;
    std::string message = why_not(name) + "; write one of ";
    for (const auto& one : known) message.append(one).append(", ");
    return Error{message + "or several with commas"};
  }
  return names;
}

std::vector<std::string_view> fault_profiles(MissionKind kind) {
  std::vector<std::string_view> names;
  for (const Profile& profile : kProfiles) {
    if (profile.of(kind) || profile.name == "none") names.push_back(profile.name);
  }
  names.emplace_back("mixed");
  return names;
}

Result<FaultParams> fault_params(const std::string& profiles, std::uint64_t seed) {
  const auto names = names_in(profiles, MissionKind::sites);
  if (!names) return names.error();
  FaultParams all;
  for (const std::string& name : *names) {
    if (name == "none") continue;
    all.phase = seconds{90};
    all.bound = kDoneWithin;
    name == "mixed" ? mixed(all, seed) : profile_of(name).sites(all);
  }
  return all;
}

Result<std::vector<Fault>> formation_faults(const std::string& profiles,
                                            const std::vector<VehicleId>& vehicles,
                                            std::size_t changes, std::uint64_t seed) {
  const auto names = names_in(profiles, MissionKind::formation);
  if (!names) return names.error();
  if (vehicles.size() < 2 || changes == 0) return Error{"faults need two vehicles and a change"};
  Draw draw{vehicles, changes, Random{seed ^ kFormationStream}};
  for (const std::string& name : *names) {
    name == "mixed" ? mix(draw) : profile_of(name).formation(draw);
  }
  return std::move(draw.faults);
}

namespace {

/// What is left of the vehicles, and the air, all the mission long.
void draw_surroundings(Random& random, TeamMission& mission, const FaultParams& params) {
  for (std::size_t n = count(random, params.batteries); n > 0; --n) {
    const VehicleId whose = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
    const Instant at = Instant{} + between(random, seconds{1}, params.phase);
    mission.faults.push_back(
        {{.not_before = at}, {}, BatteryFalls{whose, random.uniform(20.0, 40.0)}});
    // It comes home by itself; there the operator lands it.
    for (const auto& [after, kind] : kBringDown) {
      mission.faults.push_back({{.not_before = at + after}, {}, Ordered{whose, kind}});
    }
  }
  if (params.wind_mps > 0.0) {
    const double speed_mps = random.uniform(0.0, params.wind_mps);
    mission.wind.steady_mps = speed_mps * unit_vector(random.uniform(-kPi, kPi));
    mission.wind.gust_mps = random.uniform(0.0, params.gust_mps);
    mission.heeds_wind = true;
  }
  if (params.narrow) {
    // Vehicles tell a second ground station how they are, and it has its own word to say.
    const double least_bytes_per_s = kNarrow_bytes_per_s * (params.taken_over > 0 ? 1.5 : 1.0);
    mission.radio.bytes_per_s = random.uniform(least_bytes_per_s, 2.0 * least_bytes_per_s);
  }
}

/// The last goes to all: go on, once the radio has healed.
void draw_orders(Random& random, TeamMission& mission, const FaultParams& params) {
  const std::size_t orders = count(random, params.orders);
  for (std::size_t n = 0; n < orders; ++n) {
    const Instant at = Instant{} + between(random, seconds{1}, params.phase);
    VehicleId whom = kGroundStation;
    if (random.chance(0.7)) whom = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
    static constexpr std::array kKinds{mission::CommandKind::hold, mission::CommandKind::hold,
                                       mission::CommandKind::return_home,
                                       mission::CommandKind::resume};
    mission.faults.push_back({{.not_before = at}, {}, Ordered{whom, kKinds.at(random.index(4))}});
  }
  // The ground station's program may be down for up to half a minute then.
  for (int i = 1; i <= 2; ++i) {
    mission.faults.push_back({{.not_before = Instant{} + params.phase + i * seconds{20}},
                              {},
                              Ordered{kGroundStation, mission::CommandKind::resume}});
  }
}

/// At any moment from the grant to the deliveries, and after them, when it is too late.
void draw_taken_back(Random& random, TeamMission& mission, const FaultParams& params) {
  const Instant end = Instant{} + params.phase;
  for (std::size_t n = count(random, params.taken_back); n > 0; --n) {
    const SiteId site = mission.sites[random.index(mission.sites.size())].id;
    const GrantTakenBack back{site, between(random, Duration{}, seconds{25})};
    mission.faults.push_back({{.not_after = end}, {}, back});
  }
}

void draw_wrong_clock(Random& random, TeamMission& mission) {
  const VehicleId whose = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
  const Duration off = between(random, seconds{1}, seconds{5});
  std::erase_if(mission.faults, [whose](const Fault& fault) {
    const auto* clock = std::get_if<ClockOff>(&fault.what);
    return clock != nullptr && clock->node == whose;
  });
  mission.faults.push_back({{}, {}, ClockOff{whose, random.chance(0.5) ? off : -off}});
}

/// Another vehicle of that kind takes off where one of the team did, in a layer of its own: the
/// numbers are a mistake, the heights are not.
void draw_double(Random& random, TeamMission& mission, Duration phase) {
  SimulatedVehicle other = mission.vehicles[random.index(mission.vehicles.size())];
  const Instant at = Instant{} + between(random, Duration{}, phase);
  if (other.spec.is_copter()) return;  // two would climb from one place
  for (const auto& v : mission.vehicles) {
    other.spec.height_m = std::max(other.spec.height_m, v.spec.height_m + kLayer_m);
  }
  other.flies_as = other.number();
  other.spec.id = VehicleId{static_cast<std::uint16_t>(kDoubles + mission.vehicles.size())};
  mission.faults.push_back({{.not_before = at}, {}, LateStart{other.spec.id}});
  mission.vehicles.push_back(std::move(other));
}

/// What came to be drawn later comes after all else: that is drawn as before with the same seed.
void draw_further(Random& random, TeamMission& mission, const FaultParams& params) {
  for (std::size_t n = count(random, params.stalls); n > 0; --n) {
    mission.faults.push_back(draw_stall(random, params.phase));
  }
  draw_covered(random, mission, params);
  for (std::size_t n = count(random, params.doubles); n > 0; --n) {
    draw_double(random, mission, params.phase);
  }
  for (std::size_t n = count(random, params.airframes); n > 0; --n) {
    Fault lost = draw_crash(random, params.phase, true);
    std::get<ProgramsEnd>(lost.what).with_airframe = true;
    mission.faults.push_back(std::move(lost));
  }
  for (std::size_t n = count(random, params.taken_over); n > 0; --n) {
    const Instant at = Instant{} + between(random, seconds{5}, params.phase);
    mission.faults.push_back({{.not_before = at}, {}, CommandTaken{}});
  }
  if (params.taken_over > 0) {
    for (Fault& fault : mission.faults) {
      auto* cut = std::get_if<radio::Cut>(&fault.what);
      if (cut != nullptr && random.chance(0.3)) cut->groups.front().push_back(kSecondStation);
    }
  }
  for (std::size_t n = count(random, params.pilots); n > 0; --n) {
    Fault taken = draw_crash(random, params.phase, false);
    taken.what = PilotsTake{{}, random.next()};
    taken.lasts = between(random, seconds{2}, seconds{90});
    mission.faults.push_back(std::move(taken));
  }
  if (has_second_station(mission.faults) && random.chance(0.5)) {
    const Instant at = Instant{} + between(random, seconds{5}, params.phase);
    const bool for_good = random.chance(0.3);
    const Duration lasts = between(random, seconds{1}, seconds{20});
    mission.faults.push_back({{.not_before = at},
                              for_good ? std::nullopt : std::optional{lasts},
                              ProgramsEnd{{kSecondStation}}});
  }
}

}  // namespace

Fault draw_stall(Random& random, Duration phase) {
  static constexpr std::array kRoles{Role::any, Role::leader, Role::member};
  Fault fault;
  fault.when.not_before = Instant{} + between(random, seconds{1}, phase);
  fault.when.not_after = Instant{} + phase;
  fault.when.after = between(random, Duration{}, seconds{6});
  ProgramsStall still{{}, random.next()};
  if (random.chance(0.15)) {
    still.who = {kGroundStation};
  } else {
    fault.when.role = kRoles.at(random.index(kRoles.size()));
  }
  fault.what = std::move(still);
  fault.lasts = between(random, milliseconds{200}, seconds{random.chance(0.5) ? 4 : 20});
  return fault;
}

void add_faults(TeamMission& mission, const FaultParams& params) {
  if (params.phase == Duration{}) return;
  Random random{mission.seed ^ kFaultStream};
  std::vector<Fault>& faults = mission.faults;
  mission.duration_max = params.phase + params.bound;
  // Who waits flies on, and hears everybody in the end: neither range is what is tried here.
  for (auto& v : mission.vehicles) {
    v.spec.range_m += v.spec.speed_max_mps * to_seconds(mission.duration_max);
  }
  mission.protocol.radio_range_m = std::max(mission.protocol.radio_range_m, kEverywhere_m);

  radio::Disturbance radio;
  radio.loss = random.uniform(0.0, params.loss);
  radio.delay = between(random, Duration{}, params.delay);
  radio.jitter = between(random, Duration{}, params.jitter);
  radio::Disorder disorder;
  disorder.duplicates = random.uniform(0.0, params.duplicates);
  disorder.held_back = random.uniform(0.0, params.held_back);
  disorder.held_back_max = kHeldBackMax;
  radio.disorder = disorder;
  faults.push_back({{}, params.phase, radio});
  for (std::size_t n = count(random, params.partitions); n > 0; --n) {
    faults.push_back(draw_partition(random, mission, params.phase));
  }
  for (std::size_t n = count(random, params.crashes); n > 0; --n) {
    faults.push_back(draw_crash(random, params.phase, true));
  }
  for (std::size_t n = count(random, params.restarts); n > 0; --n) {
    faults.push_back(draw_crash(random, params.phase, false));
  }
  std::map<VehicleId, Instant> joining;
  for (std::size_t n = count(random, params.joiners); n > 0; --n) {
    const auto& late = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
    joining[late] = Instant{} + between(random, seconds{2}, params.phase / 2);
  }
  for (const auto& [vehicle, at] : joining) {
    faults.push_back({{.not_before = at}, {}, LateStart{vehicle}});
  }
  if (params.clock_offset > Duration{}) {
    for (const auto& v : mission.vehicles) {
      const Duration off = between(random, -params.clock_offset, params.clock_offset);
      faults.push_back({{}, {}, ClockOff{v.spec.id, off}});
    }
  }
  if (params.sites_together && random.chance(0.7)) {
    const Instant at = Instant{} + between(random, seconds{1}, seconds{30});
    faults.push_back({{.not_before = at}, {}, SitesReported{}});
  }
  faults.push_back({{.not_before = Instant{} + params.phase}, {}, Healing{}});
  if (params.hazards > 0) draw_hazards(random, mission, params);
  if (params.slow_operator) draw_decisions(random, mission, params);
  for (std::size_t n = count(random, params.ground); n > 0; --n) {
    const Instant at = Instant{} + between(random, seconds{1}, params.phase);
    const Duration down = between(random, seconds{1}, seconds{30});
    faults.push_back({{.not_before = at}, down, ProgramsEnd{{kGroundStation}}});
  }
  draw_sites(random, mission, params);
  if (params.orders > 0) draw_orders(random, mission, params);
  if (params.wrong_clock) draw_wrong_clock(random, mission);
  if (params.taken_back > 0 && !mission.sites.empty()) draw_taken_back(random, mission, params);
  if (params.planning > Duration{}) {
    mission.allocation_takes = between(random, mission.allocation_takes, params.planning);
  }
  draw_surroundings(random, mission, params);
  draw_further(random, mission, params);
}

}  // namespace skein::hil
