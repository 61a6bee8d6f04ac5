// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::mission {

/// One vehicle as the ground station hears it.
struct FleetEntry {
  bool expected = false;
  std::optional<Telemetry> telemetry;            ///< the newest
  Instant heard_at{};                            ///< of it
  std::optional<Health> health;                  ///< the newest
  Instant health_at{};                           ///< when it was heard
  std::optional<Preflight> preflight = {};       ///< the newest
  Instant preflight_at{};                        ///< when it was heard
  bool silent = false;                           ///< was heard, and not since FleetParams::silence
  std::optional<SetupDifference> differs;        ///< from the ground station
  bool duplicate = false;                        ///< two instances speak with this id
  bool revoked = false;                          ///< put out of the mission: nobody hears it
  std::map<InstanceId, Instant> instances = {};  ///< who spoke with it lately, and when
  std::optional<CommandKind> obeys = {};         ///< the newest order that it has told to obey
  /// That it has told to come too near to it, by their addresses: whether it gives way.
  std::map<std::uint32_t, bool> aircraft = {};
};

struct FleetParams {
  std::vector<VehicleId> expected;
  Duration silence = std::chrono::seconds{5};
};

/// Which vehicles there are and how they are heard: the one place that finds silence, new starts
/// and ids that are used twice. Operator's decisions, prompt and page read it. Messages must be
/// their senders' to say. Copyable; `now` never decreases.
class Fleet {
 public:
  static constexpr std::size_t kStrangersMax = 64;
  static constexpr std::size_t kInstancesMax = 8;
  static constexpr std::size_t kAircraftKnownMax = 64;  ///< of each vehicle

  explicit Fleet(const FleetParams& params);

  /// Takes telemetry, health, what checks find and what vehicles tell of themselves from it.
  void on_message(const Message& message, Instant now);
  void on_timeout(Instant now);
  /// What the operator should know.
  [[nodiscard]] std::optional<event::FleetWarning> poll_news() { return news_.pop(); }

  [[nodiscard]] Instant next_timeout() const;
  [[nodiscard]] Duration silence() const { return params_.silence; }
  [[nodiscard]] std::uint64_t dropped() const { return news_.dropped(); }

  [[nodiscard]] const std::map<VehicleId, FleetEntry>& vehicles() const { return vehicles_; }
  [[nodiscard]] bool expects(VehicleId vehicle) const;
  [[nodiscard]] bool duplicate(VehicleId vehicle) const;
  /// A copy that comes after what its vehicle has said since.
  [[nodiscard]] bool is_late(const Telemetry& telemetry) const;

  /// These are out of the mission, and no others.
  void set_revoked(const std::set<VehicleId>& revoked);
  /// What that vehicle has in common with the ground station has changed.
  void set_difference(VehicleId vehicle, const SetupDifference* difference);
  /// Why that vehicle is not worked with, as a sentence: its setup, or its id; none where it is.
  [[nodiscard]] std::optional<std::string> why_not_with(VehicleId vehicle) const;

 private:
  void on_telemetry(const Telemetry& telemetry, Instant now);
  void on_event(const MissionEvent& event);
  void warn(event::FleetNews news, VehicleId vehicle, Duration silence = {});
  void forget_instances(FleetEntry& entry, Instant now) const;

  FleetParams params_;
  std::map<VehicleId, FleetEntry> vehicles_;
  Instant due_ = Instant::min();  ///< before that on_timeout() finds nothing
  BoundedQueue<event::FleetWarning> news_{1024};
};

}  // namespace skein::mission
