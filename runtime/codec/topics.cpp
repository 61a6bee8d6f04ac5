// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/topics.hpp"

#include <variant>

namespace skein::codec {
namespace {

constexpr bool in_order() {
  for (std::size_t i = 0; i < kTopicCount; ++i) {
    if (kTopics.at(i).topic != static_cast<Topic>(i)) return false;
  }
  return true;
}
static_assert(in_order(), "kTopics must stand in the order of Topic");

struct TopicOf {
  Topic operator()(const coalition::Message&) const { return Topic::coalition; }
  Topic operator()(const mission::Telemetry&) const { return Topic::telemetry; }
  Topic operator()(const mission::AuthorisationRequest&) const {
    return Topic::authorisation_request;
  }
  Topic operator()(const mission::Authorisation&) const { return Topic::authorisation; }
  Topic operator()(const mission::MissionEvent&) const { return Topic::mission_event; }
  Topic operator()(const mission::Command&) const { return Topic::command; }
  Topic operator()(const mission::SiteReport&) const { return Topic::site_report; }
  Topic operator()(const mission::HazardReport&) const { return Topic::hazard_report; }
  Topic operator()(const formation::Change&) const { return Topic::formation_change; }
  Topic operator()(const mission::FormationStatus&) const { return Topic::formation_status; }
  Topic operator()(const mission::PlanReport&) const { return Topic::plan_report; }
  Topic operator()(const mission::Health&) const { return Topic::health; }
};

std::string_view words(Roles roles) {
  if (roles.vehicle && roles.ground) return "all";
  return roles.vehicle ? "vehicles" : "ground";
}

}  // namespace

Topic topic_of(const mission::Message& message) { return std::visit(TopicOf{}, message); }

std::string topics_document() {
  std::string text =
      "# Topics\n\n"
      "Printed from `runtime/codec/include/skein/codec/topics.hpp`; a test compares them. The types "
      "are in `idl/`.\n"
      "Durability is volatile, history is keep-last: the oldest sample gives way, so a writer "
      "never waits for a reader.\n"
      "A reliable topic keeps the order of each sender; a loss is repaired at the next heartbeat.\n"
      "\n"
      "| topic | type | written by | read by | delivery | kept by writer | kept by reader | "
      "heartbeat |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const TopicInfo& t : kTopics) {
    text += "| `";
    text += t.name;
    text += "` | `";
    text += t.type;
    text += "` | ";
    text += words(t.writers);
    text += " | ";
    text += words(t.readers);
    text += t.reliable ? " | reliable | " : " | best effort | ";
    text += std::to_string(t.writer_history) + " | " + std::to_string(t.reader_history) + " | ";
    text += t.reliable ? std::to_string(t.heartbeat_period / std::chrono::milliseconds{1}) + " ms"
                       : std::string{"-"};
    text += " |\n";
  }
  return text;
}

}  // namespace skein::codec
