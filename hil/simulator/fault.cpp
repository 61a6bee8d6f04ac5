// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"

namespace skein::hil {
namespace {

std::string text_of(const When& when) {
  if (when.change)
    return fmt::format("change {}, after {:.2f} s: ", *when.change, to_seconds(when.after));
  if (when.role) {
    static constexpr std::array<const char*, 3> kNames{"anybody", "a leader", "a member"};
    return fmt::format("{:.2f} s after there is {}, from {:.2f} s on: ", to_seconds(when.after),
                       kNames.at(static_cast<std::size_t>(*when.role)),
                       to_seconds(when.not_before));
  }
  return fmt::format("at {:.2f} s: ", to_seconds(when.not_before + when.after));
}

std::string groups_of(const radio::Cut& cut) {
  std::string text;
  for (const auto& group : cut.groups) {
    text += (text.empty() ? "" : " | ") + names_of(group);
  }
  return text;
}

struct Sentence {
  std::string operator()(const ProgramsEnd& what) const {
    return (what.who.empty() ? "its program ends" : names_of(what.who) + " lost") +
           (what.with_airframe ? " with its airframe" : "") +
           (what.sinks_after ? fmt::format(", sinks after {:.1f} s", to_seconds(*what.sinks_after))
                             : "");
  }
  std::string operator()(const radio::Cut& what) const {
    switch (what.kind) {
      case radio::Cut::Kind::both_ways:
        return groups_of(what) + " apart";
      case radio::Cut::Kind::one_way:
        return groups_of(what) + " not heard";
      case radio::Cut::Kind::bridge:
        break;
    }
    return groups_of(what) + " apart but for the bridge " + names_of({what.bridge});
  }
  std::string operator()(const radio::Disturbance& what) const {
    const radio::Disorder disorder = what.disorder.value_or(radio::Disorder{});
    return fmt::format(
        "loss {:.3f}, delay +{:.3f} s, jitter +{:.3f} s, doubled {:.3f}, held back "
        "{:.3f}",
        what.loss, to_seconds(what.delay), to_seconds(what.jitter), disorder.duplicates,
        disorder.held_back);
  }
  std::string operator()(const radio::Flood& what) const {
    return names_of({what.vehicle}) + " floods the air";
  }
  std::string operator()(const BatteryFalls& what) const {
    return fmt::format("the battery of {} falls to {:g} %", names_of({what.vehicle}), what.percent);
  }
  std::string operator()(const LateStart& what) const {
    return names_of({what.vehicle}) + " takes off";
  }
  std::string operator()(const ClockOff& what) const {
    return fmt::format("the clock of {} is {:+.6f} s off", names_of({what.node}),
                       to_seconds(what.offset));
  }
  std::string operator()(const Ordered& what) const {
    return fmt::format("the operator orders {}: {}",
                       what.vehicle == kGroundStation ? "all" : names_of({what.vehicle}),
                       to_string(what.kind));
  }
  std::string operator()(const SitesReported& /*what*/) const { return "all sites are reported"; }
  std::string operator()(const PlaceSeen& what) const {
    return fmt::format("detectors of {} see something at ({:.1f}, {:.1f})", names_of(what.by),
                       what.place.x(), what.place.y());
  }
  std::string operator()(const SiteWithdrawal& what) const {
    return what.site ? fmt::format("site {} is withdrawn", what.site->value)
                     : "what detectors have seen is withdrawn";
  }
  std::string operator()(const GrantTakenBack& what) const {
    return fmt::format("what is granted at site {} is taken back {:.2f} s later", what.site.value,
                       to_seconds(what.after));
  }
  std::string operator()(const RoutesOrdered& what) const {
    return fmt::format("{} vehicles are given routes", what.routes.size());
  }
  std::string operator()(const Healing& /*what*/) const { return "the radio heals"; }
  std::string operator()(const ProgramsStall& what) const {
    return (what.who.empty() ? "its program" : "the program of " + names_of(what.who)) +
           " stands still";
  }
  std::string operator()(const CommandTaken& /*what*/) const {
    return "the other ground station takes the command";
  }
  std::string operator()(const PilotsTake& what) const {
    return "its pilot takes " + (what.who.empty() ? "it" : names_of(what.who));
  }
  std::string operator()(const ProgramSlow& what) const {
    return fmt::format("the program of {} stands still for {:.0f} % of the time",
                       names_of({what.node}), 100.0 * what.stopped_share);
  }
  std::string operator()(const DiskFull& what) const {
    return "the disk of " + names_of({what.node}) + " is full";
  }
  std::string operator()(const ClockStep& what) const {
    return fmt::format("the clock of {} is set by {:+.3f} s", names_of({what.vehicle}),
                       to_seconds(what.by));
  }
  std::string operator()(const OtherRelease& what) const {
    return names_of({what.vehicle}) + " flies with another release";
  }
};

}  // namespace

std::vector<Fault> faults_of(const configuration::Scenario& scenario) {
  std::vector<Fault> faults;
  for (const configuration::Fault& fault : scenario.faults) {
    When when;
    when.not_before = fault.at;
    switch (fault.kind) {
      case configuration::FaultKind::kill_vehicle:
        faults.push_back({when, std::nullopt, ProgramsEnd{{fault.vehicle}}});
        break;
      case configuration::FaultKind::partition:
        faults.push_back(
            {when, fault.duration, radio::Cut{radio::Cut::Kind::both_ways, fault.groups, {}}});
        break;
      case configuration::FaultKind::loss:
        faults.push_back({when, fault.duration, radio::Disturbance{fault.loss_ratio, {}, {}, {}}});
        break;
      case configuration::FaultKind::flood:
        faults.push_back({when, fault.duration, radio::Flood{fault.vehicle}});
        break;
      case configuration::FaultKind::battery:
        faults.push_back({when, std::nullopt, BatteryFalls{fault.vehicle, fault.battery_percent}});
        break;
    }
  }
  return faults;
}

bool has_role(mission::Activity activity, Role role) {
  using mission::Activity;
  switch (role) {
    case Role::any:
      return true;
    case Role::leader:
      return activity == Activity::leading || activity == Activity::monitoring;
    case Role::member:
      return activity == Activity::executing || activity == Activity::bidding;
  }
  return false;
}

Duration clock_offset(const std::vector<Fault>& faults, VehicleId node) {
  for (const Fault& fault : faults) {
    const auto* clock = std::get_if<ClockOff>(&fault.what);
    if (clock != nullptr && clock->node == node) return clock->offset;
  }
  return {};
}

bool has_second_station(const std::vector<Fault>& faults) {
  return std::ranges::any_of(
      faults, [](const Fault& fault) { return std::holds_alternative<CommandTaken>(fault.what); });
}

bool is_of_other_release(const std::vector<Fault>& faults, VehicleId vehicle) {
  return std::ranges::any_of(faults, [vehicle](const Fault& fault) {
    const auto* other = std::get_if<OtherRelease>(&fault.what);
    return other != nullptr && other->vehicle == vehicle;
  });
}

Instant start_of(const std::vector<Fault>& faults, VehicleId vehicle) {
  for (const Fault& fault : faults) {
    const auto* late = std::get_if<LateStart>(&fault.what);
    if (late != nullptr && late->vehicle == vehicle) return fault.when.not_before;
  }
  return {};
}

mission::MissionEvent shifted(mission::MissionEvent event, Duration by) {
  event.time += by;
  std::visit(
      [by](auto& body) {
        codec::for_each_field(body, [by](auto /*name*/, auto& value) {
          if constexpr (std::is_same_v<decltype(value), Instant&>) value += by;
        });
      },
      event.body);
  return event;
}

std::optional<Instant> healing_of(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    if (std::holds_alternative<Healing>(fault.what)) return fault.when.not_before;
  }
  return std::nullopt;
}

std::string names_of(const std::vector<VehicleId>& nodes) {
  std::string text;
  for (const VehicleId node : nodes) {
    text += text.empty() ? "" : ", ";
    text += node == kGroundStation   ? "ground"
            : node == kSecondStation ? "second ground"
                                     : fmt::format("U{}", node.value);
  }
  return text;
}

std::string describe(const Fault& fault) {
  std::string what = std::visit(Sentence{}, fault.what);
  if (std::holds_alternative<ClockOff>(fault.what)) return what;
  return text_of(fault.when) + what +
         (fault.lasts ? fmt::format(" for {:.2f} s", to_seconds(*fault.lasts)) : "");
}

}  // namespace skein::hil
