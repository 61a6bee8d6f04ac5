// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "skein/base/result.hpp"
#include "skein/mcap/records.hpp"

namespace skein::mcap {

enum class Compression : std::uint8_t { none, zstd };

struct WriterOptions {
  std::string profile;
  std::string library;
  Compression compression = Compression::zstd;
  /// A chunk is closed, and handed to the system, when it spans so much log time or is so large;
  /// and at flush(). Whoever cuts the file off loses what came after.
  std::uint64_t chunk_span_ns = 1'000'000'000;
  std::size_t chunk_bytes = 256U << 10U;
};

/// Writes one file. Never throws; a disk error is kept and told by flush() and close(). For one
/// thread, and not a real-time one.
class Writer {
 public:
  /// Replaces the file. Fails with the path and the system's reason.
  [[nodiscard]] static Result<Writer> open(const std::filesystem::path& path,
                                           const WriterOptions& options);
  /// Closes, where close() was not called.
  ~Writer();
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Each stands in the file before what refers to it; the number is for doing so, from 1.
  [[nodiscard]] std::uint16_t add(const Schema& schema);
  [[nodiscard]] std::uint16_t add(const Channel& channel);
  void add(const Metadata& metadata);

  /// `message.sequence` is not looked at: the writer counts. Preconditions: the channel was added;
  /// the data is smaller than a chunk may be.
  void write(const Message& message);

  /// Closes the chunk and hands everything to the system. Fails if this or any earlier write
  /// failed.
  [[nodiscard]] Result<void> flush();
  /// As flush(), with the index. Nothing can be written afterwards.
  [[nodiscard]] Result<void> close();

  /// Bytes of the file so far, those of the open chunk before their compression.
  [[nodiscard]] std::uint64_t size() const;

 private:
  class Impl;
  explicit Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::mcap
