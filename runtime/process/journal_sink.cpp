// SPDX-License-Identifier: Apache-2.0
#include "journal_sink.hpp"

#include <spdlog/sinks/base_sink.h>
#include <sys/uio.h>
#include <syslog.h>

#define SD_JOURNAL_SUPPRESS_LOCATION
#include <systemd/sd-journal.h>

#include <mutex>
#include <vector>

#include "skein/process/journal.hpp"

namespace skein::process {
namespace {

int priority_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::critical:
      return LOG_CRIT;
    case spdlog::level::err:
      return LOG_ERR;
    case spdlog::level::warn:
      return LOG_WARNING;
    case spdlog::level::info:
      return LOG_INFO;
    default:
      return LOG_DEBUG;
  }
}

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit JournalSink(const MissionClock& clock) : clock_{&clock} {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    auto fields = journal_fields({message.payload.data(), message.payload.size()},
                                 priority_of(message.level), clock_->now(), logged_event());
    std::vector<iovec> parts;
    parts.reserve(fields.size());
    for (std::string& field : fields) parts.push_back({field.data(), field.size()});
    (void)sd_journal_sendv(parts.data(), static_cast<int>(parts.size()));
  }
  void flush_() override {}

  const MissionClock* clock_;
};

}  // namespace

std::shared_ptr<spdlog::sinks::sink> journal_sink(const MissionClock& clock) {
  return std::make_shared<JournalSink>(clock);
}

}  // namespace skein::process
