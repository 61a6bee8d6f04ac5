// SPDX-License-Identifier: Apache-2.0
//
// Frames of any order, kind and time, over two interfaces, to a node with a tunnel. What is
// reassembled must come out the same when it is sent again.
#include <algorithm>
#include <array>

#include "fuzz_input.hpp"
#include "skein/can/frame.hpp"
#include "skein/dronecan/tunnel.hpp"

namespace skein::fuzz {
namespace {

/// Of each frame: a byte of flags, the id, the size, the data.
can::Frame next_frame(Input& input, std::uint8_t flags) {
  can::Frame frame;
  frame.extended = (flags & 0x10U) == 0;
  frame.error = (flags & 0x60U) == 0x60U;
  frame.fd = (flags & 0x02U) != 0;
  frame.id = input.word() & (frame.extended ? can::kExtendedIdMask : can::kStandardIdMask);
  const std::size_t size = input.byte() % (frame.fd ? 65U : 9U);
  const auto data = input.take(frame.fd ? can::fd_size(size) : size);
  frame.size = static_cast<std::uint8_t>(frame.fd ? can::fd_size(data.size()) : data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

void comes_back(const dronecan::Transfer& transfer) {
  const dronecan::TypeKind kind = transfer.header.kind == dronecan::TransferKind::message
                                      ? dronecan::TypeKind::message
                                      : dronecan::TypeKind::service;
  const auto* type = dronecan::find_type(kind, transfer.header.type);
  if (transfer.header.kind == dronecan::TransferKind::anonymous || type == nullptr) return;
  dronecan::Reassembler again;
  const dronecan::Transfer* back = nullptr;
  for (const can::Frame& frame :
       dronecan::to_frames(transfer.header, type->signature, transfer.payload, transfer.fd)) {
    SKEIN_ASSERT(can::is_valid(frame) && back == nullptr);
    back = again.on_frame(frame, 0, Instant{});
  }
  SKEIN_ASSERT(back != nullptr);
  SKEIN_ASSERT(back->payload.size() >= transfer.payload.size());
  SKEIN_ASSERT(std::equal(transfer.payload.begin(), transfer.payload.end(), back->payload.begin()));
}

void run(Input input) {
  dronecan::NodeParams params;
  params.transmit_limit = 8;
  Instant now;
  dronecan::Node node{params, now};
  dronecan::TunnelPort port{{}, now};
  dronecan::Reassembler everything{{std::chrono::seconds{2}, std::chrono::seconds{1}, 3}};
  constexpr std::array<int, 4> kPauses_ms{0, 1, 1100, 2100};
  while (!input.empty()) {
    const std::uint8_t flags = input.byte();
    now += std::chrono::milliseconds{kPauses_ms.at(flags >> 2U & 3U)};
    const auto interface = static_cast<std::uint8_t>(flags & 1U);
    const can::Frame frame = next_frame(input, flags);
    if (const auto* transfer = everything.on_frame(frame, interface, now)) {
      (void)dronecan::to_text(*transfer);
      if (transfer->payload.size() + 64 <= dronecan::kTransferMax) comes_back(*transfer);
    }
    if (const auto* transfer = node.on_frame(frame, interface, now)) {
      port.on_transfer(*transfer, node.node_id(), now);
    }
    node.step(now);
    port.step(node, now);
    SKEIN_ASSERT(node.next_timeout() >= now);
    if ((flags & 0x80U) != 0 && !node.front().empty()) node.pop();
    while (node.poll_event()) {
    }
    std::array<std::uint8_t, 64> read{};
    (void)port.read(read);
  }
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
