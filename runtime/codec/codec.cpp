// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/codec.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/Exception.h>

#include <exception>
#include <type_traits>

#include "event_cdr.hpp"
#include "wire.hpp"

namespace skein::codec {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::size_t kEncapsulation = 4;

std::span<char> chars(std::span<std::uint8_t> bytes) {
  return {reinterpret_cast<char*>(bytes.data()), bytes.size()};
}

template <class Wire>
std::optional<std::vector<std::uint8_t>> encode_as(const Wire& w) {
  bool ok = true;
  static_cast<void>(from_wire(w, ok));
  if (!ok) return std::nullopt;
  std::vector<std::uint8_t> bytes(kEncapsulation + Wire::getCdrSerializedSize(w));
  FastBuffer buffer{chars(bytes).data(), bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  try {
    cdr.serialize_encapsulation();
    w.serialize(cdr);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return std::nullopt;
  }
  return bytes;
}

template <class Wire>
std::variant<mission::Message, Fault> decode_as(std::span<const std::uint8_t> sample) {
  // Fast CDR reads through char*; a copy spares a const_cast and bounds what it can touch.
  std::vector<std::uint8_t> bytes{sample.begin(), sample.end()};
  FastBuffer buffer{chars(bytes).data(), bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  Wire w;
  try {
    cdr.read_encapsulation();
    Cdr::state start = cdr.getState();
    std::uint16_t version = 0;
    cdr >> version;
    if (version != wire::kVersion) return Fault::bad_version;
    cdr.setState(start);
    w.deserialize(cdr);
  } catch (const std::exception&) {
    return Fault::malformed;
  }
  // A text beyond its bound, or with a zero in it, comes out of the generated code shortened: then
  // what was read is longer than what the value would be written as.
  const std::size_t read = cdr.getSerializedDataLength();
  const std::size_t canonical = kEncapsulation + Wire::getCdrSerializedSize(w);
  if (read != canonical) return Fault::bad_value;
  if (bytes.size() - read >= 4) return Fault::malformed;  // RTPS pads to 4
  bool ok = true;
  mission::Message message = from_wire(w, ok);
  if (!ok) return Fault::bad_value;
  return message;
}

std::optional<std::vector<std::uint8_t>> encode_event(const mission::MissionEvent& event) {
  std::vector<std::uint8_t> bytes(kEncapsulation + wire::MissionEvent::getMaxCdrSerializedSize());
  FastBuffer buffer{chars(bytes).data(), bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  try {
    cdr.serialize_encapsulation();
    write(cdr, event);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return std::nullopt;
  }
  bytes.resize(cdr.getSerializedDataLength());
  const auto read =
      decode(Topic::mission_event, bytes);  // so that nothing goes out that is refused
  if (std::holds_alternative<Fault>(read)) return std::nullopt;
  return bytes;
}

std::variant<mission::Message, Fault> decode_event(std::span<const std::uint8_t> sample) {
  std::vector<std::uint8_t> bytes{sample.begin(), sample.end()};
  FastBuffer buffer{chars(bytes).data(), bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  bool ok = true;
  try {
    cdr.read_encapsulation();
    std::uint16_t version = 0;
    cdr >> version;
    if (version != wire::kVersion) return Fault::bad_version;
    mission::MissionEvent event = read_event(cdr, ok);
    if (!ok) return Fault::bad_value;
    if (bytes.size() - cdr.getSerializedDataLength() >= 4) return Fault::malformed;
    return event;
  } catch (const std::exception&) {
    return Fault::malformed;
  }
}

/// Calls `f` with the wire type of the topic.
template <class F>
auto with_type(Topic topic, F f) {
  switch (topic) {
    case Topic::coalition:
      return f(std::type_identity<wire::CoalitionMessage>{});
    case Topic::authorisation_request:
      return f(std::type_identity<wire::AuthorisationRequest>{});
    case Topic::authorisation:
      return f(std::type_identity<wire::Authorisation>{});
    case Topic::mission_event:
      return f(std::type_identity<wire::MissionEvent>{});
    case Topic::command:
      return f(std::type_identity<wire::Command>{});
    case Topic::site_report:
      return f(std::type_identity<wire::SiteReport>{});
    case Topic::hazard_report:
      return f(std::type_identity<wire::HazardReport>{});
    case Topic::formation_change:
      return f(std::type_identity<wire::FormationChange>{});
    case Topic::formation_status:
      return f(std::type_identity<wire::FormationStatus>{});
    case Topic::plan_report:
      return f(std::type_identity<wire::PlanReport>{});
    case Topic::health:
      return f(std::type_identity<wire::Health>{});
    case Topic::telemetry:
    case Topic::count:
      break;
  }
  return f(std::type_identity<wire::Telemetry>{});
}

}  // namespace

std::optional<std::vector<std::uint8_t>> encode(const mission::Message& message) {
  return std::visit(
      [](const auto& m) -> std::optional<std::vector<std::uint8_t>> {
        if constexpr (std::is_same_v<std::decay_t<decltype(m)>, mission::MissionEvent>) {
          return encode_event(m);
        } else {
          return encode_as(to_wire(m));
        }
      },
      message);
}

std::variant<mission::Message, Fault> decode(Topic topic, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > encoded_size_max(topic)) return Fault::malformed;
  return with_type(topic, [bytes](auto type) {
    using Wire = typename decltype(type)::type;
    if constexpr (std::is_same_v<Wire, wire::MissionEvent>) {
      return decode_event(bytes);
    } else {
      return decode_as<Wire>(bytes);
    }
  });
}

std::size_t encoded_size_max(Topic topic) {
  return with_type(topic, [](auto type) {
    const std::size_t size = kEncapsulation + decltype(type)::type::getMaxCdrSerializedSize();
    return (size + 3) / 4 * 4;
  });
}

}  // namespace skein::codec
