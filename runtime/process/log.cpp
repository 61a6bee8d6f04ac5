// SPDX-License-Identifier: Apache-2.0
#include "skein/process/log.hpp"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <utility>

#include "journal_sink.hpp"
#include "skein/base/assert.hpp"
#include "skein/process/journal.hpp"

namespace skein::process {
namespace {

class MissionTimeFlag final : public spdlog::custom_flag_formatter {
 public:
  explicit MissionTimeFlag(const MissionClock& clock) : clock_{&clock} {}
  void format(const spdlog::details::log_msg& /*message*/, const std::tm& /*time*/,
              spdlog::memory_buf_t& out) override {
    fmt::format_to(std::back_inserter(out), "{:9.3f}", to_seconds(clock_->now()));
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<MissionTimeFlag>(*clock_);
  }

 private:
  const MissionClock* clock_;
};

void log_and_exit(const char* condition, const char* file, int line) {
  spdlog::critical("broken invariant: {} ({}:{}); ending at once", condition, file, line);
  spdlog::default_logger()->flush();
  std::_Exit(kExitBrokenInvariant);
}

}  // namespace

void start_log(const MissionClock& clock) {
  // Of the environment that the process was started in. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* stream = std::getenv("JOURNAL_STREAM");
  const bool journal = stream != nullptr && is_journal(STDOUT_FILENO, stream);
  std::shared_ptr<spdlog::sinks::sink> sink;
  if (journal) {
    sink = journal_sink(clock);
  } else {
    sink = std::make_shared<spdlog::sinks::stdout_sink_mt>();
  }
  auto logger = std::make_shared<spdlog::logger>("skein", std::move(sink));
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<MissionTimeFlag>('*', clock).set_pattern("%* %-8l %v");
  logger->set_formatter(std::move(formatter));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
  set_assert_handler(&log_and_exit);
}

std::string text_of(Instant t) { return fmt::format("{:.3f} s", to_seconds(t)); }

}  // namespace skein::process
