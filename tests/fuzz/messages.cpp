// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a sample of any topic: what is accepted is within its limits, so it can be sent and
// comes back the same.
#include "fuzz_input.hpp"
#include "skein/codec/codec.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace codec = skein::codec;
  skein::fuzz::Input input{data, size};
  const auto topic = static_cast<codec::Topic>(input.byte() % codec::kTopicCount);
  const auto decoded = codec::decode(topic, input.rest());
  if (const auto* refusal = std::get_if<codec::Refusal>(&decoded)) {
    SKEIN_ASSERT(!codec::text_of(*refusal, topic).empty());
    return 0;
  }
  const auto& message = std::get<skein::mission::Message>(decoded);
  const auto bytes = codec::encode(message);
  SKEIN_ASSERT(bytes && bytes->size() <= codec::encoded_size_max(topic));
  const auto again = codec::decode(topic, *bytes);
  const auto* same = std::get_if<skein::mission::Message>(&again);
  SKEIN_ASSERT(same != nullptr && codec::encode(*same) == bytes);
  SKEIN_ASSERT(!codec::json_of(message).empty());
  return 0;
}
