// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "skein/air/link.hpp"

namespace skein::air {

/// How a datagram of the air begins: the format, and whether it is for those who do not hear its
/// author, too (1 byte), and what its author's stream of parts holds: the number of the newest part
/// (2), and how many up to it can be had again (1). All numbers are big endian. Frames follow until
/// it ends, each with its kind first (1).
struct Head {
  std::uint16_t newest = 0;
  std::uint8_t held = 0;
  bool far = false;
  friend bool operator==(const Head&, const Head&) = default;
};
inline constexpr std::size_t kHeadBytes = 4;

/// What nobody asks for again: channel (1), length (2), bytes.
struct SampleFrame {
  std::uint8_t channel = 0;
  std::span<const std::uint8_t> bytes;
};
/// A piece of what is asked for again where it was lost: channel (1), number (2), length (2),
/// bytes. The kind says whether it begins or ends a sample, and whether it is said again.
struct PartFrame {
  std::uint8_t channel = 0;
  std::uint16_t number = 0;
  bool begins = false;
  bool ends = false;
  bool again = false;
  std::span<const std::uint8_t> bytes;
};
inline constexpr std::size_t kPartBytes = 6;  ///< more than its content
/// Who this is: role (1), and by which its certificate is known (4).
struct HelloFrame {
  std::uint8_t role = 0;
  std::uint32_t certificate = 0;
  friend bool operator==(const HelloFrame&, const HelloFrame&) = default;
};
/// Length (2), bytes.
struct CertificateFrame {
  std::span<const std::uint8_t> bytes;
};
/// Parts of that author's stream that were lost: the author (10), the first (2), and which of the
/// 32 after it (4).
struct MissingFrame {
  Author author;
  std::uint16_t first = 0;
  std::uint32_t more = 0;
};
inline constexpr std::uint64_t kMoreMissing = 32;
[[nodiscard]] bool is_asked_for(const MissingFrame& missing, std::uint16_t part);
/// That author's certificate is asked for (10).
struct WantFrame {
  Author author;
};
/// A datagram of another's, as it was on the air: how often it may be passed on yet (1), length
/// (2), bytes. The kind says whether it is late: said again for its parts, of which alone it is to
/// be taken. This and what follows, like questions, is for those who hear its sender alone.
struct PassedOnFrame {
  bool late = false;
  std::uint8_t hops = 0;
  std::span<const std::uint8_t> bytes;
};
inline constexpr std::size_t kPassedOnBytes = 4;  ///< more than its content
/// Whom its sender hears itself: the first node (2), length (1), and a bit for it and each node
/// after it, of each byte the lowest first. The kind says whether it goes on with the frame before.
struct HearingFrame {
  bool goes_on = false;
  VehicleId first;
  std::span<const std::uint8_t> bits;
};
/// Who another is: the author (10), role (1), length of its certificate (2), bytes.
struct IntroductionFrame {
  Author author;
  std::uint8_t role = 0;
  std::span<const std::uint8_t> certificate;
};
/// How far another's stream is: the author (10), the number of the newest part (2).
struct NewestFrame {
  Author author;
  std::uint16_t newest = 0;
};
using Frame = std::variant<SampleFrame, PartFrame, HelloFrame, CertificateFrame, MissingFrame,
                           WantFrame, PassedOnFrame, HearingFrame, IntroductionFrame, NewestFrame>;

/// Cuts the head off; none where it is not of this format.
[[nodiscard]] std::optional<Head> read_head(std::span<const std::uint8_t>& rest);
/// Cuts the next frame off; its bytes are those of the datagram. None where it is malformed.
[[nodiscard]] std::optional<Frame> read_frame(std::span<const std::uint8_t>& rest);

void write(std::vector<std::uint8_t>& out, const Head& head);
void write(std::vector<std::uint8_t>& out, const Frame& frame);
[[nodiscard]] std::size_t size_of(const Frame& frame);

}  // namespace skein::air
