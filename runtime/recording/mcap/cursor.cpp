// SPDX-License-Identifier: Apache-2.0
#include "skein/mcap/cursor.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace skein::mcap {

bool Cursor::Later::operator()(const Pending& a, const Pending& b) const {
  return std::tie(a.time_ns, a.file, a.chunk, a.order) >
         std::tie(b.time_ns, b.file, b.chunk, b.order);
}

Cursor::Cursor(std::vector<Reader*> files, std::function<bool(std::size_t, std::uint16_t)> wanted)
    : files_{std::move(files)}, wanted_{std::move(wanted)} {
  for (std::size_t file = 0; file < files_.size(); ++file) {
    for (const ChunkPlace& place : files_[file]->chunks()) chunks_.push_back({file, place});
  }
  std::stable_sort(chunks_.begin(), chunks_.end(), [](const Chunk& a, const Chunk& b) {
    return a.place.begin_ns < b.place.begin_ns;
  });
}

void Cursor::seek(std::uint64_t log_time_ns) {
  from_ns_ = log_time_ns;
  next_chunk_ = 0;
  pending_.clear();
}

std::optional<Cursor::Item> Cursor::next() {
  // Chunks overlap: whatever may begin before the first message at hand must be at hand too.
  while (next_chunk_ < chunks_.size() &&
         (pending_.empty() || chunks_[next_chunk_].place.begin_ns <= pending_.front().time_ns)) {
    const Chunk& chunk = chunks_[next_chunk_++];
    if (chunk.place.end_ns >= from_ns_) load(chunk);
  }
  if (pending_.empty()) return std::nullopt;
  std::pop_heap(pending_.begin(), pending_.end(), Later{});
  current_ = std::move(pending_.back());
  pending_.pop_back();
  return Item{current_.file, current_.message};
}

void Cursor::load(const Chunk& chunk) {
  auto records = files_[chunk.file]->load(chunk.place);
  if (!records) return;
  const auto kept = std::make_shared<const std::vector<std::uint8_t>>(std::move(*records));
  std::size_t order = 0;
  for_each_message(*kept, [&](const Message& message) {
    ++order;
    if (message.log_time_ns < from_ns_) return true;
    if (wanted_ && !wanted_(chunk.file, message.channel)) return true;
    pending_.push_back({message.log_time_ns, chunk.file, chunk.place.offset, order, message, kept});
    std::push_heap(pending_.begin(), pending_.end(), Later{});
    return true;
  });
}

}  // namespace skein::mcap
