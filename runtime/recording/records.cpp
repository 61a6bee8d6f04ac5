// SPDX-License-Identifier: Apache-2.0
#include "records.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <type_traits>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/codec/codec.hpp"
#include "skein/codec/json.hpp"
#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/idl/formation_fields.hpp"
#include "skein/idl/mission_fields.hpp"
#include "skein/idl/recording_fields.hpp"

namespace skein::recording {
namespace {

using codec::fields;

constexpr std::string_view kTopicPrefix = "skein/";

/// What the topic of a record ends in. That of an event that a node noted is its own; its bytes are
/// those of the message.
template <class T>
constexpr std::string_view kRecordName = codec::Type<T>::kRecord;
template <>
constexpr std::string_view kRecordName<mission::MissionEvent> = "event";

using Decoder = std::optional<Content> (*)(std::span<const std::uint8_t>, Instant);

template <class T>
std::optional<Content> decode_record(std::span<const std::uint8_t> bytes, Instant now) {
  auto decoded = codec::from_cdr<T>(bytes);
  T* record = std::get_if<T>(&decoded);
  if (record == nullptr) return std::nullopt;
  if constexpr (requires { record->now; }) record->now = now;
  return std::move(*record);
}

template <class T>
std::optional<Content> decode_message(std::span<const std::uint8_t> bytes, Instant /*now*/) {
  auto decoded = codec::from_cdr<T>(bytes);
  if (T* message = std::get_if<T>(&decoded)) return mission::Message{std::move(*message)};
  return std::nullopt;
}

/// Which of a union's members a value holds; 0 where it has no union.
class BranchFinder {
 public:
  template <codec::Union T>
  static std::size_t of(const T& value) {
    return value.index();
  }
  template <class T>
  static std::size_t of(const T& value) {
    BranchFinder finder;
    fields(value, finder);
    return finder.branch_;
  }
  static constexpr bool at_end() { return false; }
  template <class T, class Description>
  void operator()(const char* /*name*/, const T& value, Description /*description*/) {
    if constexpr (std::is_same_v<Description, codec::Choice>) branch_ = value.index();
  }

 private:
  std::size_t branch_ = 0;
};

/// Every kind of record: by the name of its topic, and by its type and branch. Made once.
class Kinds {
 public:
  Kinds() {
    for (std::size_t i = 0; i < std::variant_size_v<mission::Message::variant>; ++i) {
      codec::with_alternative<mission::Message>(i, [&]<class T>() {
        const std::string_view topic = codec::info(static_cast<codec::Topic>(i)).name;
        add<T>(topic.substr(kTopicPrefix.size()), &decode_message<T>, true);
      });
    }
    for (std::size_t i = 0; i < std::variant_size_v<Content>; ++i) {
      codec::with_alternative<Content>(i, [&]<class T>() {
        if constexpr (!std::is_same_v<T, mission::Message>) {
          add<T>(kRecordName<T>, &decode_record<T>, false);
        }
      });
    }
  }

  struct Known {
    RecordKind kind;
    Decoder decoder;
  };
  [[nodiscard]] const Known* find(std::string_view name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : &found->second;
  }
  template <class T>
  [[nodiscard]] const RecordKind* of(const T& value, bool is_message) const {
    const auto& branches = by_type_.at({codec::Type<T>::kName, is_message});
    return branches.at(BranchFinder::of(value));
  }

 private:
  template <class T>
  void add(std::string_view name, Decoder decoder, bool is_message) {
    auto& branches = by_type_[{codec::Type<T>::kName, is_message}];
    for (const schemas::Schema& schema : schemas::all()) {
      if (schema.type != codec::Type<T>::kName) continue;
      const std::string branch = schema.branch.empty() ? "" : "/" + std::string{schema.branch};
      const Known known{{std::string{name} + branch, &schema, is_message}, decoder};
      branches.push_back(&by_name_.emplace(known.kind.name, known).first->second.kind);
    }
    SKEIN_ASSERT(!branches.empty());
  }

  std::map<std::string, Known, std::less<>> by_name_;
  std::map<std::pair<std::string_view, bool>, std::vector<const RecordKind*>> by_type_;
};

const Kinds& kinds() {
  static const Kinds known;
  return known;
}

template <class T>
std::optional<Encoded> encode_as(const T& value, bool is_message) {
  auto bytes = codec::to_cdr(value);
  if (!bytes) return std::nullopt;
  return Encoded{kinds().of(value, is_message), std::move(*bytes)};
}

}  // namespace

const RecordKind* kind_named(std::string_view name) {
  const Kinds::Known* known = kinds().find(name);
  return known == nullptr ? nullptr : &known->kind;
}

std::optional<Encoded> encode(const Content& content) {
  return std::visit(
      []<class T>(const T& value) {
        if constexpr (std::is_same_v<T, mission::Message>) {
          return std::visit([](const auto& message) { return encode_as(message, true); }, value);
        } else {
          return encode_as(value, false);
        }
      },
      content);
}

std::vector<std::uint8_t> bytes_of(const Content& content) {
  auto encoded = encode(content);
  return encoded ? std::move(encoded->bytes) : Bytes{};
}

std::string text_of(const Content& content) {
  return std::visit(
      []<class T>(const T& value) {
        if constexpr (std::is_same_v<T, mission::Message>) {
          return codec::json_of(value);
        } else {
          return codec::json_text(codec::JsonWriter::of(value));
        }
      },
      content);
}

std::string type_of(const Content& content) {
  const auto name = []<class T>(const T& /*value*/) { return std::string{codec::Type<T>::kName}; };
  return std::visit(
      [name]<class T>(const T& value) {
        if constexpr (std::is_same_v<T, mission::Message>) {
          return std::visit(name, value);
        } else {
          return name(value);
        }
      },
      content);
}

std::optional<Content> decode(const RecordKind& kind, std::span<const std::uint8_t> bytes,
                              Instant now) {
  return kinds().find(kind.name)->decoder(bytes, now);
}

std::optional<VehicleId> vehicle_of_event(const RecordKind& kind,
                                          std::span<const std::uint8_t> bytes) {
  if (kind.is_message || kind.schema->type != codec::Type<mission::MissionEvent>::kName) {
    return std::nullopt;
  }
  auto decoded = codec::from_cdr<mission::MissionEvent>(bytes);
  const auto* event = std::get_if<mission::MissionEvent>(&decoded);
  return event == nullptr ? std::nullopt : std::optional{event->vehicle};
}

GuidanceMade made(const mission::Guidance& guidance, Instant now) {
  if (const auto* plan = std::get_if<mission::FlightPlan>(&guidance)) {
    return PlanMade{std::make_shared<const mission::FlightPlan>(*plan), now};
  }
  const auto& track = std::get<MotionTrack>(guidance);
  TrackMade record;
  record.number = track.number;
  record.start = track.start;
  record.points = track.count;
  const auto& first = track.points.front().position_m;
  record.first_m = {first[0], first[1], first[2]};
  constexpr std::uint64_t kOffset = 0xCBF29CE484222325U;
  constexpr std::uint64_t kPrime = 0x100000001B3U;
  std::uint64_t digest = kOffset;
  const auto add = [&digest](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned i = 0; i < 64; i += 8) digest = (digest ^ (bits >> i & 0xFFU)) * kPrime;
  };
  add(track.yaw_rad);
  for (std::size_t i = 0; i < std::min<std::size_t>(track.count, track.points.size()); ++i) {
    for (const double value : track.points[i].position_m) add(value);
    for (const double value : track.points[i].velocity_mps) add(value);
  }
  record.digest = digest;
  record.now = now;
  return record;
}

}  // namespace skein::recording
