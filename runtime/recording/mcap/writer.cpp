// SPDX-License-Identifier: Apache-2.0
#include "skein/mcap/writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "bytes.hpp"
#include "crc32.hpp"

namespace skein::mcap {
namespace {

constexpr int kZstdLevel = 1;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

struct ChunkEntry {
  std::uint64_t begin_ns = 0;
  std::uint64_t end_ns = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t index_length = 0;
  std::uint64_t compressed = 0;
  std::uint64_t uncompressed = 0;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;  ///< channel, offset
};

struct MetadataEntry {
  std::string name;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

struct ChannelState {
  Bytes body;  ///< of its record, for the summary
  std::uint64_t messages = 0;
  /// Of the open chunk: log time and offset in it, of each message.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> index;
};

}  // namespace

class Writer::Impl {
 public:
  Impl(std::string path, std::FILE* file, const WriterOptions& options)
      : path_{std::move(path)}, options_{options}, file_{file}, context_{ZSTD_createCCtx()} {
    put_bytes(pending_, kMagic);
    Bytes body;
    put_text(body, options_.profile);
    put_text(body, options_.library);
    emit(Opcode::header, body);
    hand_out();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { (void)close(); }

  std::uint16_t add(const Schema& schema) {
    const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
    Bytes body;
    put(body, id);
    put_text(body, schema.name);
    put_text(body, schema.encoding);
    put_text(body, schema.text);
    emit(Opcode::schema, body);
    schemas_.push_back(std::move(body));
    return id;
  }

  std::uint16_t add(const Channel& channel) {
    const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
    Bytes body;
    put(body, id);
    put(body, channel.schema);
    put_text(body, channel.topic);
    put_text(body, channel.encoding);
    put_map(body, channel.metadata);
    emit(Opcode::channel, body);
    channels_.push_back({std::move(body), 0, {}});
    return id;
  }

  void add(const Metadata& metadata) {
    Bytes body;
    put_text(body, metadata.name);
    put_map(body, metadata.entries);
    metadata_.push_back({metadata.name, offset(), kRecordHead + body.size()});
    emit(Opcode::metadata, body);
  }

  void write(const Message& message) {
    if (closed_) return;
    constexpr std::size_t kMessageHead = 2 + 4 + 8 + 8;
    SKEIN_ASSERT(message.channel >= 1 && message.channel <= channels_.size());
    SKEIN_ASSERT(message.data.size() < kChunkBytesMax - kRecordHead - kMessageHead);
    const std::size_t size = kRecordHead + kMessageHead + message.data.size();
    const std::uint64_t time = message.log_time_ns;
    const bool spans = !chunk_.empty() && std::max(end_ns_, time) - std::min(begin_ns_, time) >=
                                              options_.chunk_span_ns;
    if (spans || chunk_.size() + size > std::max(options_.chunk_bytes, size)) {
      close_chunk();
      hand_out();
    }
    ChannelState& channel = channels_[message.channel - 1U];
    channel.index.emplace_back(time, chunk_.size());
    put(chunk_, static_cast<std::uint8_t>(Opcode::message));
    put<std::uint64_t>(chunk_, kMessageHead + message.data.size());
    put(chunk_, message.channel);
    put(chunk_, static_cast<std::uint32_t>(channel.messages++));
    put(chunk_, time);
    put(chunk_, message.publish_time_ns);
    put_bytes(chunk_, message.data);
    begin_ns_ = std::min(begin_ns_, time);
    end_ns_ = std::max(end_ns_, time);
  }

  Result<void> flush() {
    close_chunk();
    hand_out();
    if (error_ == 0) return {};
    return Error{"cannot write " + path_ + ": " + std::generic_category().message(error_)};
  }

  Result<void> close() {
    if (closed_) return flush();
    close_chunk();
    write_summary();
    closed_ = true;
    auto flushed = flush();
    file_.reset();
    return flushed;
  }

  [[nodiscard]] std::uint64_t size() const { return offset() + chunk_.size(); }

 private:
  /// Where the next byte will stand in the file.
  [[nodiscard]] std::uint64_t offset() const { return handed_ + pending_.size(); }

  void emit(Opcode opcode, std::span<const std::uint8_t> body) {
    put(pending_, static_cast<std::uint8_t>(opcode));
    put<std::uint64_t>(pending_, body.size());
    put_bytes(pending_, body);
  }

  void hand_out() {
    if (file_ == nullptr) return;
    crc_ = crc32(pending_, crc_);
    handed_ += pending_.size();
    if (error_ == 0 && !pending_.empty()) {
      errno = 0;
      if (std::fwrite(pending_.data(), 1, pending_.size(), file_.get()) != pending_.size() ||
          std::fflush(file_.get()) != 0) {
        error_ = errno != 0 ? errno : EIO;
      }
    }
    pending_.clear();
  }

  /// The bytes of the chunk as they stand in the file.
  std::span<const std::uint8_t> compress() {
    if (options_.compression == Compression::none) return chunk_;
    compressed_.resize(ZSTD_compressBound(chunk_.size()));
    const std::size_t size =
        ZSTD_compressCCtx(context_.get(), compressed_.data(), compressed_.size(), chunk_.data(),
                          chunk_.size(), kZstdLevel);
    SKEIN_ASSERT(ZSTD_isError(size) == 0);  // only for want of room, and there is room
    return std::span{compressed_}.first(size);
  }

  [[nodiscard]] std::string_view compression() const {
    return options_.compression == Compression::none ? "" : "zstd";
  }

  void close_chunk() {
    if (chunk_.empty()) return;
    const auto records = compress();
    ChunkEntry entry;
    entry.begin_ns = begin_ns_;
    entry.end_ns = end_ns_;
    entry.offset = offset();
    entry.compressed = records.size();
    entry.uncompressed = chunk_.size();

    put(pending_, static_cast<std::uint8_t>(Opcode::chunk));
    const std::size_t length_at = pending_.size();
    put<std::uint64_t>(pending_, 0);
    put(pending_, begin_ns_);
    put(pending_, end_ns_);
    put<std::uint64_t>(pending_, chunk_.size());
    put(pending_, crc32(chunk_));
    put_text(pending_, compression());
    put<std::uint64_t>(pending_, records.size());
    put_bytes(pending_, records);
    put_at<std::uint64_t>(pending_, length_at, pending_.size() - length_at - sizeof(std::uint64_t));
    entry.length = offset() - entry.offset;

    const std::uint64_t indexes_begin = offset();
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      auto& index = channels_[i].index;
      if (index.empty()) continue;
      const auto id = static_cast<std::uint16_t>(i + 1);
      entry.indexes.emplace_back(id, offset());
      constexpr std::size_t kEntry = 16;
      put(pending_, static_cast<std::uint8_t>(Opcode::message_index));
      put<std::uint64_t>(pending_, sizeof id + sizeof(std::uint32_t) + kEntry * index.size());
      put(pending_, id);
      put(pending_, static_cast<std::uint32_t>(kEntry * index.size()));
      for (const auto& [time, at] : index) {
        put(pending_, time);
        put(pending_, at);
      }
      index.clear();
    }
    entry.index_length = offset() - indexes_begin;
    chunks_.push_back(std::move(entry));
    chunk_.clear();
    begin_ns_ = std::numeric_limits<std::uint64_t>::max();
    end_ns_ = 0;
  }

  void put_chunk_index(const ChunkEntry& chunk) {
    Bytes body;
    put(body, chunk.begin_ns);
    put(body, chunk.end_ns);
    put(body, chunk.offset);
    put(body, chunk.length);
    constexpr std::size_t kEntry = 10;
    put(body, static_cast<std::uint32_t>(kEntry * chunk.indexes.size()));
    for (const auto& [channel, at] : chunk.indexes) {
      put(body, channel);
      put(body, at);
    }
    put(body, chunk.index_length);
    put_text(body, compression());
    put(body, chunk.compressed);
    put(body, chunk.uncompressed);
    emit(Opcode::chunk_index, body);
  }

  void put_statistics() {
    Bytes counts;
    std::uint64_t messages = 0;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].messages == 0) continue;
      put(counts, static_cast<std::uint16_t>(i + 1));
      put(counts, channels_[i].messages);
      messages += channels_[i].messages;
    }
    std::uint64_t begin = chunks_.empty() ? 0 : chunks_.front().begin_ns;
    std::uint64_t end = 0;
    for (const ChunkEntry& chunk : chunks_) {
      begin = std::min(begin, chunk.begin_ns);
      end = std::max(end, chunk.end_ns);
    }
    Bytes body;
    put(body, messages);
    put(body, static_cast<std::uint16_t>(schemas_.size()));
    put(body, static_cast<std::uint32_t>(channels_.size()));
    put<std::uint32_t>(body, 0);  // attachments
    put(body, static_cast<std::uint32_t>(metadata_.size()));
    put(body, static_cast<std::uint32_t>(chunks_.size()));
    put(body, begin);
    put(body, end);
    put(body, static_cast<std::uint32_t>(counts.size()));
    put_bytes(body, counts);
    emit(Opcode::statistics, body);
  }

  void write_summary() {
    hand_out();  // so that the sum is that of all data
    Bytes end;
    put(end, crc_);
    emit(Opcode::data_end, end);
    hand_out();

    const std::uint64_t begin = offset();
    Bytes offsets;
    const auto group = [&](Opcode opcode, const std::function<void()>& put_all) {
      const std::uint64_t at = offset();
      put_all();
      if (offset() == at) return;
      put(offsets, static_cast<std::uint8_t>(Opcode::summary_offset));
      put<std::uint64_t>(offsets, 1 + 8 + 8);
      put(offsets, static_cast<std::uint8_t>(opcode));
      put(offsets, at);
      put(offsets, offset() - at);
    };
    group(Opcode::schema, [&] {
      for (const Bytes& schema : schemas_) emit(Opcode::schema, schema);
    });
    group(Opcode::channel, [&] {
      for (const ChannelState& channel : channels_) emit(Opcode::channel, channel.body);
    });
    group(Opcode::statistics, [&] { put_statistics(); });
    group(Opcode::chunk_index, [&] {
      for (const ChunkEntry& chunk : chunks_) put_chunk_index(chunk);
    });
    group(Opcode::metadata_index, [&] {
      for (const MetadataEntry& entry : metadata_) {
        Bytes body;
        put(body, entry.offset);
        put(body, entry.length);
        put_text(body, entry.name);
        emit(Opcode::metadata_index, body);
      }
    });
    const std::uint64_t offsets_begin = offset();
    put_bytes(pending_, offsets);
    put(pending_, static_cast<std::uint8_t>(Opcode::footer));
    put<std::uint64_t>(pending_, 8 + 8 + 4);
    put(pending_, begin);
    put(pending_, offsets_begin);
    put(pending_, crc32(pending_));  // nothing else is pending
    put_bytes(pending_, kMagic);
  }

  std::string path_;
  WriterOptions options_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::unique_ptr<ZSTD_CCtx, FreeContext> context_;
  int error_ = 0;  ///< errno of the first failure
  bool closed_ = false;
  std::uint64_t handed_ = 0;  ///< bytes
  std::uint32_t crc_ = 0;     ///< of them
  Bytes pending_;             ///< not yet handed out
  Bytes chunk_;               ///< the open one
  Bytes compressed_;
  std::uint64_t begin_ns_ = std::numeric_limits<std::uint64_t>::max();  ///< of the open chunk
  std::uint64_t end_ns_ = 0;
  std::vector<Bytes> schemas_;
  std::vector<ChannelState> channels_;
  std::vector<ChunkEntry> chunks_;
  std::vector<MetadataEntry> metadata_;
};

Writer::Writer(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Writer::~Writer() = default;
Writer::Writer(Writer&&) noexcept = default;
Writer& Writer::operator=(Writer&&) noexcept = default;

Result<Writer> Writer::open(const std::filesystem::path& path, const WriterOptions& options) {
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (file == nullptr) {
    return Error{"cannot write " + path.string() + ": " + std::generic_category().message(errno)};
  }
  return Writer{std::make_unique<Impl>(path.string(), file, options)};
}

std::uint16_t Writer::add(const Schema& schema) { return impl_->add(schema); }
std::uint16_t Writer::add(const Channel& channel) { return impl_->add(channel); }
void Writer::add(const Metadata& metadata) { impl_->add(metadata); }
void Writer::write(const Message& message) { impl_->write(message); }
Result<void> Writer::flush() { return impl_->flush(); }
Result<void> Writer::close() { return impl_->close(); }
std::uint64_t Writer::size() const { return impl_->size(); }

}  // namespace skein::mcap
