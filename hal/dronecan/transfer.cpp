// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/transfer.hpp"

#include <algorithm>
#include <span>

#include "skein/base/assert.hpp"
#include "skein/can/crc16.hpp"

namespace skein::dronecan {
namespace {

constexpr std::uint8_t kStart = 0x80;
constexpr std::uint8_t kEnd = 0x40;
constexpr std::uint8_t kToggle = 0x20;
constexpr std::uint8_t kTransferIdMask = 0x1F;
constexpr std::uint32_t kService = 0x80;
constexpr std::uint32_t kRequest = 0x8000;
constexpr std::uint32_t kPriorityShift = 24;
constexpr std::size_t kCrcSize = 2;
constexpr std::uint8_t kPriorityMask = 0x1F;

can::Crc16 crc_of_signature(std::uint64_t signature) {
  can::Crc16 crc;
  for (unsigned i = 0; i < 8; ++i) {
    crc.process_byte(static_cast<std::uint8_t>(signature >> (8 * i)));
  }
  return crc;
}

TypeKind type_kind(TransferKind kind) {
  return kind == TransferKind::request || kind == TransferKind::response ? TypeKind::service
                                                                         : TypeKind::message;
}

}  // namespace

std::uint32_t can_id(const Header& header) {
  SKEIN_ASSERT(header.kind != TransferKind::anonymous);
  SKEIN_ASSERT(header.source >= 1 && header.source <= kNodeIdMax);
  SKEIN_ASSERT(header.priority <= kPriorityLowest);
  const std::uint32_t priority = std::uint32_t{header.priority} << kPriorityShift;
  if (header.kind == TransferKind::message) {
    return priority | std::uint32_t{header.type} << 8U | header.source;
  }
  SKEIN_ASSERT(header.type <= 0xFF && header.destination >= 1 && header.destination <= kNodeIdMax);
  return priority | std::uint32_t{header.type} << 16U |
         (header.kind == TransferKind::request ? kRequest : 0) |
         std::uint32_t{header.destination} << 8U | kService | header.source;
}

std::optional<Header> header_of(const can::Frame& frame) {
  if (!frame.extended || frame.rtr || frame.error || frame.size == 0) return std::nullopt;
  Header header;
  header.priority = static_cast<std::uint8_t>(frame.id >> kPriorityShift & kPriorityMask);
  header.source = static_cast<std::uint8_t>(frame.id & kNodeIdMax);
  if ((frame.id & kService) != 0) {
    header.kind = (frame.id & kRequest) != 0 ? TransferKind::request : TransferKind::response;
    header.type = static_cast<std::uint16_t>(frame.id >> 16U & 0xFFU);
    header.destination = static_cast<std::uint8_t>(frame.id >> 8U & kNodeIdMax);
    if (header.source == 0 || header.destination == 0) return std::nullopt;
    return header;
  }
  header.type = static_cast<std::uint16_t>(frame.id >> 8U & 0xFFFFU);
  if (header.source == 0) {
    header.kind = TransferKind::anonymous;
    header.type &= 3U;
  }
  return header;
}

TransferFrames to_frames(const Header& header, std::uint64_t signature,
                         std::span<const std::uint8_t> payload, bool fd) {
  SKEIN_ASSERT(payload.size() <= kTransferMax);
  const std::size_t room = (fd ? can::kFdDataMax : can::kClassicDataMax) - 1;
  const bool many = payload.size() > room;
  const std::size_t prefix = many ? kCrcSize : 0;
  // FD has frames of a few sizes only: the last one is filled up with zeros, which are part of the
  // transfer.
  const std::size_t rest = (payload.size() + prefix) % room;
  const std::size_t padding = fd && (rest > 0 || !many) ? can::fd_size(rest + 1) - rest - 1 : 0;
  const std::size_t total = prefix + payload.size() + padding;

  can::Crc16 crc = crc_of_signature(signature);
  crc.process_bytes(payload.data(), payload.size());
  for (std::size_t i = 0; i < padding; ++i) crc.process_byte(0);
  const auto byte_at = [&](std::size_t i) -> std::uint8_t {
    if (i < prefix) return static_cast<std::uint8_t>(crc.checksum() >> (8 * i));
    return i - prefix < payload.size() ? payload[i - prefix] : std::uint8_t{0};
  };

  can::Frame frame;
  frame.id = can_id(header);
  frame.extended = true;
  frame.fd = fd;
  TransferFrames frames;
  std::size_t at = 0;
  bool toggle = false;
  do {
    const std::size_t size = std::min(room, total - at);
    for (std::size_t i = 0; i < size; ++i) frame.data[i] = byte_at(at + i);
    const bool last = at + size == total;
    frame.data[size] =
        static_cast<std::uint8_t>((at == 0 ? kStart : 0) | (last ? kEnd : 0) |
                                  (toggle ? kToggle : 0) | (header.transfer_id & kTransferIdMask));
    frame.size = static_cast<std::uint8_t>(size + 1);
    frames.push_back(frame);
    at += size;
    toggle = !toggle;
  } while (at < total);
  return frames;
}

Reassembler::Reassembler(const Params& params) : params_{params} {
  SKEIN_ASSERT(params.sessions > 0);
  sessions_.reserve(params.sessions);
}

Reassembler::Session& Reassembler::session_of(std::uint32_t key) {
  Session* oldest = nullptr;
  for (Session& session : sessions_) {
    if (session.key == key) return session;
    if (oldest == nullptr || session.heard < oldest->heard) oldest = &session;
  }
  if (sessions_.size() < params_.sessions) {
    Session& added = sessions_.emplace_back();
    added.key = key;
    return added;
  }
  if (oldest->assembling) ++statistics_.interrupted;
  *oldest = Session{};
  oldest->key = key;
  return *oldest;
}

/// Whether a first frame begins a transfer that is not known yet.
bool Reassembler::may_begin(Session& session, std::uint8_t transfer_id, std::uint8_t interface,
                            Instant now) {
  if (!session.known) return true;
  const Duration silence = now - session.heard;
  if (silence > params_.timeout) return true;
  const bool same_interface = session.transfer.interface == interface;
  if (!same_interface && silence <= params_.interface_switch) {
    ++statistics_.redundant;
    return false;
  }
  // A transfer that was cut may be begun again, by a sender that has counted on or one that
  // repeats.
  if (transfer_id == session.transfer_id && !session.assembling) {
    ++statistics_.duplicates;
    return false;
  }
  return true;
}

bool Reassembler::may_go_on(Session& session, std::uint8_t transfer_id, bool toggle,
                            std::uint8_t interface, Instant now) {
  if (session.known && interface != session.transfer.interface) {
    ++statistics_.redundant;
    return false;
  }
  if (!session.assembling) {
    // The rest of a transfer that was dropped, and counted when it was; or one whose beginning
    // was never heard.
    if (!session.known) ++statistics_.bad_order;
    session.known = true;
    session.transfer.interface = interface;
    session.transfer_id = transfer_id;
    session.heard = now;
    return false;
  }
  if (toggle != session.toggle || transfer_id != session.transfer_id ||
      now - session.heard > params_.timeout) {
    session.assembling = false;
    ++statistics_.bad_order;
    return false;
  }
  return true;
}

const Transfer* Reassembler::on_anonymous(const Header& header, const can::Frame& frame,
                                          std::uint8_t interface, Instant now) {
  const std::uint8_t tail = frame.data[frame.size - 1U];
  if ((tail & (kStart | kEnd | kToggle)) != (kStart | kEnd)) {
    ++statistics_.malformed;
    return nullptr;
  }
  anonymous_ = {header, {}, now, interface, frame.fd};
  anonymous_.header.transfer_id = tail & kTransferIdMask;
  for (std::size_t i = 0; i + 1 < frame.size; ++i) anonymous_.payload.push_back(frame.data[i]);
  ++statistics_.transfers;
  return &anonymous_;
}

const Transfer* Reassembler::on_frame(const can::Frame& frame, std::uint8_t interface,
                                      Instant now) {
  const auto header = header_of(frame);
  if (!header) {
    ++statistics_.foreign;
    return nullptr;
  }
  if (header->kind == TransferKind::anonymous) return on_anonymous(*header, frame, interface, now);

  const std::size_t size = frame.size - 1U;
  const std::uint8_t tail = frame.data[size];
  const std::uint8_t transfer_id = tail & kTransferIdMask;
  const bool start = (tail & kStart) != 0;
  const bool end = (tail & kEnd) != 0;
  const bool toggle = (tail & kToggle) != 0;
  if ((start && toggle) || (start && !end && size < kCrcSize)) {
    ++statistics_.malformed;
    return nullptr;
  }

  Session& session = session_of(frame.id & ~(std::uint32_t{kPriorityMask} << kPriorityShift));
  std::size_t from = 0;
  if (start) {
    if (!may_begin(session, transfer_id, interface, now)) return nullptr;
    if (session.assembling) ++statistics_.interrupted;
    session.known = true;
    session.assembling = true;
    session.toggle = false;
    session.transfer_id = transfer_id;
    session.transfer.header = *header;
    session.transfer.header.transfer_id = transfer_id;
    session.transfer.payload.clear();
    session.transfer.begun = now;
    session.transfer.interface = interface;
    session.transfer.fd = frame.fd;
    if (!end) {
      session.crc = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
      from = kCrcSize;
    }
  } else if (!may_go_on(session, transfer_id, toggle, interface, now)) {
    return nullptr;
  }
  session.heard = now;
  session.toggle = !session.toggle;
  Payload& payload = session.transfer.payload;
  if (payload.size() + size - from > Payload::capacity()) {
    session.assembling = false;
    ++statistics_.too_long;
    return nullptr;
  }
  for (std::size_t i = from; i < size; ++i) payload.push_back(frame.data[i]);
  return end ? finish(session, !start) : nullptr;
}

const Transfer* Reassembler::finish(Session& session, bool many_frames) {
  session.assembling = false;
  const Transfer& transfer = session.transfer;
  if (many_frames) {
    const TypeInfo* type = find_type(type_kind(transfer.header.kind), transfer.header.type);
    if (type == nullptr) {
      ++statistics_.unchecked;
    } else {
      can::Crc16 crc = crc_of_signature(type->signature);
      const std::span<const std::uint8_t> payload{transfer.payload};
      crc.process_bytes(payload.data(), payload.size());
      if (crc.checksum() != session.crc) {
        ++statistics_.bad_crc;
        return nullptr;
      }
    }
  }
  ++statistics_.transfers;
  return &transfer;
}

}  // namespace skein::dronecan
