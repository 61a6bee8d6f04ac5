// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a stream of MAVLink. However they are cut, the same packets come out; and each of
// them is the same after encoding it again.
#include <algorithm>
#include <vector>

#include "fuzz_input.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::fuzz {
namespace {

void comes_back(const mavlink::Packet& packet) {
  (void)mavlink::to_text(packet);
  const mavlink::MessageInfo* info = mavlink::find_message(packet.id);
  SKEIN_ASSERT(info != nullptr);
  mavlink::Encoder encoder{packet.system, packet.component};
  mavlink::Parser parser;
  std::size_t count = 0;
  parser.parse(encoder.encode(*info, packet.payload), [&](const mavlink::Packet& back) {
    ++count;
    SKEIN_ASSERT(back.id == packet.id && back.system == packet.system);
    // A newer sender may have more fields than are known here.
    SKEIN_ASSERT(std::equal(packet.payload.begin(), packet.payload.begin() + info->length,
                            back.payload.begin()));
  });
  SKEIN_ASSERT(count == 1);
}

void run(Input input) {
  const std::uint8_t flags = input.byte();
  const std::size_t cut = 1 + input.byte();
  mavlink::ParserParams params;
  if ((flags & 1U) != 0) {
    params.key = mavlink::key_of("secret");
    params.accept_unsigned = (flags & 2U) != 0;
  }
  mavlink::Parser whole{params};
  mavlink::Parser pieces{params};
  std::vector<mavlink::Packet> packets;
  whole.parse(input.rest(), [&](const mavlink::Packet& packet) {
    comes_back(packet);
    packets.push_back(packet);
  });
  std::size_t i = 0;
  while (!input.empty()) {
    pieces.parse(input.take(cut), [&](const mavlink::Packet& packet) {
      SKEIN_ASSERT(i < packets.size() && packet.payload == packets[i].payload);
      ++i;
    });
  }
  SKEIN_ASSERT(i == packets.size());
  const auto& a = whole.statistics();
  const auto& b = pieces.statistics();
  SKEIN_ASSERT(a.unknown == b.unknown && a.bad_crc == b.bad_crc && a.lost == b.lost);
  SKEIN_ASSERT(a.bad_signature == b.bad_signature && a.skipped_bytes == b.skipped_bytes);
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
