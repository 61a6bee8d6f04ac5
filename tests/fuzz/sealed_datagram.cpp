// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a datagram from the air, and as an RTPS message that is sealed and opened.
#include <algorithm>
#include <span>
#include <vector>

#include "fuzz_input.hpp"
#include "rtps_datagram.hpp"
#include "skein/network/rtps_guid.hpp"
#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"

namespace skein::fuzz {
namespace {

void run(std::span<const std::uint8_t> bytes) {
  static const seal::EpochKey key{.epoch = 1};
  static seal::Sealer sealer{{.sender = VehicleId{3}, .number = 1, .random = 2}, key};
  static std::vector<std::uint8_t> datagram;
  static std::vector<std::uint8_t> plain;
  static seal::Opener opener;
  static const bool ready = (opener.accept(key), true);
  SKEIN_ASSERT(ready);

  // The fuzzer would have to forge it.
  SKEIN_ASSERT(opener.open(bytes, plain, Instant{}).opened != seal::Opened::good);

  SKEIN_ASSERT(sealer.seal(bytes, datagram));
  SKEIN_ASSERT(opener.open(datagram, plain, Instant{}).opened == seal::Opened::good);
  SKEIN_ASSERT(std::equal(plain.begin(), plain.end(), bytes.begin(), bytes.end()));

  const auto message = network::without_statistics(bytes);
  if (!message) return;
  SKEIN_ASSERT(network::is_rtps(bytes) && message->data() == bytes.data());
  SKEIN_ASSERT(message->size() == bytes.size() || message->size() + 60 == bytes.size());
  const auto again = network::without_statistics(*message);
  SKEIN_ASSERT(again && again->size() == message->size());
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
