// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "skein/codec/cdr.hpp"
#include "skein/codec/topics.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

/// Which versions of which messages this release understands, as one line: equal where they are.
[[nodiscard]] std::string wire_versions();

/// The bytes of a sample (cdr.hpp). None where a value is out of its limits in idl/: a node does
/// not send what its peers would drop. Texts are cut at a character to what is allowed.
[[nodiscard]] std::optional<Bytes> encode(const mission::Message& message);

/// The message in the bytes of a sample on that topic. Any bytes are safe.
[[nodiscard]] std::variant<mission::Message, Refusal> decode(Topic topic,
                                                             std::span<const std::uint8_t> bytes);

/// The most bytes that a message of the topic can have, with room for what later releases append.
[[nodiscard]] std::size_t encoded_size_max(Topic topic);

/// "its skein::wire::Health is of version 9, ours of version 8". Precondition: the fault is
/// bad_version.
[[nodiscard]] std::string text_of(const Refusal& refusal, Topic topic);

/// The message as JSON in one line, as idl/ names its fields; integers of 64 bits are strings.
[[nodiscard]] std::string json_of(const mission::Message& message);

}  // namespace skein::codec
