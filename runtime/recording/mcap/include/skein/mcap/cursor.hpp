// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "skein/mcap/reader.hpp"

namespace skein::mcap {

/// The messages of several files in the order of their log times; at one time those of the first
/// file first, each file's in its order. Holds the chunks of the present moment in memory only.
class Cursor {
 public:
  struct Item {
    std::size_t file = 0;
    Message message;  ///< its data is good until the next call
  };

  /// The readers must outlive it. `wanted` chooses channels, by file and number; empty: all.
  explicit Cursor(std::vector<Reader*> files,
                  std::function<bool(std::size_t, std::uint16_t)> wanted = {});

  /// next() goes on with the first message at or after that time.
  void seek(std::uint64_t log_time_ns);
  [[nodiscard]] std::optional<Item> next();

 private:
  struct Chunk {
    std::size_t file = 0;
    ChunkPlace place;
  };
  struct Pending {
    std::uint64_t time_ns = 0;
    std::size_t file = 0;
    std::uint64_t chunk = 0;  ///< its offset
    std::size_t order = 0;    ///< within the chunk
    Message message;
    std::shared_ptr<const std::vector<std::uint8_t>> records;  ///< that hold its data
  };
  struct Later {
    bool operator()(const Pending& a, const Pending& b) const;
  };
  void load(const Chunk& chunk);

  std::vector<Reader*> files_;
  std::function<bool(std::size_t, std::uint16_t)> wanted_;
  std::vector<Chunk> chunks_;  ///< by their begin
  std::size_t next_chunk_ = 0;
  std::uint64_t from_ns_ = 0;
  std::vector<Pending> pending_;  ///< a heap
  Pending current_;
};

}  // namespace skein::mcap
