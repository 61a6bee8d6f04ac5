// SPDX-License-Identifier: Apache-2.0
#include "skein/process/journal.hpp"

#include <fmt/format.h>
#include <nettle/sha1.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <array>
#include <cstdint>

#include "journal_sink.hpp"
#include "skein/mission/events.hpp"
#include "skein/wording/wording.hpp"

namespace skein::process {
namespace {

using Uuid = std::array<std::uint8_t, 16>;

/// Skein's own; drawn once.
constexpr Uuid kNamespace{0x6b, 0x0f, 0x0c, 0x5e, 0x9d, 0x1d, 0x4b, 0x6a,
                          0x8f, 0x3a, 0x2d, 0x71, 0x54, 0xc2, 0x8e, 0x97};

const mission::MissionEvent*& event_of_thread() {
  thread_local const mission::MissionEvent* event = nullptr;
  return event;
}

}  // namespace

std::string message_id(mission::EventKind kind) {
  const std::string_view name = to_string(kind);
  sha1_ctx hash{};
  sha1_init(&hash);
  sha1_update(&hash, kNamespace.size(), kNamespace.data());
  sha1_update(&hash, name.size(), reinterpret_cast<const std::uint8_t*>(name.data()));
  Uuid id{};
  sha1_digest(&hash, id.size(), id.data());
  id[6] = static_cast<std::uint8_t>((id[6] & 0x0FU) | 0x50U);  // version 5
  id[8] = static_cast<std::uint8_t>((id[8] & 0x3FU) | 0x80U);  // variant of RFC 4122
  std::string text;
  for (const std::uint8_t byte : id) text.append(fmt::format("{:02x}", byte));
  return text;
}

std::vector<std::string> journal_fields(std::string_view text, int priority, Instant now,
                                        const mission::MissionEvent* event) {
  std::vector<std::string> fields{fmt::format("MESSAGE={}", text),
                                  fmt::format("PRIORITY={}", priority),
                                  fmt::format("SKEIN_MISSION_TIME={:.3f}", to_seconds(now))};
  if (event == nullptr) return fields;
  fields.push_back("MESSAGE_ID=" + message_id(event->kind()));
  fields.push_back(fmt::format("SKEIN_EVENT={}", to_string(event->kind())));
  fields.push_back(fmt::format("SKEIN_EVENT_TIME={:.3f}", to_seconds(event->time)));
  fields.push_back(fmt::format("SKEIN_VEHICLE={}", event->vehicle.value));
  if (event->task.site.value != 0) {
    fields.push_back(fmt::format("SKEIN_SITE={}", event->task.site.value));
  }
  return fields;
}

std::string journal_catalog() {
  std::string text =
      "# SPDX-License-Identifier: Apache-2.0\n"
      "# Printed from runtime/process/journal.cpp by process_test; do not edit.\n";
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::EventKind::count); ++i) {
    const auto kind = static_cast<mission::EventKind>(i);
    text.append(fmt::format(
        "\n-- {}\nSubject: Skein: {}\nDefined-By: Skein\n\n"
        "An event of vehicle @SKEIN_VEHICLE@ (0 is the ground station) at mission time\n"
        "@SKEIN_EVENT_TIME@ s, which the message tells.{}\n",
        message_id(kind), to_string(kind),
        mission::is_warning(kind) ? " A person must look at it." : ""));
  }
  return text;
}

bool is_journal(int descriptor, std::string_view journal_stream) {
  struct stat file {};
  if (journal_stream.empty() || ::fstat(descriptor, &file) != 0) return false;
  return journal_stream == fmt::format("{}:{}", file.st_dev, file.st_ino);
}

const mission::MissionEvent* logged_event() { return event_of_thread(); }

void log_event(const mission::MissionEvent& event) {
  const bool warning = mission::is_warning(event.kind());
  event_of_thread() = &event;
  spdlog::log(warning ? spdlog::level::warn : spdlog::level::info, wording::text_of(event));
  event_of_thread() = nullptr;
}

}  // namespace skein::process
