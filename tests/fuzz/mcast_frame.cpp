// SPDX-License-Identifier: Apache-2.0
//
// Any datagram of the multicast bus: as it is, and with its magic and checksum put right, because a
// fuzzer does not find those. A frame must come out of its own datagram the same.
#include <algorithm>
#include <vector>

#include "fuzz_input.hpp"
#include "skein/can/crc16.hpp"
#include "skein/can/mcast_datagram.hpp"

namespace skein::fuzz {
namespace {

void read(std::span<const std::uint8_t> datagram) {
  const auto frame = can::from_mcast(datagram);
  if (!frame) return;
  SKEIN_ASSERT(can::is_valid(*frame));
  const auto back = can::from_mcast(can::to_mcast(*frame));
  SKEIN_ASSERT(back && can::same_content(*back, *frame));
}

void run(std::span<const std::uint8_t> input) {
  read(input);
  if (input.size() < can::kMcastHeader) return;
  std::vector<std::uint8_t> mended{input.begin(), input.end()};
  can::Crc16 crc;
  crc.process_bytes(mended.data() + 4, mended.size() - 4);
  mended[0] = 0x34;
  mended[1] = 0x29;
  mended[2] = static_cast<std::uint8_t>(crc.checksum());
  mended[3] = static_cast<std::uint8_t>(crc.checksum() >> 8U);
  read(mended);
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
