// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/stations.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/domain/path.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/mission/messages.hpp"

/// What goes wrong in a mission, and when: one list, written in a scenario or drawn from a seed,
/// done by the simulator in virtual time and by the bench to processes.
namespace skein::hil {

/// What a vehicle does when something happens to it.
enum class Role : std::uint8_t { any, leader, member };

/// In partitions, and from outside: both speak as the ground station.
inline constexpr VehicleId kSecondStation = station_node(2);

/// A fault begins `after` the first moment at which all of this is so.
struct When {
  Instant not_before{};
  std::optional<Instant> not_after = std::nullopt;  ///< then it does not begin any more
  /// That a ground station has begun so many changes of the formation before, and then this one.
  std::optional<std::size_t> change = std::nullopt;
  /// That some vehicle has this role; it is the one that the fault is done to, unless that names
  /// others.
  std::optional<Role> role = std::nullopt;
  Duration after{};
};

/// The programs of nodes end: an aircraft holds by its flight controller, a multirotor brakes and
/// stays. Those that start anew, where the fault ends, remember nothing. 0 is the ground station.
struct ProgramsEnd {
  std::vector<VehicleId> who;                          ///< empty where When::role finds one
  std::uint64_t pick = 0;                              ///< among those that have the role
  std::optional<Duration> sinks_after = std::nullopt;  ///< a multirotor comes down where it is
  bool with_airframe = false;                          ///< nothing flies 2 s later, in virtual time
};
/// A cell of the vehicle's battery fails: at once no more than that is left of it, as its gauge
/// tells. A vehicle to which that happens has a battery that, full, lasts for its range down to
/// its reserve.
struct BatteryFalls {
  VehicleId vehicle;
  double percent = 0.0;
};
/// The vehicle takes off only then.
struct LateStart {
  VehicleId vehicle;
};
/// A node's clock is so far ahead of the true time, all the mission long.
struct ClockOff {
  VehicleId node;
  Duration offset{};
};
/// The operator orders one vehicle, or all (0).
struct Ordered {
  VehicleId vehicle;
  mission::CommandKind kind{};
};
/// Somebody tells the team of all sites that are hidden still.
struct SitesReported {};
/// Detectors of those vehicles tell of a place, each of one that is 8 m from the one before: of
/// something where there is nothing, or of what is known already. The ground station takes it as a
/// site to be surveyed.
struct PlaceSeen {
  Vec2 place{0.0, 0.0};
  std::vector<VehicleId> by;
};
/// The operator withdraws that site; without one the newest of those that detectors have seen.
struct SiteWithdrawal {
  std::optional<SiteId> site;
};
/// The operator takes back what he has granted at that site, so long after he has; once any of it
/// can be taken back by then.
struct GrantTakenBack {
  SiteId site;
  Duration after{};
};
/// The operator gives those vehicles these routes over the air. They begin so long afterwards.
struct RoutesOrdered {
  std::map<VehicleId, TimedPath> routes;
  Duration begin_in{};
};
/// The radio is perfect from now on, and sites that nobody is at work on are reported: what is left
/// of the team must finish its work.
struct Healing {};

/// The programs of nodes stand still, and go on where they stood. Empty: as with ProgramsEnd.
/// Processes are stopped, and flight controllers hold meanwhile; in virtual time what controls the
/// aircraft goes on, by the guidance that it has.
struct ProgramsStall {
  std::vector<VehicleId> who;
  std::uint64_t pick = 0;
};

/// Pilots take aircraft, and keep them where they are, in an orbit or at rest; the operator gives
/// them back where the fault ends. Empty: as with ProgramsEnd. In virtual time.
struct PilotsTake {
  std::vector<VehicleId> who;
  std::uint64_t pick = 0;
};

/// The operator of the ground station that has not the command takes it. A mission with such a
/// fault has a second one, which listens from the start on (kSecondStation).
struct CommandTaken {};

// What only processes have; the simulator passes over it.

/// A node's program runs for the rest of the time only.
struct ProgramSlow {
  VehicleId node;
  double stopped_share = 0.0;
};
/// What a node's program writes to files is refused from now on.
struct DiskFull {
  VehicleId node;
};
/// A vehicle's clock is set, by so much: what starts anew there goes by that.
struct ClockStep {
  VehicleId vehicle;
  Duration by{};
};
/// A vehicle's program is of another release, all the mission long.
struct OtherRelease {
  VehicleId vehicle;
};

struct Fault {
  When when;
  std::optional<Duration> lasts;  ///< nothing: for good
  std::variant<ProgramsEnd, CommandTaken, radio::Cut, radio::Disturbance, radio::Flood, LateStart,
               ClockOff, Ordered, SitesReported, PlaceSeen, SiteWithdrawal, GrantTakenBack,
               RoutesOrdered, BatteryFalls, Healing, ProgramsStall, PilotsTake, ProgramSlow,
               DiskFull, ClockStep, OtherRelease>
      what;
};

/// The scenario's time line.
[[nodiscard]] std::vector<Fault> faults_of(const configuration::Scenario& scenario);

/// How far a node's clock is off; 0 unless a fault says otherwise.
[[nodiscard]] Duration clock_offset(const std::vector<Fault>& faults, VehicleId node);
/// Does a vehicle that does that have the role?
[[nodiscard]] bool has_role(mission::Activity activity, Role role);
/// The mission has a second ground station.
[[nodiscard]] bool has_second_station(const std::vector<Fault>& faults);
[[nodiscard]] bool is_of_other_release(const std::vector<Fault>& faults, VehicleId vehicle);
/// When a vehicle takes off: at the epoch, unless a fault says otherwise.
[[nodiscard]] Instant start_of(const std::vector<Fault>& faults, VehicleId vehicle);
/// When the radio heals; nothing: it does not.
[[nodiscard]] std::optional<Instant> healing_of(const std::vector<Fault>& faults);

/// All of its times, by so much.
[[nodiscard]] mission::MissionEvent shifted(mission::MissionEvent event, Duration by);

/// One line.
[[nodiscard]] std::string describe(const Fault& fault);
/// "U1, U3, ground".
[[nodiscard]] std::string names_of(const std::vector<VehicleId>& nodes);

}  // namespace skein::hil
