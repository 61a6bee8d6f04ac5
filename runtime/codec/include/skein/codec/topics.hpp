// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

/// What crosses the mission network. Few, because the cost of discovery grows with the square of
/// the nodes times the topics.
enum class Topic : std::uint8_t {
  telemetry,
  coalition,
  authorisation_request,
  authorisation,
  mission_event,
  command,
  site_report,
  hazard_report,
  formation_change,
  formation_status,
  plan_report,
  health,
  count
};
inline constexpr std::size_t kTopicCount = static_cast<std::size_t>(Topic::count);

/// What a node is on the network. It decides which topics it writes and reads.
enum class Role : std::uint8_t { vehicle = 1, ground = 2 };

/// A set of roles.
struct Roles {
  bool vehicle = false;
  bool ground = false;
  [[nodiscard]] constexpr bool has(Role role) const {
    return role == Role::vehicle ? vehicle : ground;
  }
};
inline constexpr Roles kVehicles{true, false};
inline constexpr Roles kGround{false, true};
inline constexpr Roles kAll{true, true};

/// One topic with everything that DDS is told about it. Durability is volatile everywhere: nothing
/// old is sent to who joins; the protocols above repeat what is still of use.
struct TopicInfo {
  Topic topic;
  std::string_view name;
  std::string_view type;  ///< in idl/
  Roles writers;
  Roles readers;
  bool reliable;                ///< resent until acknowledged, and in the sender's order
  std::int32_t writer_history;  ///< samples kept for resending; the oldest gives way, never blocks
  std::int32_t reader_history;  ///< samples kept while an earlier one is missing
  Duration heartbeat_period;    ///< of reliable writers: a loss is repaired after about this
};

inline constexpr Duration kHeartbeatPeriod = std::chrono::milliseconds{100};

/// Every topic. No other place names one, or a QoS value.
inline constexpr std::array<TopicInfo, kTopicCount> kTopics{{
    {Topic::telemetry, "skein/telemetry", "skein::wire::Telemetry", kVehicles, kAll, false, 1, 64,
     Duration{}},
    {Topic::coalition, "skein/coalition", "skein::wire::CoalitionMessage", kAll, kAll, true, 64,
     256, kHeartbeatPeriod},
    {Topic::authorisation_request, "skein/authorisation_request",
     "skein::wire::AuthorisationRequest", kVehicles, kGround, true, 16, 64, kHeartbeatPeriod},
    {Topic::authorisation, "skein/authorisation", "skein::wire::Authorisation", kGround, kVehicles,
     true, 16, 64, kHeartbeatPeriod},
    {Topic::mission_event, "skein/mission_event", "skein::wire::MissionEvent", kAll, kGround, true,
     128, 256, kHeartbeatPeriod},
    {Topic::command, "skein/command", "skein::wire::Command", kGround, kVehicles, true, 16, 64,
     kHeartbeatPeriod},
    {Topic::site_report, "skein/site_report", "skein::wire::SiteReport", kAll, kAll, true, 32, 64,
     kHeartbeatPeriod},
    {Topic::hazard_report, "skein/hazard_report", "skein::wire::HazardReport", kAll, kAll, true, 32,
     64, kHeartbeatPeriod},
    {Topic::formation_change, "skein/formation_change", "skein::wire::FormationChange", kGround,
     kVehicles, true, 4, 4, kHeartbeatPeriod},
    {Topic::formation_status, "skein/formation_status", "skein::wire::FormationStatus", kVehicles,
     kAll, false, 1, 64, Duration{}},
    {Topic::plan_report, "skein/plan_report", "skein::wire::PlanReport", kVehicles, kGround, true,
     4, 16, kHeartbeatPeriod},
    {Topic::health, "skein/health", "skein::wire::Health", kVehicles, kGround, false, 1, 64,
     Duration{}},
}};

[[nodiscard]] constexpr const TopicInfo& info(Topic topic) {
  return kTopics.at(static_cast<std::size_t>(topic));
}

/// The topic that carries the message.
[[nodiscard]] Topic topic_of(const mission::Message& message);

/// docs/topics.md.
[[nodiscard]] std::string topics_document();

}  // namespace skein::codec
