// SPDX-License-Identifier: Apache-2.0
//
// Any payload as any type. What is decoded must be the same after encoding and decoding it.
#include <algorithm>

#include "fuzz_input.hpp"
#include "skein/dronecan/transfer.hpp"

namespace skein::fuzz {
namespace {

template <class Message>
void as(const dronecan::Transfer& transfer) {
  const auto message = dronecan::decode<Message>(transfer);
  if (!message) return;
  dronecan::Transfer again = transfer;
  again.payload = dronecan::to_payload(*message, transfer.fd);
  SKEIN_ASSERT(again.payload.size() <= transfer.payload.size());
  const auto back = dronecan::decode<Message>(again);
  SKEIN_ASSERT(back.has_value());
  const auto twice = dronecan::to_payload(*back, transfer.fd);
  SKEIN_ASSERT(std::ranges::equal(twice, again.payload));
}

void run(Input input) {
  dronecan::Transfer transfer;
  const std::uint8_t flags = input.byte();
  transfer.fd = (flags & 1U) != 0;
  for (const std::uint8_t byte : input.take(dronecan::kTransferMax))
    transfer.payload.push_back(byte);
  as<dronecan::NodeStatus>(transfer);
  as<dronecan::Targetted>(transfer);
  as<dronecan::NotifyState>(transfer);
  as<dronecan::GetNodeInfoRequest>(transfer);
  as<dronecan::GetNodeInfoResponse>(transfer);
  for (const auto& type : dronecan::types()) {
    transfer.header.type = type.id;
    transfer.header.kind = type.kind == dronecan::TypeKind::message
                               ? dronecan::TransferKind::message
                           : (flags & 2U) != 0 ? dronecan::TransferKind::request
                                               : dronecan::TransferKind::response;
    (void)dronecan::to_text(transfer);
  }
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
