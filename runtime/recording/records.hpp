// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/recording/log.hpp"
#include "skein/schemas/schemas.hpp"

/// Records as bytes, CDR as on the wire, and back.
namespace skein::recording {

using Bytes = std::vector<std::uint8_t>;

/// One kind of record: the last words of its topic, and its schema.
struct RecordKind {
  std::string name;  ///< "track", "coalition/bid"
  const schemas::Schema* schema = nullptr;

  /// Of the mission network, not of this module.
  [[nodiscard]] bool is_message() const { return schema->type.starts_with("skein::wire::"); }
};

/// By the schema's name, if it is of a record or a message of ours; null otherwise.
[[nodiscard]] const RecordKind* kind_named(std::string_view schema_name);

struct Encoded {
  const RecordKind* kind = nullptr;
  Bytes bytes;
};
/// None where a value is out of its range.
[[nodiscard]] std::optional<Encoded> encode(const mission::Message& message);
[[nodiscard]] Encoded encode(const TrackPoint& point);
[[nodiscard]] std::optional<Encoded> encode(const mission::MissionEvent& event);
[[nodiscard]] Encoded encode(const PlanRecord& plan);
[[nodiscard]] Encoded encode(const PlaceRecord& place);
[[nodiscard]] Encoded encode(const Gap& gap);
[[nodiscard]] Encoded encode(const AgentStart& start);
[[nodiscard]] Encoded encode(const StateGiven& state);
[[nodiscard]] Encoded encode(const PlanningGiven& planning);
[[nodiscard]] Encoded encode(const TimeoutGiven& timeout);
[[nodiscard]] Encoded encode(const NoticeGiven& notice);
[[nodiscard]] Encoded encode(const ConditionGiven& condition);
[[nodiscard]] Encoded encode(const NamesakeHeard& namesake);
[[nodiscard]] Encoded encode(const PlanMade& plan);
[[nodiscard]] Encoded encode(const TrackMade& track);

[[nodiscard]] std::optional<Encoded> encode(const Content& content);

/// None where the bytes are not those of such a record, or a value is out of its range: numbers
/// must be finite, times within codec::kTimeMax. `now` is the record's own moment.
[[nodiscard]] std::optional<Content> decode(const RecordKind& kind,
                                            std::span<const std::uint8_t> bytes, Instant now);

/// Whose event these are the bytes of.
[[nodiscard]] std::optional<VehicleId> vehicle_of_event(const RecordKind& kind,
                                                        std::span<const std::uint8_t> bytes);

}  // namespace skein::recording
