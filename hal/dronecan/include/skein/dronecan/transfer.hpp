// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/base/static_vector.hpp"
#include "skein/base/time.hpp"
#include "skein/can/frame.hpp"
#include "skein/dronecan/messages.hpp"

/// Transfers of DroneCAN (UAVCAN v0): messages and services in one frame or many.
namespace skein::dronecan {

enum class TransferKind : std::uint8_t { message, request, response, anonymous };

inline constexpr std::uint8_t kPriorityHigh = 8;
inline constexpr std::uint8_t kPriorityMedium = 16;
inline constexpr std::uint8_t kPriorityLow = 24;
inline constexpr std::uint8_t kPriorityLowest = 31;
inline constexpr std::uint8_t kNodeIdMax = 127;
/// Bytes. The longest in use, GetNodeInfo, has 376.
inline constexpr std::size_t kTransferMax = 512;

using Payload = StaticVector<std::uint8_t, kTransferMax>;

struct Header {
  TransferKind kind = TransferKind::message;
  std::uint16_t type = 0;                   ///< data type id; of an anonymous one, its low 2 bits
  std::uint8_t priority = kPriorityMedium;  ///< 0 is served first, 31 last
  std::uint8_t source = 0;                  ///< node, 1..127; 0 anonymous
  std::uint8_t destination = 0;             ///< of requests and responses
  std::uint8_t transfer_id = 0;             ///< 0..31
};

/// The 29-bit id of every frame of a transfer. Precondition: not anonymous.
[[nodiscard]] std::uint32_t can_id(const Header& header);
/// Without the transfer id. Nothing for a frame that is no DroneCAN frame.
[[nodiscard]] std::optional<Header> header_of(const can::Frame& frame);

struct Transfer {
  Header header;
  Payload payload;
  Instant begun;               ///< when its first frame came
  std::uint8_t interface = 0;  ///< that it came over
  bool fd = false;
};

/// Every frame of the longest transfer in classic frames.
using TransferFrames = StaticVector<can::Frame, (kTransferMax + 2 + 6) / 7>;

/// Cuts a transfer into frames. Preconditions: source 1..127, payload <= kTransferMax.
[[nodiscard]] TransferFrames to_frames(const Header& header, std::uint64_t signature,
                                       std::span<const std::uint8_t> payload, bool fd);

/// A message as a payload, for FD frames or classic ones.
template <class Message>
[[nodiscard]] Payload to_payload(const Message& message, bool fd) {
  std::array<std::uint8_t, kTransferMax> bytes{};
  BitWriter writer{bytes};
  wire::encode(message, writer, fd ? TailArray::with_length : TailArray::bare);
  SKEIN_ASSERT(writer.ok());
  Payload payload;
  for (std::size_t i = 0; i < writer.size(); ++i) payload.push_back(bytes[i]);
  return payload;
}

/// The message of a transfer, or nothing if the payload is not one. Whether it is of this type is
/// the caller's to know: see is().
template <class Message>
[[nodiscard]] std::optional<Message> decode(const Transfer& transfer) {
  Message message;
  BitReader reader{transfer.payload};
  const TailArray tail = transfer.fd ? TailArray::with_length : TailArray::bare;
  if (!wire::decode(reader, tail, message)) return std::nullopt;
  return message;
}

/// Whether the transfer is of the type; of a service, whether it is a request or a response.
template <class Message>
[[nodiscard]] bool is(const Transfer& transfer) {
  return Message::kDefinition.kind == TypeKind::message &&
         transfer.header.kind == TransferKind::message &&
         transfer.header.type == Message::kDefinition.id;
}
template <>
[[nodiscard]] inline bool is<GetNodeInfoRequest>(const Transfer& transfer) {
  return transfer.header.kind == TransferKind::request &&
         transfer.header.type == GetNodeInfoRequest::kDefinition.id;
}
template <>
[[nodiscard]] inline bool is<GetNodeInfoResponse>(const Transfer& transfer) {
  return transfer.header.kind == TransferKind::response &&
         transfer.header.type == GetNodeInfoResponse::kDefinition.id;
}

/// "uavcan.protocol.NodeStatus uptime_sec=1 health=0 ...", for people; a type not in use by number
/// and bytes.
[[nodiscard]] std::string to_text(const Transfer& transfer);

struct ReassemblyStatistics {
  std::uint64_t transfers = 0;    ///< delivered
  std::uint64_t unchecked = 0;    ///< of these, of many frames and of a type not in use: no CRC
  std::uint64_t duplicates = 0;   ///< transfers that came again
  std::uint64_t redundant = 0;    ///< frames of an interface that is not listened to
  std::uint64_t foreign = 0;      ///< frames that are not DroneCAN's
  std::uint64_t malformed = 0;    ///< frames that say what cannot be
  std::uint64_t bad_order = 0;    ///< transfers dropped: a frame missing, twice or out of place
  std::uint64_t bad_crc = 0;      ///< transfers dropped
  std::uint64_t too_long = 0;     ///< transfers dropped
  std::uint64_t interrupted = 0;  ///< transfers that never ended

  [[nodiscard]] std::uint64_t broken() const {
    return bad_order + bad_crc + too_long + interrupted;
  }
};

/// Makes transfers of frames. Every sender, type and destination is followed by itself; with two
/// interfaces that carry the same, each is listened to on one of them, until that is silent for
/// `interface_switch`. A transfer that comes again is dropped.
class Reassembler {
 public:
  struct Params {
    Duration timeout = std::chrono::seconds{2};           ///< after it anything begins afresh
    Duration interface_switch = std::chrono::seconds{1};  ///< silence before the other is taken
    std::size_t sessions = 64;  ///< followed at a time; then the oldest goes
  };

  Reassembler() : Reassembler{Params{}} {}
  explicit Reassembler(const Params& params);

  /// The transfer that the frame completes, valid until the next call, or null.
  /// Precondition: `now` never decreases.
  const Transfer* on_frame(const can::Frame& frame, std::uint8_t interface, Instant now);

  [[nodiscard]] const ReassemblyStatistics& statistics() const { return statistics_; }

 private:
  struct Session {
    std::uint32_t key = 0;  ///< the CAN id without its priority
    bool assembling = false;
    bool known = false;  ///< last_id is of a transfer that began
    bool toggle = false;
    std::uint8_t transfer_id = 0;
    std::uint16_t crc = 0;  ///< as sent
    Instant heard;          ///< the last frame that was taken
    Transfer transfer;
  };

  Session& session_of(std::uint32_t key);
  bool may_begin(Session& session, std::uint8_t transfer_id, std::uint8_t interface, Instant now);
  bool may_go_on(Session& session, std::uint8_t transfer_id, bool toggle, std::uint8_t interface,
                 Instant now);
  const Transfer* finish(Session& session, bool many_frames);
  const Transfer* on_anonymous(const Header& header, const can::Frame& frame,
                               std::uint8_t interface, Instant now);

  Params params_;
  std::vector<Session> sessions_;
  Transfer anonymous_;
  ReassemblyStatistics statistics_;
};

}  // namespace skein::dronecan
