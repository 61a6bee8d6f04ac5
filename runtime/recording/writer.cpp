// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/writer.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "channel_book.hpp"
#include "records.hpp"
#include "skein/mcap/writer.hpp"

namespace skein::recording {
namespace {

Result<mcap::Writer> open_file(const std::filesystem::path& folder,
                               const Writer::Options& options) {
  mcap::WriterOptions file;
  file.profile = kProfile;
  file.library = "skein " + options.session.version;
  file.compression = options.compress ? mcap::Compression::zstd : mcap::Compression::none;
  auto opened = mcap::Writer::open(folder / kFileName, file);
  if (opened) opened->add(metadata_of(options.session));
  return opened;
}

/// A program that is started again and again leaves a small file each time.
constexpr int kOlderFilesMax = 200;

bool is_plain_file(const std::filesystem::path& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(path, failure));
}

Result<void> move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code failure;
  std::filesystem::rename(from, to, failure);
  if (!failure) return {};
  return Error{"cannot rename " + from.string() + ": " + failure.message()};
}

/// The file that is there becomes the first of the older ones. Of those as many are kept as have
/// room in `bytes`, and that one in any case. What is no plain file is left alone.
Result<void> set_aside(const std::filesystem::path& folder, std::uint64_t bytes) {
  if (!is_plain_file(folder / kFileName)) return {};
  int older = 0;
  while (older < kOlderFilesMax && is_plain_file(folder / older_file_name(older + 1))) ++older;
  std::error_code none;
  std::uint64_t sum = std::filesystem::file_size(folder / kFileName, none);
  int kept = 0;
  while (kept < std::min(older, kOlderFilesMax - 1)) {
    sum += std::filesystem::file_size(folder / older_file_name(kept + 1), none);
    if (sum > bytes) break;
    ++kept;
  }
  for (int age = older; age > kept; --age) {
    std::filesystem::remove(folder / older_file_name(age), none);
  }
  for (int age = kept; age > 0; --age) {
    auto done = move_file(folder / older_file_name(age), folder / older_file_name(age + 1));
    if (!done) return done;
  }
  return move_file(folder / kFileName, folder / older_file_name(1));
}

}  // namespace

class Writer::Impl {
 public:
  Impl(std::filesystem::path folder, Options options, mcap::Writer file)
      : folder_{std::move(folder)}, options_{std::move(options)}, file_{std::move(file)} {}

  /// What has a value out of its range is not written.
  void write(const Content& content, VehicleId sender, Instant now) {
    const auto record = encode(content);
    if (!file_ || !record) return;
    newest_ = std::max(newest_.value_or(now), now);
    mcap::Message message;
    message.channel = channels_.channel(*file_, sender, *record->kind);
    message.log_time_ns = log_time(now, options_.session.epoch_unix_ns);
    message.publish_time_ns = message.log_time_ns;
    message.data = record->bytes;
    file_->write(message);
    if (file_->size() >= options_.bytes_max / 2) rotate();
  }

  Result<void> flush() {
    if (file_) {
      if (auto flushed = file_->flush(); !flushed) return flushed;
    }
    if (failure_) return *failure_;
    return {};
  }

  [[nodiscard]] VehicleId node() const { return options_.session.node; }
  /// Of all records so far: the moment of one that has none of its own.
  [[nodiscard]] Instant newest() const { return newest_.value_or(Instant{}); }

 private:
  void rotate() {
    auto done = file_->close();
    file_.reset();
    channels_ = {};
    if (done) done = set_aside(folder_, options_.bytes_max / 2);
    if (done) {
      auto opened = open_file(folder_, options_);
      if (opened) {
        file_.emplace(std::move(opened).value());
        return;
      }
      done = opened.error();
    }
    failure_ = done.error();
  }

  std::filesystem::path folder_;
  Options options_;
  std::optional<mcap::Writer> file_;  ///< none after a failure to begin the next
  std::optional<Error> failure_;
  ChannelBook channels_;
  std::optional<Instant> newest_;
};

Writer::Writer(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Writer::~Writer() = default;
Writer::Writer(Writer&&) noexcept = default;
Writer& Writer::operator=(Writer&&) noexcept = default;

Result<Writer> Writer::open(const std::filesystem::path& folder) { return open(folder, {}); }

Result<Writer> Writer::open(const std::filesystem::path& folder, const Options& options) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) return Error{"cannot make folder " + folder.string() + ": " + failure.message()};
  if (const auto free = set_aside(folder, options.bytes_max / 2); !free) return free.error();
  auto file = open_file(folder, options);
  if (!file) return file.error();
  // Whose file it is can be read even if the process is killed at once.
  if (const auto flushed = file->flush(); !flushed) return flushed.error();
  return Writer{std::make_unique<Impl>(folder, options, std::move(file).value())};
}

void Writer::write(const TrackPoint& point) {
  impl_->write(point, impl_->node(), point.state.time);
}
void Writer::write(const mission::MissionEvent& event) {
  impl_->write(event, impl_->node(), event.time);
}
void Writer::write(const PlanRecord& plan) { impl_->write(plan, impl_->node(), plan.since); }
void Writer::write(const PlaceRecord& place) {
  impl_->write(place, impl_->node(), impl_->newest());
}
void Writer::write(const Gap& gap) { impl_->write(gap, impl_->node(), impl_->newest()); }

void Writer::write(const mission::Message& message, VehicleId sender, Instant now) {
  impl_->write(message, sender, now);
}

void Writer::write(const AgentRecord& record) {
  if (const auto* message = std::get_if<MessageRecord>(&record)) {
    return write(message->message, message->sender, message->now);
  }
  std::visit(
      [this]<class Record>(const Record& r) {
        if constexpr (!std::is_same_v<Record, MessageRecord>) {
          impl_->write(r, impl_->node(), r.now);
        }
      },
      record);
}

Result<void> Writer::flush() { return impl_->flush(); }

}  // namespace skein::recording
