// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/mcap/records.hpp"

namespace skein::mcap {

/// Where a chunk stands in its file, and what it says of its messages.
struct ChunkPlace {
  std::uint64_t offset = 0;  ///< of its opcode
  std::uint64_t length = 0;  ///< of its record, without opcode and length
  std::uint64_t begin_ns = 0;
  std::uint64_t end_ns = 0;
};

/// Reads one file, also while it is being written. Where its index is missing or broken, as in a
/// file that was cut off, all of it is looked through, and what is whole is found. Any bytes are
/// safe. For one thread.
class Reader {
 public:
  /// Fails where the file cannot be read, or does not begin as MCAP does.
  [[nodiscard]] static Result<Reader> open(const std::filesystem::path& path);
  /// The same, of bytes that outlive it; `name` stands for the file in messages.
  [[nodiscard]] static Result<Reader> of_bytes(std::span<const std::uint8_t> bytes,
                                               const std::string& name);
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const std::string& profile() const;
  [[nodiscard]] const std::string& library() const;
  /// Closed by its writer, with its index.
  [[nodiscard]] bool is_complete() const;
  /// Parts that were left out so far: a record that was cut off, a chunk whose checksum or content
  /// is wrong.
  [[nodiscard]] std::size_t damaged() const;

  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const;
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const;
  [[nodiscard]] const std::vector<Metadata>& metadata() const;
  [[nodiscard]] const std::vector<ChunkPlace>& chunks() const;  ///< in the order of the file

  /// The chunk's records. None, and counted, where it is damaged.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> load(const ChunkPlace& chunk);

  /// Every message of the file in the order in which it was written; false from `take` ends it.
  void for_each(const std::function<bool(const Message&)>& take);

 private:
  class Impl;
  explicit Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The messages among a chunk's records, in their order; the data points into `records`. False from
/// `take` ends it. False where the records do not end with the bytes.
bool for_each_message(std::span<const std::uint8_t> records,
                      const std::function<bool(const Message&)>& take);

}  // namespace skein::mcap
