// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/formation_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "skein/base/random.hpp"

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Kind = FormationFault::Kind;

/// Keeps the draw of faults apart from what else starts from the same seed.
constexpr std::uint64_t kFaultStream = 0x666f726d66617501;
constexpr Duration kClockMax = milliseconds{10};
/// A change takes about so long.
constexpr Duration kChange = seconds{9};

struct Draw {
  const std::vector<VehicleId>& vehicles;
  std::size_t changes = 1;
  Random random;

  Duration between(Duration low, Duration high) {
    return from_seconds(random.uniform(to_seconds(low), to_seconds(high)));
  }
  VehicleId anyone() { return vehicles[random.index(vehicles.size())]; }
  FormationFault fault(Kind kind) {
    FormationFault fault;
    fault.kind = kind;
    fault.change = random.index(changes);
    fault.after = between(Duration{}, kChange);
    return fault;
  }
};

void vehicle(Draw& draw, FormationFaults& all) {
  FormationFault fault = draw.fault(Kind::lost);
  fault.for_good = true;
  fault.who = {draw.vehicles[1 + draw.random.index(draw.vehicles.size() - 1)]};
  fault.sinks = draw.random.chance(0.5);
  fault.sinks_after = draw.between(seconds{0}, seconds{30});
  all.faults.push_back(fault);
}

void leader(Draw& draw, FormationFaults& all) {
  vehicle(draw, all);
  all.faults.back().who = {draw.vehicles.front()};
}

void ground(Draw& draw, FormationFaults& all) {
  FormationFault fault = draw.fault(Kind::ground);
  fault.for_good = draw.random.chance(0.3);
  fault.lasts = draw.between(seconds{1}, seconds{20});
  all.faults.push_back(fault);
}

void loss(Draw& draw, FormationFaults& all) {
  FormationFault fault = draw.fault(Kind::radio);
  fault.lasts = draw.between(seconds{10}, seconds{60});
  fault.loss = 0.5;
  fault.duplicates = draw.random.uniform(0.0, 0.3);
  fault.held_back = draw.random.uniform(0.0, 0.2);
  all.faults.push_back(fault);
}

void silence(Draw& draw, FormationFaults& all) {
  const bool everybody = draw.random.chance(0.5);
  FormationFault fault =
      draw.fault(!everybody && draw.random.chance(0.5) ? Kind::unheard : Kind::silent);
  fault.lasts = seconds{2};
  fault.who = {draw.anyone()};
  if (everybody) {
    fault.who = draw.vehicles;
    fault.who.push_back(kGroundStation);
  }
  all.faults.push_back(fault);
}

void partition(Draw& draw, FormationFaults& all) {
  FormationFault fault = draw.fault(draw.random.chance(0.5) ? Kind::apart : Kind::unheard);
  fault.lasts = draw.between(seconds{1}, seconds{15});
  for (const VehicleId vehicle : draw.vehicles) {
    if (draw.random.chance(0.4)) fault.who.push_back(vehicle);
  }
  if (draw.random.chance(0.2)) fault.who.push_back(kGroundStation);
  all.faults.push_back(fault);
}

void restart(Draw& draw, FormationFaults& all) {
  FormationFault fault = draw.fault(Kind::restarted);
  fault.lasts = draw.between(milliseconds{100}, seconds{6});
  fault.who = {draw.anyone()};
  all.faults.push_back(fault);
}

void clocks(Draw& draw, FormationFaults& all) {
  for (const VehicleId vehicle : draw.vehicles) {
    all.clocks[vehicle] = draw.between(-kClockMax, kClockMax);
  }
  all.clocks[kGroundStation] = draw.between(-kClockMax, kClockMax);
}

struct Profile {
  std::string_view name;
  void (*draw)(Draw&, FormationFaults&);
};

void none(Draw& /*draw*/, FormationFaults& /*all*/) {}
void mixed(Draw& draw, FormationFaults& all);

constexpr std::array<Profile, 10> kProfiles{{{"none", none},
                                             {"vehicle", vehicle},
                                             {"leader", leader},
                                             {"ground", ground},
                                             {"loss", loss},
                                             {"silence", silence},
                                             {"partition", partition},
                                             {"restart", restart},
                                             {"clocks", clocks},
                                             {"mixed", mixed}}};

void mixed(Draw& draw, FormationFaults& all) {
  for (const Profile& profile : kProfiles) {
    if (profile.draw != mixed && draw.random.chance(0.4)) profile.draw(draw, all);
  }
}

std::string names(const std::vector<VehicleId>& who) {
  std::string text;
  for (const VehicleId vehicle : who) {
    text += text.empty() ? "" : ", ";
    text += vehicle == kGroundStation ? "ground" : fmt::format("U{}", vehicle.value);
  }
  return text;
}

}  // namespace

std::vector<std::string_view> formation_fault_profiles() {
  std::vector<std::string_view> names;
  names.reserve(kProfiles.size());
  for (const Profile& profile : kProfiles) names.push_back(profile.name);
  return names;
}

Result<FormationFaults> draw_formation_faults(const std::string& profile,
                                              const std::vector<VehicleId>& vehicles,
                                              std::size_t changes, std::uint64_t seed) {
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(),
                                  [&](const Profile& known) { return known.name == profile; });
  if (found == kProfiles.end()) {
    std::string known;
    for (const Profile& one : kProfiles) {
      known += known.empty() ? "" : ", ";
      known += one.name;
    }
    return Error{"there are no faults '" + profile + "' of formations; there are " + known};
  }
  if (vehicles.size() < 2 || changes == 0) return Error{"faults need two vehicles and a change"};
  FormationFaults all;
  Draw draw{vehicles, changes, Random{seed ^ kFaultStream}};
  found->draw(draw, all);
  return all;
}

std::string describe(const FormationFault& fault) {
  const std::string when =
      fmt::format("change {}, after {:.2f} s: ", fault.change, to_seconds(fault.after));
  const std::string span = fault.for_good ? std::string{"for good"}
                                          : fmt::format("for {:.2f} s", to_seconds(fault.lasts));
  switch (fault.kind) {
    case Kind::lost:
      return when + names(fault.who) + " lost" +
             (fault.sinks ? fmt::format(", sinks after {:.1f} s", to_seconds(fault.sinks_after))
                          : std::string{});
    case Kind::restarted:
      return when + names(fault.who) + " starts again after " +
             fmt::format("{:.2f} s", to_seconds(fault.lasts));
    case Kind::ground:
      return when + "the ground station is lost " + span;
    case Kind::silent:
      return when + names(fault.who) + " cut off " + span;
    case Kind::apart:
      return when + names(fault.who) + " apart from the others " + span;
    case Kind::unheard:
      return when + names(fault.who) + " not heard " + span;
    case Kind::radio:
      return when +
             fmt::format("{:.0f} % of messages lost, {:.0f} % doubled, {:.0f} % held back ",
                         1e2 * fault.loss, 1e2 * fault.duplicates, 1e2 * fault.held_back) +
             span;
    case Kind::count:
      break;
  }
  return when + "?";
}

}  // namespace skein::hil
