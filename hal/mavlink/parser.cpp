// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/parser.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"

namespace skein::mavlink {
namespace {

constexpr std::uint8_t kMagic1 = 0xFE;
constexpr std::uint8_t kMagic2 = 0xFD;
constexpr std::size_t kHeader1 = 6;
constexpr std::size_t kHeader2 = 10;
constexpr std::size_t kChecksum = 2;
constexpr std::uint8_t kFlagSigned = 0x01;
/// Ids beyond are in no public definition. Believing them would let noise hold up what follows.
constexpr std::uint32_t kPlausibleIds = 65536;

bool is_magic(std::uint8_t byte) { return byte == kMagic1 || byte == kMagic2; }

std::uint16_t checksum(std::span<const std::uint8_t> covered, std::uint8_t extra) {
  X25 crc;
  crc.add(covered);
  crc.add(extra);
  return crc.value();
}

}  // namespace

Parser::Parser(const ParserParams& params) : accept_unsigned_{params.accept_unsigned} {
  if (params.key) checker_.emplace(*params.key, params.now);
}

std::size_t Parser::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > 0) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  // next() leaves less than a packet behind, so there is always room for some.
  const std::size_t taken = std::min(bytes.size(), buffer_.size() - end_);
  SKEIN_ASSERT(taken > 0);
  std::copy_n(bytes.begin(), taken, buffer_.begin() + static_cast<std::ptrdiff_t>(end_));
  end_ += taken;
  return taken;
}

const Packet* Parser::next() {
  while (begin_ < end_) {
    const std::span<const std::uint8_t> bytes{buffer_.data() + begin_, end_ - begin_};
    std::size_t size = 0;
    switch (judge(bytes, size)) {
      case Verdict::wait:
        return nullptr;
      case Verdict::not_a_packet:
        ++statistics_.skipped_bytes;
        ++begin_;
        break;
      case Verdict::skip:
        begin_ += size;
        break;
      case Verdict::packet:
        begin_ += size;
        ++statistics_.packets;
        return &packet_;
    }
  }
  return nullptr;
}

Parser::Verdict Parser::judge(std::span<const std::uint8_t> bytes, std::size_t& size) {
  if (!is_magic(bytes[0])) return Verdict::not_a_packet;
  const bool second = bytes[0] == kMagic2;
  const std::size_t header = second ? kHeader2 : kHeader1;
  if (second && bytes.size() > 2 && (bytes[2] & ~kFlagSigned) != 0) return Verdict::not_a_packet;
  if (bytes.size() < header) return Verdict::wait;

  packet_.version = second ? 2 : 1;
  packet_.length = bytes[1];
  packet_.is_signed = second && (bytes[2] & kFlagSigned) != 0;
  packet_.sequence = second ? bytes[4] : bytes[2];
  packet_.system = second ? bytes[5] : bytes[3];
  packet_.component = second ? bytes[6] : bytes[4];
  packet_.id = second ? bytes[7] | static_cast<std::uint32_t>(bytes[8]) << 8U |
                            static_cast<std::uint32_t>(bytes[9]) << 16U
                      : bytes[5];
  const MessageInfo* info = find_message(packet_.id);
  if (info == nullptr && packet_.id >= kPlausibleIds) return Verdict::not_a_packet;

  const std::size_t covered = header + packet_.length;
  size = covered + kChecksum + (packet_.is_signed ? kSignatureSize : 0);
  if (bytes.size() < size) return Verdict::wait;
  if (info == nullptr) return judge_unknown(bytes, size);

  const auto sent = static_cast<std::uint16_t>(bytes[covered] | bytes[covered + 1] << 8);
  if (checksum(bytes.subspan(1, covered - 1), info->crc_extra) != sent) {
    ++statistics_.bad_crc;
    return Verdict::not_a_packet;
  }
  if (!signature_holds(bytes.first(size))) {
    ++statistics_.bad_signature;
    return Verdict::skip;
  }
  packet_.payload.fill(0);
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(header), packet_.length,
              packet_.payload.begin());
  count_sequence();
  return Verdict::packet;
}

Parser::Verdict Parser::judge_unknown(std::span<const std::uint8_t> bytes, std::size_t size) {
  // Its checksum cannot be known; that another packet follows at once speaks for it.
  if (bytes.size() == size) return Verdict::wait;
  if (!is_magic(bytes[size])) return Verdict::not_a_packet;
  ++statistics_.unknown;
  statistics_.last_unknown = packet_.id;
  count_sequence();
  return Verdict::skip;
}

bool Parser::signature_holds(std::span<const std::uint8_t> packet) {
  if (!checker_) return true;
  if (!packet_.is_signed) return accept_unsigned_;
  return checker_->accept(packet, packet_.system, packet_.component);
}

void Parser::count_sequence() {
  const auto after = static_cast<std::uint8_t>(packet_.sequence + 1);
  for (Sender& sender : senders_) {
    if (sender.system != packet_.system || sender.component != packet_.component) continue;
    statistics_.lost += static_cast<std::uint8_t>(packet_.sequence - sender.next);
    sender.next = after;
    return;
  }
  (void)senders_.try_push_back({packet_.system, packet_.component, after});
}

WireBytes Encoder::encode(const MessageInfo& info, const Payload& payload) {
  std::size_t length = info.length;
  while (length > 1 && payload[length - 1] == 0) --length;  // the first byte always stays

  WireBytes bytes;
  const std::array<std::uint8_t, kHeader2> header{kMagic2,
                                                  static_cast<std::uint8_t>(length),
                                                  signer_ ? kFlagSigned : std::uint8_t{0},
                                                  0,
                                                  sequence_++,
                                                  system_,
                                                  component_,
                                                  static_cast<std::uint8_t>(info.id),
                                                  static_cast<std::uint8_t>(info.id >> 8U),
                                                  static_cast<std::uint8_t>(info.id >> 16U)};
  for (const std::uint8_t byte : header) bytes.push_back(byte);
  for (std::size_t i = 0; i < length; ++i) bytes.push_back(payload[i]);
  const std::span<const std::uint8_t> packet{bytes};
  const std::uint16_t crc = checksum(packet.subspan(1), info.crc_extra);
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  if (signer_) signer_->sign(bytes);
  return bytes;
}

}  // namespace skein::mavlink
