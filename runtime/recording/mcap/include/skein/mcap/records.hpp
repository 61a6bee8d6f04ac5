// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

/// Files of MCAP (mcap.dev/spec, version 0), as far as a recording needs them: messages in chunks,
/// with an index and statistics at the end. Times are nanoseconds; log time is what files are
/// ordered by.
namespace skein::mcap {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::size_t kRecordHead = 9;  ///< opcode and length
/// Of one chunk's records. More is not written, and not read.
inline constexpr std::uint64_t kChunkBytesMax = 32U << 20U;

struct Schema {
  std::string name;
  std::string encoding;
  std::string text;
};

struct Channel {
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic;
  std::string encoding;  ///< of its messages
  std::map<std::string, std::string> metadata;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> entries;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;  ///< counts the channel's messages
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::span<const std::uint8_t> data;
};

}  // namespace skein::mcap
