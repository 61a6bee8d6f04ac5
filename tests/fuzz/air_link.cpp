// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as what a member of the team says on the air, between a link's own business.
#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "fuzz_input.hpp"
#include "skein/air/link.hpp"

namespace skein::fuzz {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kDatagramBytes = 300;

class Heard final : public air::LinkSink {
 public:
  /// The first byte says who said it, the next which it is, and whether it is heard first.
  std::optional<air::Opened> open(std::span<const std::uint8_t> datagram) override {
    if (datagram.size() < 2) return std::nullopt;
    const air::Author author{VehicleId{datagram[0]}, InstanceId{2}};
    if (datagram[1] % 4 == 0) return air::Opened{author, datagram[1], std::nullopt};
    return air::Opened{author, datagram[1], datagram.subspan(2)};
  }
  void on_sample(std::uint8_t channel, const air::Author&,
                 std::span<const std::uint8_t> bytes) override {
    SKEIN_ASSERT(channel < 2 && bytes.size() <= air::Link::kSampleMax);
  }
  void on_certificate(const air::Author&, std::span<const std::uint8_t>) override {}
};

/// The first byte of each piece says how long it is, whose it is, and how much later it comes.
void run(std::span<const std::uint8_t> bytes) {
  Heard heard;
  air::LinkConfig config;
  config.self = {VehicleId{1}, InstanceId{1}};
  config.channels = {{.reliable = true, .urgency = air::Urgency::decision, .kept = 4},
                     {.reliable = false, .urgency = air::Urgency::motion, .kept = 1}};
  config.certificate = {1, 2, 3};
  config.datagram_bytes = kDatagramBytes;
  config.mtu_bytes = kDatagramBytes + config.overhead_bytes;
  config.hops_max = 3;
  Instant now{};
  air::Link link{config, heard, now};
  while (!bytes.empty()) {
    const std::uint8_t how = bytes[0];
    const auto piece = bytes.subspan(1, std::min<std::size_t>(how % 64U, bytes.size() - 1));
    bytes = bytes.subspan(1 + piece.size());
    now += how % 7U * 10ms;
    SKEIN_ASSERT(link.send(how % 2U, {piece.begin(), piece.end()}, now));
    link.hear({{VehicleId{how}, InstanceId{2}}, piece.size(), piece}, piece, now);
    for (int said = 0; const auto datagram = link.poll(now); ++said) {
      SKEIN_ASSERT(datagram->size() <= kDatagramBytes && said < 100);
    }
    SKEIN_ASSERT(link.due() > now);
  }
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
