// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/log.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "channel_book.hpp"
#include "node_files.hpp"
#include "records.hpp"
#include "skein/mcap/cursor.hpp"
#include "skein/mcap/reader.hpp"

namespace skein::recording {

class Log::Impl {
 public:
  Impl(std::vector<NodeFile> files, bool own_only) : files_{std::move(files)}, own_only_{own_only} {
    std::set<std::pair<VehicleId, InstanceId>> known;
    for (const NodeFile& file : files_) {
      for (const Session& session : file.sessions) {
        if (known.emplace(session.node, session.instance).second) sessions_.push_back(session);
      }
    }
    if (sessions_.empty()) sessions_.emplace_back();
    restart(0);
  }

  [[nodiscard]] std::int64_t epoch() const { return sessions_.front().epoch_unix_ns; }

  void restart(std::uint64_t log_time_ns) {
    std::vector<mcap::Reader*> readers;
    for (NodeFile& file : files_) readers.push_back(&file.reader);
    cursor_.emplace(std::move(readers), [this](std::size_t file, std::uint16_t channel) {
      return channel_of(file, channel) != nullptr;
    });
    cursor_->seek(log_time_ns);
  }

  std::optional<Entry> next() {
    while (const auto item = cursor_->next()) {
      if (auto entry = entry_of(item->file, item->message)) return entry;
    }
    return std::nullopt;
  }

  void for_each_written(const std::function<bool(Entry)>& take) {
    bool goes_on = true;
    for (std::size_t file = 0; file < files_.size() && goes_on; ++file) {
      files_[file].reader.for_each([&](const mcap::Message& message) {
        if (auto entry = entry_of(file, message)) goes_on = take(std::move(*entry));
        return goes_on;
      });
    }
  }

  std::vector<TopicCount> topics() {
    std::map<std::string, TopicCount> by_topic;
    for (std::size_t file = 0; file < files_.size(); ++file) {
      files_[file].reader.for_each([&](const mcap::Message& message) {
        const KnownChannel* channel = channel_of(file, message.channel);
        if (channel == nullptr || is_copy(*channel, message.data)) return true;
        TopicCount& count = by_topic[topic(file, message.channel)];
        count.sender = channel->sender;
        ++count.records;
        return true;
      });
    }
    std::vector<TopicCount> all;
    for (auto& [name, count] : by_topic) {
      count.topic = name;
      all.push_back(count);
    }
    return all;
  }

  [[nodiscard]] std::size_t damaged() const {
    std::size_t sum = bad_records_;
    for (const NodeFile& file : files_) sum += file.reader.damaged();
    return sum;
  }

 private:
  friend class Log;

  [[nodiscard]] const KnownChannel* channel_of(std::size_t file, std::uint16_t number) const {
    const auto& channels = files_[file].channels;
    const auto known = channels.find(number);
    if (known == channels.end()) return nullptr;
    const bool wanted = !own_only_ || known->second.sender == files_[file].sessions.front().node;
    return wanted ? &known->second : nullptr;
  }
  /// An event of somebody else, who recorded it too.
  [[nodiscard]] bool is_copy(const KnownChannel& channel,
                             std::span<const std::uint8_t> data) const {
    if (!own_only_) return false;
    const auto whose = vehicle_of_event(*channel.kind, data);
    return whose && *whose != channel.sender;
  }
  [[nodiscard]] const std::string& topic(std::size_t file, std::uint16_t number) const {
    return files_[file].reader.channels().at(number).topic;
  }

  std::optional<Entry> entry_of(std::size_t file, const mcap::Message& message) {
    const KnownChannel* channel = channel_of(file, message.channel);
    if (channel == nullptr || is_copy(*channel, message.data)) return std::nullopt;
    const Instant time = instant_of(message.log_time_ns, epoch());
    auto content = decode(*channel->kind, message.data, time);
    if (!content) {
      ++bad_records_;
      return std::nullopt;
    }
    const auto& sessions = files_[file].sessions;
    // Of a merged file: each record is its sender's.
    const VehicleId node = sessions.size() == 1 ? sessions.front().node : channel->sender;
    return Entry{time, channel->sender, node, topic(file, message.channel), std::move(*content)};
  }

  std::vector<NodeFile> files_;
  std::vector<Session> sessions_;
  bool own_only_;
  std::optional<mcap::Cursor> cursor_;
  std::size_t bad_records_ = 0;
};

Log::Log(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Log::~Log() = default;
Log::Log(Log&&) noexcept = default;
Log& Log::operator=(Log&&) noexcept = default;

Result<Log> Log::open(const std::filesystem::path& path) {
  std::error_code none;
  std::vector<std::filesystem::path> paths;
  bool own_only = false;
  if (!std::filesystem::is_directory(path, none) ||
      std::filesystem::exists(path / kFileName, none)) {
    paths = {path};
  } else if (std::filesystem::exists(path / kRunFileName, none)) {
    paths = {path / kRunFileName};
  } else {
    auto folders = node_folders(path);
    if (!folders) return folders.error();
    paths = std::move(*folders);
    own_only = true;
  }
  if (paths.empty()) return Error{path.string() + " has no recordings"};
  std::vector<NodeFile> files;
  for (const auto& one : paths) {
    if (std::filesystem::is_directory(one, none)) {
      auto opened = open_node(one);
      if (!opened) return opened.error();
      for (NodeFile& file : *opened) files.push_back(std::move(file));
    } else {
      auto opened = open_file(one);
      if (!opened) return opened.error();
      files.push_back(std::move(*opened));
    }
  }
  return Log{std::make_unique<Impl>(std::move(files), own_only)};
}

Result<Log> Log::of_mission(const std::filesystem::path& folder, VehicleId node,
                            std::int64_t epoch_unix_ns) {
  auto files = open_mission(folder, node, epoch_unix_ns);
  if (files.empty()) return Error{folder.string() + " has no recordings of this mission"};
  return Log{std::make_unique<Impl>(std::move(files), false)};
}

Result<Log> Log::of_bytes(std::span<const std::uint8_t> bytes, const std::string& name) {
  auto reader = mcap::Reader::of_bytes(bytes, name);
  if (!reader) return reader.error();
  auto file = known_file(std::move(*reader));
  if (!file) return file.error();
  std::vector<NodeFile> files;
  files.push_back(std::move(*file));
  return Log{std::make_unique<Impl>(std::move(files), false)};
}

const std::vector<Session>& Log::sessions() const { return impl_->sessions_; }

Instant Log::begin() const {
  std::optional<std::uint64_t> first;
  for (const NodeFile& file : impl_->files_) {
    for (const auto& chunk : file.reader.chunks()) {
      first = std::min(first.value_or(chunk.begin_ns), chunk.begin_ns);
    }
  }
  return first ? instant_of(*first, impl_->epoch()) : Instant{};
}

Instant Log::end() const {
  std::optional<std::uint64_t> last;
  for (const NodeFile& file : impl_->files_) {
    for (const auto& chunk : file.reader.chunks()) {
      last = std::max(last.value_or(chunk.end_ns), chunk.end_ns);
    }
  }
  return last ? instant_of(*last, impl_->epoch()) : Instant{};
}

std::size_t Log::damaged() const { return impl_->damaged(); }

bool Log::is_complete() const {
  return std::all_of(impl_->files_.begin(), impl_->files_.end(),
                     [](const NodeFile& file) { return file.reader.is_complete(); });
}

std::vector<TopicCount> Log::topics() { return impl_->topics(); }
void Log::seek(Instant time) { impl_->restart(log_time(time, impl_->epoch())); }
std::optional<Entry> Log::next() { return impl_->next(); }
void Log::for_each_written(const std::function<bool(Entry)>& take) {
  impl_->for_each_written(take);
}

}  // namespace skein::recording
