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
  bool is_message = false;  ///< of the mission network, not of this module
};

/// By the last words of its topic; null where it is none of ours.
[[nodiscard]] const RecordKind* kind_named(std::string_view name);

struct Encoded {
  const RecordKind* kind = nullptr;
  Bytes bytes;
};
/// None where a value is out of its range.
[[nodiscard]] std::optional<Encoded> encode(const Content& content);

/// None where the bytes are not those of such a record, or a value is out of its range. `now` is
/// the record's own moment.
[[nodiscard]] std::optional<Content> decode(const RecordKind& kind,
                                            std::span<const std::uint8_t> bytes, Instant now);

/// Whose event these are the bytes of.
[[nodiscard]] std::optional<VehicleId> vehicle_of_event(const RecordKind& kind,
                                                        std::span<const std::uint8_t> bytes);

}  // namespace skein::recording
