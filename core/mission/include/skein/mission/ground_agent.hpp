// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// A decision that a scripted scenario takes in the operator's place.
struct ScriptedDecision {
  SiteId site;
  bool grant = true;
  Duration reaction{};  ///< after the request arrived
  Instant not_before{};
};

struct GroundAgentConfig {
  std::vector<VehicleId> expected;          ///< the fleet
  std::vector<ScriptedDecision> decisions;  ///< empty: a person decides
  Duration silence = std::chrono::seconds{5};
};

/// The fleet as the ground station sees it.
struct FleetEntry {
  std::optional<Telemetry> telemetry;
  Instant heard_at{};
  bool silent = false;     ///< was heard, and not since GroundAgentConfig::silence
  bool duplicate = false;  ///< two instances speak with this id
};

/// One request for authorisation, and what became of it.
struct PendingAuthorisation {
  AuthorisationRequest request;
  Instant asked_at{};
  std::optional<Authorisation> decision;
};

/// All decisions of the ground station, without I/O: keeps the fleet picture, holds requests for
/// authorisation, sends decisions and commands until they are of no more use. Same calling rules as
/// VehicleAgent. An authorisation is only ever made by authorise(), refuse() or a scripted
/// decision.
class GroundAgent {
 public:
  GroundAgent(const GroundAgentConfig& config, Instant now);

  void on_message(const Message& message, VehicleId sender, Instant now);
  void on_timeout(Instant now);

  /// The operator's decision on the newest request for that site. Fails when there is none waiting.
  Result<void> authorise(SiteId site, const std::string& operator_name, Instant now);
  Result<void> refuse(SiteId site, const std::string& operator_name, Instant now);
  /// A command to one vehicle, or to all (kGroundStation). Fails for a vehicle not in the fleet.
  Result<void> command(VehicleId vehicle, CommandKind kind, Instant now);

  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] std::optional<MissionEvent>
  poll_event();  ///< its own and those of vehicles, once each
  [[nodiscard]] Instant next_timeout() const;

  [[nodiscard]] const std::map<VehicleId, FleetEntry>& fleet() const { return fleet_; }
  [[nodiscard]] const std::vector<PendingAuthorisation>& authorisations() const { return pending_; }

 private:
  Result<void> decide(SiteId site, bool granted, const std::string& by, Instant now);
  void report(EventKind kind, const coalition::Round& round, const TaskId& task, Instant now,
              std::string text);

  GroundAgentConfig config_;
  std::map<VehicleId, FleetEntry> fleet_;
  std::vector<PendingAuthorisation> pending_;
  struct SentCommand {
    Command command;
    Instant repeat_until{};
  };
  std::vector<SentCommand> commands_;
  std::uint32_t next_command_ = 1;
  Instant now_{};
  Instant next_repeat_{};
  BoundedQueue<Message> messages_{256};
  BoundedQueue<MissionEvent> events_{4096};
};

}  // namespace skein::mission
