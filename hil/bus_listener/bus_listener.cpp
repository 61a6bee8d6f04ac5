// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/bus_listener.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skein::hil {
namespace {

std::string addresses_of(const dronecan::Header& header) {
  using dronecan::TransferKind;
  const bool to_one = header.kind == TransferKind::request || header.kind == TransferKind::response;
  return fmt::format("{:>3} -> {:<3}", header.source,
                     to_one ? std::to_string(header.destination) : "all");
}

std::string line_of(const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  const std::string head = fmt::format("{} priority {:2} id {:2}  ", addresses_of(header),
                                       header.priority, header.transfer_id);
  const auto tunnel = dronecan::is<dronecan::Targetted>(transfer)
                          ? dronecan::decode<dronecan::Targetted>(transfer)
                          : std::nullopt;
  if (!tunnel) return head + dronecan::to_text(transfer);
  // Its bytes are told as what they are, in the lines that follow.
  return head + fmt::format("{} target_node={} serial_id={} bytes={}",
                            dronecan::Targetted::kDefinition.name, tunnel->target_node,
                            tunnel->serial_id, tunnel->buffer.size());
}

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace

std::vector<std::string> BusListener::on_frame(const can::Frame& frame) {
  ++frames_;
  now_ = std::max(now_, Instant{frame.timestamp});  // clocks of machines are set back now and then
  std::vector<std::string> lines;
  if (frame.error) {
    lines.push_back(
        fmt::format("error frame, class {:08x} data {}", frame.id, hex(frame.payload())));
    return lines;
  }
  if (!dronecan::header_of(frame)) {
    lines.push_back(fmt::format("not DroneCAN: id {:x} data {}", frame.id, hex(frame.payload())));
  }
  if (const auto* transfer = reassembler_.on_frame(frame, 0, now_)) {
    lines.push_back(line_of(*transfer));
    if (dronecan::is<dronecan::Targetted>(*transfer)) on_tunnel(*transfer, lines);
  }
  return lines;
}

void BusListener::on_tunnel(const dronecan::Transfer& transfer, std::vector<std::string>& lines) {
  const auto tunnel = dronecan::decode<dronecan::Targetted>(transfer);
  if (!tunnel) return;
  const TunnelStream stream{transfer.header.source, tunnel->target_node, tunnel->serial_id};
  tunnels_[stream].parse(tunnel->buffer, [&](const mavlink::Packet& packet) {
    lines.push_back(fmt::format("    MAVLink {}.{} #{:<3}  {}", packet.system, packet.component,
                                packet.sequence, mavlink::to_text(packet)));
  });
}

std::map<TunnelStream, mavlink::ParserStatistics> BusListener::tunnels() const {
  std::map<TunnelStream, mavlink::ParserStatistics> statistics;
  for (const auto& [stream, parser] : tunnels_) statistics[stream] = parser.statistics();
  return statistics;
}

std::string BusListener::summary() const {
  const auto& r = reassembly();
  std::string text = fmt::format(
      "{} frames, {} transfers; broken {} (order {}, CRC {}, length {}, unfinished {}), repeated "
      "{}, "
      "not checked {}, malformed {}, not DroneCAN {}\n",
      frames_, r.transfers, r.broken(), r.bad_order, r.bad_crc, r.too_long, r.interrupted,
      r.duplicates, r.unchecked, r.malformed, r.foreign);
  for (const auto& [stream, m] : tunnels()) {
    text += fmt::format(
        "MAVLink {} -> {}, port {}: {} packets, bad CRC {}, not in use {}, missing {}, other bytes "
        "{}\n",
        stream.source, stream.target, stream.serial_id, m.packets, m.bad_crc, m.unknown, m.lost,
        m.skipped_bytes);
  }
  return text;
}

}  // namespace skein::hil
