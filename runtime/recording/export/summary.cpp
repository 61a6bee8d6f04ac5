// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "skein/recording/log.hpp"
#include "skein/recording_export/recording_export.hpp"

namespace skein::recording_export {
namespace {

std::string utc(std::int64_t unix_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC",
                     fmt::gmtime(static_cast<std::time_t>(unix_ns / kSecond)));
}

}  // namespace

Result<std::string> summary(const std::filesystem::path& path) {
  auto log = recording::Log::open(path);
  if (!log) return log.error();
  std::string text;
  for (const auto& session : log->sessions()) {
    const std::string who = session.node == kGroundStation
                                ? std::string{"ground station"}
                                : fmt::format("node {}", session.node.value);
    text += fmt::format("{}: {} {}, instance {:016x}, mission time 0 is {}\n", who, session.program,
                        session.version, session.instance.value, utc(session.epoch_unix_ns));
  }
  const auto topics = log->topics();
  const double begin_s = to_seconds(log->begin());
  const double end_s = to_seconds(log->end());
  std::uint64_t records = 0;
  for (const auto& topic : topics) records += topic.records;
  text += fmt::format("{} records from {:.3f} to {:.3f} s; {}\n", records, begin_s, end_s,
                      log->is_complete() ? "complete" : "not closed by its process");
  if (log->damaged() > 0) text += fmt::format("{} parts cannot be read\n", log->damaged());
  for (const auto& topic : topics) {
    const double rate =
        end_s > begin_s ? static_cast<double>(topic.records) / (end_s - begin_s) : 0.0;
    text += fmt::format("{:>10} {:>8.2f} Hz  {}\n", topic.records, rate, topic.topic);
  }
  return text;
}

}  // namespace skein::recording_export
