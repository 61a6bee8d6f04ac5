// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

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

FaultParams phase_only() {
  FaultParams p;
  p.phase = seconds{90};
  p.bound = seconds{300};
  return p;
}

struct Profile {
  std::string_view name;
  FaultParams (*params)();
};

FaultParams lossy() {
  FaultParams p = phase_only();
  p.loss = 0.6;
  p.delay = milliseconds{300};
  p.jitter = milliseconds{200};
  p.duplicates = 0.3;
  p.held_back = 0.1;
  return p;
}
FaultParams partition() {
  FaultParams p = phase_only();
  p.partitions = 3;
  return p;
}
FaultParams crash() {
  FaultParams p = phase_only();
  p.crashes = 2;
  p.restarts = 2;
  return p;
}
FaultParams clocks() {
  FaultParams p = phase_only();
  p.clock_offset = milliseconds{245};  // two of them within the guard of 500 ms
  return p;
}
FaultParams hazards() {
  FaultParams p = phase_only();
  p.hazards = 3;
  return p;
}
FaultParams slow_operator() {
  FaultParams p = phase_only();
  p.slow_operator = true;
  return p;
}
FaultParams joining() {
  FaultParams p = phase_only();
  p.joiners = 3;
  p.sites_together = true;
  return p;
}

constexpr std::array<Profile, 7> kProfiles{{{"lossy", lossy},
                                            {"partition", partition},
                                            {"crash", crash},
                                            {"clocks", clocks},
                                            {"hazards", hazards},
                                            {"operator", slow_operator},
                                            {"joining", joining}}};

FaultParams mixed(std::uint64_t seed) {
  Random random{seed ^ kMixStream};
  FaultParams all = phase_only();
  for (const Profile& profile : kProfiles) {
    if (random.chance(0.45)) all.add(profile.params());
  }
  return all;
}

Duration between(Random& random, Duration low, Duration high) {
  return from_seconds(random.uniform(to_seconds(low), to_seconds(high)));
}
/// Up to `most`, more often than not at least one.
std::size_t count(Random& random, std::size_t most) {
  return static_cast<std::size_t>(random.index(most + 1));
}

Partition draw_partition(Random& random, const TeamMission& mission, Duration phase) {
  Partition p;
  p.kind = static_cast<Partition::Kind>(random.index(3));
  p.from = Instant{} + between(random, Duration{}, phase * 3 / 4);
  p.until = std::min(p.from + between(random, seconds{2}, seconds{40}), Instant{} + phase);
  for (const auto& v : mission.vehicles) {
    if (random.chance(0.5)) p.apart.push_back(v.spec.id);
  }
  if (random.chance(0.3)) p.apart.push_back(kGroundStation);
  p.bridge = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
  return p;
}

Crash draw_crash(Random& random, Duration phase, bool for_good) {
  Crash c;
  c.role = static_cast<Crash::Role>(random.index(3));
  c.not_before = Instant{} + between(random, seconds{1}, phase);
  c.after = between(random, Duration{}, seconds{12});
  c.pick = random.next();
  if (!for_good) c.down_for = between(random, milliseconds{500}, seconds{15});
  return c;
}

bool is_free(const Hazard& hazard, const TeamMission& mission) {
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
    if ((site.position - hazard.centre).norm() < room) return false;
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

Error no_profile(const std::string& name) {
  std::string message = "there is no fault profile '" + name + "'; write one of ";
  for (const auto& known : fault_profiles()) message.append(known).append(", ");
  return Error{message + "or several with commas"};
}

}  // namespace

FaultParams& FaultParams::add(const FaultParams& other) {
  phase = std::max(phase, other.phase);
  bound = std::max(bound, other.bound);
  loss = std::max(loss, other.loss);
  delay = std::max(delay, other.delay);
  jitter = std::max(jitter, other.jitter);
  duplicates = std::max(duplicates, other.duplicates);
  held_back = std::max(held_back, other.held_back);
  partitions = std::max(partitions, other.partitions);
  crashes = std::max(crashes, other.crashes);
  restarts = std::max(restarts, other.restarts);
  joiners = std::max(joiners, other.joiners);
  clock_offset = std::max(clock_offset, other.clock_offset);
  hazards = std::max(hazards, other.hazards);
  slow_operator = slow_operator || other.slow_operator;
  sites_together = sites_together || other.sites_together;
  return *this;
}

std::vector<std::string_view> fault_profiles() {
  std::vector<std::string_view> names{"none"};
  for (const Profile& profile : kProfiles) names.push_back(profile.name);
  names.emplace_back("mixed");
  return names;
}

Result<FaultParams> fault_params(const std::string& profiles, std::uint64_t seed) {
  FaultParams all;
  std::size_t begin = 0;
  while (begin <= profiles.size()) {
    const std::size_t end = std::min(profiles.find(',', begin), profiles.size());
    const std::string name = profiles.substr(begin, end - begin);
    begin = end + 1;
    const auto* const profile = std::find_if(kProfiles.begin(), kProfiles.end(),
                                             [&](const Profile& p) { return p.name == name; });
    if (profile != kProfiles.end()) {
      all.add(profile->params());
    } else if (name == "mixed") {
      all.add(mixed(seed));
    } else if (name != "none") {
      return no_profile(name);
    }
  }
  return all;
}

bool Partition::lets_through(VehicleId sender, VehicleId receiver) const {
  if (kind == Kind::bridge && (sender == bridge || receiver == bridge)) return true;
  const auto is_apart = [this](VehicleId node) {
    return std::find(apart.begin(), apart.end(), node) != apart.end();
  };
  if (kind == Kind::one_way) return !is_apart(sender) || is_apart(receiver);
  return is_apart(sender) == is_apart(receiver);
}

bool FaultSchedule::lets_through(VehicleId sender, VehicleId receiver, Instant now) const {
  return std::all_of(partitions.begin(), partitions.end(), [&](const Partition& p) {
    return now < p.from || now >= p.until || p.lets_through(sender, receiver);
  });
}

void add_faults(TeamMission& mission, const FaultParams& params) {
  if (params.phase == Duration{}) return;
  Random random{mission.seed ^ kFaultStream};
  FaultSchedule& faults = mission.faults;
  faults.healed_at = Instant{} + params.phase;
  mission.duration_max = params.phase + params.bound;
  // Who waits flies on, and hears everybody in the end: neither range is what is tried here.
  for (auto& v : mission.vehicles) {
    v.spec.range_m += v.spec.speed_max_mps * to_seconds(mission.duration_max);
  }
  mission.protocol.radio_range_m = std::max(mission.protocol.radio_range_m, kEverywhere_m);

  faults.radio.loss = random.uniform(0.0, params.loss);
  faults.radio.delay = between(random, Duration{}, params.delay);
  faults.radio.jitter = between(random, Duration{}, params.jitter);
  faults.radio.duplicates = random.uniform(0.0, params.duplicates);
  faults.radio.held_back = random.uniform(0.0, params.held_back);
  for (std::size_t n = count(random, params.partitions); n > 0; --n) {
    faults.partitions.push_back(draw_partition(random, mission, params.phase));
  }
  for (std::size_t n = count(random, params.crashes); n > 0; --n) {
    faults.crashes.push_back(draw_crash(random, params.phase, true));
  }
  for (std::size_t n = count(random, params.restarts); n > 0; --n) {
    faults.crashes.push_back(draw_crash(random, params.phase, false));
  }
  for (std::size_t n = count(random, params.joiners); n > 0; --n) {
    const auto& late = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
    faults.joining[late] = Instant{} + between(random, seconds{2}, params.phase / 2);
  }
  if (params.clock_offset > Duration{}) {
    for (const auto& v : mission.vehicles) {
      faults.clocks[v.spec.id] = between(random, -params.clock_offset, params.clock_offset);
    }
  }
  if (params.sites_together && random.chance(0.7)) {
    faults.sites_reported_at = Instant{} + between(random, seconds{1}, seconds{30});
  }
  if (params.hazards > 0) draw_hazards(random, mission, params);
  if (params.slow_operator) draw_decisions(random, mission, params);
}

std::string describe(const TeamMission& mission) {
  const FaultSchedule& faults = mission.faults;
  std::string text;
  if (!faults.any()) return text;
  text += fmt::format("faults until {:.2f} s; the mission ends at {:.2f} s at the latest\n",
                      to_seconds(faults.healed_at), to_seconds(mission.duration_max));
  text += fmt::format(
      "  radio: loss {:.3f}, delay +{:.3f} s, jitter +{:.3f} s, doubled {:.3f}, held back {:.3f}\n",
      faults.radio.loss, to_seconds(faults.radio.delay), to_seconds(faults.radio.jitter),
      faults.radio.duplicates, faults.radio.held_back);
  for (const Partition& p : faults.partitions) {
    static constexpr std::array<const char*, 3> kNames{"halves", "one way", "bridge"};
    text += fmt::format(
        "  partition ({}) {:.2f} to {:.2f} s, apart:", kNames.at(static_cast<std::size_t>(p.kind)),
        to_seconds(p.from), to_seconds(p.until));
    for (const VehicleId id : p.apart) text += fmt::format(" {}", id.value);
    if (p.kind == Partition::Kind::bridge) text += fmt::format(", bridge {}", p.bridge.value);
    text += "\n";
  }
  for (const Crash& c : faults.crashes) {
    static constexpr std::array<const char*, 3> kNames{"anybody", "a leader", "a member"};
    text += fmt::format("  crash of {} from {:.2f} s on, {:.2f} s later, ",
                        kNames.at(static_cast<std::size_t>(c.role)), to_seconds(c.not_before),
                        to_seconds(c.after));
    text += c.down_for ? fmt::format("down for {:.2f} s\n", to_seconds(*c.down_for)) : "for good\n";
  }
  for (const auto& [id, offset] : faults.clocks) {
    text += fmt::format("  clock of {}: {:+.6f} s\n", id.value, to_seconds(offset));
  }
  for (const auto& [id, at] : faults.joining) {
    text += fmt::format("  vehicle {} joins at {:.2f} s\n", id.value, to_seconds(at));
  }
  if (faults.sites_reported_at) {
    text += fmt::format("  all sites are reported at {:.2f} s\n",
                        to_seconds(*faults.sites_reported_at));
  }
  for (const auto& h : mission.hazards) {
    if (h.known_from <= Instant{}) continue;
    text += fmt::format("  hazard {} at ({:.1f}, {:.1f}), radius {:.1f} m, appears at {:.2f} s\n",
                        h.hazard.id.value, h.hazard.centre.x(), h.hazard.centre.y(),
                        h.hazard.radius_m, to_seconds(h.known_from));
  }
  for (const auto& d : mission.decisions) {
    text += fmt::format(
        "  operator, site {}: {}, {:.2f} s after the request, not before {:.2f} s\n", d.site.value,
        d.grant ? "grants" : "refuses", to_seconds(d.reaction), to_seconds(d.not_before));
  }
  return text;
}

}  // namespace skein::hil
