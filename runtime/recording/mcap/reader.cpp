// SPDX-License-Identifier: Apache-2.0
#include "skein/mcap/reader.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "bytes.hpp"
#include "crc32.hpp"

namespace skein::mcap {
namespace {

/// Of records that are neither chunks nor attachments: schemas, channels, metadata, an index.
constexpr std::uint64_t kRecordBytesMax = 32U << 20U;
constexpr std::uint64_t kFooterLength = 8 + 8 + 4;
/// From the footer's opcode to the end of the file.
constexpr std::uint64_t kEndLength = kRecordHead + kFooterLength + kMagic.size();
constexpr std::size_t kLookThrough = 1U << 20U;  ///< bytes at a time

/// Where bytes come from: a file, or memory.
class Source {
 public:
  explicit Source(std::span<const std::uint8_t> bytes) : bytes_{bytes}, size_{bytes.size()} {}
  Source(std::FILE* file, std::uint64_t size) : file_{file}, size_{size} {}

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Fewer than asked for where the source ends.
  [[nodiscard]] Bytes read(std::uint64_t offset, std::uint64_t size) const {
    if (offset >= size_) return {};
    const auto wanted = static_cast<std::size_t>(std::min(size, size_ - offset));
    if (file_ == nullptr) {
      const auto part = bytes_.subspan(static_cast<std::size_t>(offset), wanted);
      return {part.begin(), part.end()};
    }
    Bytes bytes(wanted);
    if (::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) return {};
    bytes.resize(std::fread(bytes.data(), 1, wanted, file_.get()));
    return bytes;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::span<const std::uint8_t> bytes_;
  std::uint64_t size_;
};

/// A chunk's record but for the records in it.
struct ChunkHead {
  std::uint64_t begin_ns = 0;
  std::uint64_t end_ns = 0;
  std::uint64_t uncompressed = 0;
  std::uint32_t crc = 0;
  std::string compression;
  std::uint64_t records = 0;  ///< bytes that follow
};
constexpr std::uint64_t kChunkHeadMax = 8 + 8 + 8 + 4 + 4 + 4 + 8;  ///< with "zstd"

/// What does not shrink grows a little.
constexpr std::uint64_t kPackedChunkMax = kChunkBytesMax + (1U << 20U);

/// None where it cannot be the head of a chunk of `length` bytes, or is of one that is not read.
std::optional<ChunkHead> chunk_head(std::span<const std::uint8_t> bytes, std::uint64_t length) {
  Taker take{bytes};
  ChunkHead head;
  head.begin_ns = take.take<std::uint64_t>();
  head.end_ns = take.take<std::uint64_t>();
  head.uncompressed = take.take<std::uint64_t>();
  head.crc = take.take<std::uint32_t>();
  head.compression = take.take_text();
  head.records = take.take<std::uint64_t>();
  if (!take.ok() || (head.compression != "zstd" && !head.compression.empty())) return std::nullopt;
  if (head.uncompressed > kChunkBytesMax || head.begin_ns > head.end_ns) return std::nullopt;
  const std::uint64_t size = kChunkHeadMax - 4 + head.compression.size();
  if (length < size || head.records != length - size) return std::nullopt;
  return head;
}

std::optional<Bytes> decompress(std::span<const std::uint8_t> bytes, std::uint64_t size) {
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) return std::nullopt;
  Bytes records(static_cast<std::size_t>(size));
  const std::size_t made =
      ZSTD_decompress(records.data(), records.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(made) != 0 || made != records.size()) return std::nullopt;
  return records;
}

/// False where the records do not end with the bytes.
bool for_each_record(std::span<const std::uint8_t> bytes,
                     const std::function<bool(Opcode, std::span<const std::uint8_t>)>& take) {
  Taker rest{bytes};
  while (!rest.rest().empty()) {
    const auto opcode = rest.take<Opcode>();
    const auto body = rest.take_bytes(rest.take<std::uint64_t>());
    if (!rest.ok()) return false;
    if (!take(opcode, body)) return true;
  }
  return true;
}

}  // namespace

class Reader::Impl {
 public:
  Impl(std::string name, Source source) : name_{std::move(name)}, source_{std::move(source)} {}

  Result<void> open() {
    const Bytes magic = source_.read(0, kMagic.size());
    if (!std::equal(magic.begin(), magic.end(), kMagic.begin(), kMagic.end())) {
      return Error{name_ + " is no MCAP file"};
    }
    complete_ = read_summary();
    if (!complete_) look_through();
    return {};
  }

  std::optional<Bytes> load(const ChunkPlace& chunk) {
    std::optional<Bytes> records;
    if (chunk.length <= kPackedChunkMax) {
      const Bytes body = source_.read(chunk.offset + kRecordHead, chunk.length);
      if (body.size() == chunk.length) records = unpack(body);
    }
    if (!records) {
      ++damaged_;
      return std::nullopt;
    }
    // Other writers put these into chunks.
    for_each_record(*records, [this](Opcode opcode, std::span<const std::uint8_t> record) {
      if (opcode == Opcode::schema || opcode == Opcode::channel) take_record(opcode, record);
      return true;
    });
    return records;
  }

 private:
  friend class Reader;

  static std::optional<Bytes> unpack(std::span<const std::uint8_t> body) {
    const auto head = chunk_head(body, body.size());
    if (!head) return std::nullopt;
    const auto packed = body.last(static_cast<std::size_t>(head->records));
    std::optional<Bytes> records;
    if (!head->compression.empty()) {
      records = decompress(packed, head->uncompressed);
    } else if (packed.size() == head->uncompressed) {
      records = Bytes{packed.begin(), packed.end()};
    }
    if (!records || (head->crc != 0 && crc32(*records) != head->crc)) return std::nullopt;
    return records;
  }

  /// Keeps what the record says. False where it is malformed.
  bool take_record(Opcode opcode, std::span<const std::uint8_t> body) {
    Taker take{body};
    switch (opcode) {
      case Opcode::header:
        profile_ = take.take_text();
        library_ = take.take_text();
        break;
      case Opcode::schema: {
        const auto id = take.take<std::uint16_t>();
        Schema schema;
        schema.name = take.take_text();
        schema.encoding = take.take_text();
        schema.text = take.take_text();
        if (take.ok()) schemas_.emplace(id, std::move(schema));
        break;
      }
      case Opcode::channel: {
        const auto id = take.take<std::uint16_t>();
        Channel channel;
        channel.schema = take.take<std::uint16_t>();
        channel.topic = take.take_text();
        channel.encoding = take.take_text();
        channel.metadata = take.take_map();
        if (take.ok()) channels_.emplace(id, std::move(channel));
        break;
      }
      case Opcode::metadata: {
        Metadata metadata;
        metadata.name = take.take_text();
        metadata.entries = take.take_map();
        if (take.ok()) metadata_.push_back(std::move(metadata));
        break;
      }
      case Opcode::chunk_index: {
        ChunkPlace chunk;
        chunk.begin_ns = take.take<std::uint64_t>();
        chunk.end_ns = take.take<std::uint64_t>();
        chunk.offset = take.take<std::uint64_t>();
        const auto with_head = take.take<std::uint64_t>();
        chunk.length = with_head - kRecordHead;
        if (!take.ok() || with_head < kRecordHead || with_head > source_.size() ||
            chunk.offset > source_.size() - with_head || chunk.begin_ns > chunk.end_ns) {
          return false;
        }
        chunks_.push_back(chunk);
        break;
      }
      case Opcode::metadata_index: {
        const auto offset = take.take<std::uint64_t>();
        const auto length = take.take<std::uint64_t>();
        return take.ok() && length >= kRecordHead && length <= kRecordBytesMax &&
               take_metadata_at(offset, length);
      }
      default:
        break;
    }
    return take.ok();
  }

  bool take_metadata_at(std::uint64_t offset, std::uint64_t length) {
    const Bytes record = source_.read(offset, length);
    Taker take{record};
    if (take.take<Opcode>() != Opcode::metadata) return false;
    const auto body = take.take_bytes(take.take<std::uint64_t>());
    return take.ok() && take_record(Opcode::metadata, body);
  }

  /// The index at the end; false, and nothing kept, where there is none that is whole.
  bool read_summary() {
    if (source_.size() < kMagic.size() + kEndLength) return false;
    const std::uint64_t footer_at = source_.size() - kEndLength;
    const Bytes end = source_.read(footer_at, kEndLength);
    Taker take{end};
    const bool is_footer =
        take.take<Opcode>() == Opcode::footer && take.take<std::uint64_t>() == kFooterLength;
    const auto begin = take.take<std::uint64_t>();
    (void)take.take<std::uint64_t>();  // of the groups: all of it is read
    const auto crc = take.take<std::uint32_t>();
    const auto magic = take.rest();
    if (!take.ok() || !is_footer || begin < kMagic.size() || begin > footer_at ||
        footer_at - begin > kRecordBytesMax ||
        !std::equal(magic.begin(), magic.end(), kMagic.begin(), kMagic.end())) {
      return false;
    }
    const Bytes summary = source_.read(begin, footer_at - begin);
    const auto summed = std::span{end}.first(kRecordHead + 8 + 8);
    if (crc != 0 && crc32(summed, crc32(summary)) != crc) return false;
    bool good = take_header();
    good = for_each_record(summary,
                           [&](Opcode opcode, std::span<const std::uint8_t> body) {
                             good = good && take_record(opcode, body);
                             return good;
                           }) &&
           good;
    if (good) {
      std::sort(chunks_.begin(), chunks_.end(),
                [](const ChunkPlace& a, const ChunkPlace& b) { return a.offset < b.offset; });
      return true;
    }
    schemas_.clear();
    channels_.clear();
    metadata_.clear();
    chunks_.clear();
    return false;
  }

  bool take_header() {
    const Bytes head = source_.read(kMagic.size(), kRecordHead);
    Taker take{head};
    if (take.take<Opcode>() != Opcode::header) return false;
    const auto length = take.take<std::uint64_t>();
    if (!take.ok() || length > kRecordBytesMax) return false;
    const Bytes body = source_.read(kMagic.size() + kRecordHead, length);
    return body.size() == length && take_record(Opcode::header, body);
  }

  /// Takes all that is whole, from the beginning.
  void look_through() {
    std::uint64_t at = kMagic.size();
    while (at < source_.size()) {
      if (const auto next = record_at(at)) {
        at = *next;
        if (at == source_.size()) return;
        continue;
      }
      ++damaged_;
      const auto found = next_chunk_after(at);
      if (!found) return;
      at = *found;
    }
  }

  /// Takes the record there; where the next one begins. None where there is no whole record, and
  /// the size of the source at the end of the data.
  std::optional<std::uint64_t> record_at(std::uint64_t at) {
    const Bytes head = source_.read(at, kRecordHead + kChunkHeadMax);
    Taker take{head};
    const auto opcode = take.take<Opcode>();
    const auto length = take.take<std::uint64_t>();
    if (!take.ok() || length > source_.size() - at - kRecordHead) return std::nullopt;
    switch (opcode) {
      case Opcode::data_end:
      case Opcode::footer:
        return source_.size();
      case Opcode::chunk: {
        const auto chunk = chunk_head(take.rest(), length);
        if (!chunk) return std::nullopt;
        chunks_.push_back({at, length, chunk->begin_ns, chunk->end_ns});
        break;
      }
      case Opcode::header:
      case Opcode::schema:
      case Opcode::channel:
      case Opcode::metadata: {
        if (length > kRecordBytesMax) return std::nullopt;
        const Bytes body = source_.read(at + kRecordHead, length);
        if (body.size() != length || !take_record(opcode, body)) return std::nullopt;
        break;
      }
      case Opcode::message_index:
      case Opcode::attachment:
        break;
      default:
        return std::nullopt;
    }
    return at + kRecordHead + length;
  }

  /// Where a chunk begins, after bytes that make no sense: a head that fits, and a good checksum.
  std::optional<std::uint64_t> next_chunk_after(std::uint64_t at) {
    for (std::uint64_t base = at + 1; base < source_.size(); base += kLookThrough) {
      const Bytes window = source_.read(base, kLookThrough + kRecordHead + kChunkHeadMax);
      for (std::size_t i = 0; i < std::min(kLookThrough, window.size()); ++i) {
        if (window[i] != static_cast<std::uint8_t>(Opcode::chunk)) continue;
        Taker take{std::span{window}.subspan(i + 1)};
        const auto length = take.take<std::uint64_t>();
        if (!take.ok() || length > kPackedChunkMax || !chunk_head(take.rest(), length)) continue;
        const Bytes body = source_.read(base + i + kRecordHead, length);
        if (body.size() == length && unpack(body)) return base + i;
      }
    }
    return std::nullopt;
  }

  std::string name_;
  Source source_;
  std::string profile_;
  std::string library_;
  bool complete_ = false;
  std::size_t damaged_ = 0;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Metadata> metadata_;
  std::vector<ChunkPlace> chunks_;
};

Reader::Reader(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

Result<Reader> Reader::open(const std::filesystem::path& path) {
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  if (failure) return Error{"cannot read " + path.string() + ": " + failure.message()};
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (file == nullptr) {
    return Error{"cannot read " + path.string() + ": " + std::generic_category().message(errno)};
  }
  auto impl = std::make_unique<Impl>(path.string(), Source{file, size});
  if (auto opened = impl->open(); !opened) return opened.error();
  return Reader{std::move(impl)};
}

Result<Reader> Reader::of_bytes(std::span<const std::uint8_t> bytes, const std::string& name) {
  auto impl = std::make_unique<Impl>(name, Source{bytes});
  if (auto opened = impl->open(); !opened) return opened.error();
  return Reader{std::move(impl)};
}

const std::string& Reader::name() const { return impl_->name_; }
const std::string& Reader::profile() const { return impl_->profile_; }
const std::string& Reader::library() const { return impl_->library_; }
bool Reader::is_complete() const { return impl_->complete_; }
std::size_t Reader::damaged() const { return impl_->damaged_; }
const std::map<std::uint16_t, Schema>& Reader::schemas() const { return impl_->schemas_; }
const std::map<std::uint16_t, Channel>& Reader::channels() const { return impl_->channels_; }
const std::vector<Metadata>& Reader::metadata() const { return impl_->metadata_; }
const std::vector<ChunkPlace>& Reader::chunks() const { return impl_->chunks_; }

std::optional<std::vector<std::uint8_t>> Reader::load(const ChunkPlace& chunk) {
  return impl_->load(chunk);
}

void Reader::for_each(const std::function<bool(const Message&)>& take) {
  bool goes_on = true;
  for (const ChunkPlace& chunk : impl_->chunks_) {
    const auto records = load(chunk);
    if (!records) continue;
    const bool whole = for_each_message(*records, [&](const Message& message) {
      goes_on = take(message);
      return goes_on;
    });
    if (!whole) ++impl_->damaged_;
    if (!goes_on) return;
  }
}

bool for_each_message(std::span<const std::uint8_t> records,
                      const std::function<bool(const Message&)>& take) {
  bool whole = true;
  const bool ended =
      for_each_record(records, [&](Opcode opcode, std::span<const std::uint8_t> body) {
        if (opcode != Opcode::message) return true;
        Taker fields{body};
        Message message;
        message.channel = fields.take<std::uint16_t>();
        message.sequence = fields.take<std::uint32_t>();
        message.log_time_ns = fields.take<std::uint64_t>();
        message.publish_time_ns = fields.take<std::uint64_t>();
        message.data = fields.rest();
        whole = fields.ok();
        return whole && take(message);
      });
  return whole && ended;
}

}  // namespace skein::mcap
