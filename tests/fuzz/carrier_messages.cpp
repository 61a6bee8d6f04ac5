// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as what the process that carries the network says to its node, and the other way.
#include "carrier_messages.hpp"

#include <algorithm>
#include <span>

#include "fuzz_input.hpp"

namespace skein::fuzz {
namespace {

/// What is read and written again is read as the same.
template <class Message, class Read>
void run(std::span<const std::uint8_t> bytes, Read read) {
  const auto message = read(bytes);
  if (!message) return;
  const auto written = network::to_bytes(*message);
  SKEIN_ASSERT(written.size() <= network::kCarrierMessageBytesMax);
  const auto again = read(written);
  SKEIN_ASSERT(again && again->index() == message->index());
  SKEIN_ASSERT(network::to_bytes(Message{*again}) == written);
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace network = skein::network;
  skein::fuzz::run<network::ToCarrier>({data, size}, network::to_carrier_from);
  skein::fuzz::run<network::FromCarrier>({data, size}, network::from_carrier_from);
  return 0;
}
