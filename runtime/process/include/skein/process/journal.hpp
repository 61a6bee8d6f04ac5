// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

/// How events stand in systemd's journal: each kind under a message id of its own, with fields, so
/// that whoever searches needs no sentence.
namespace skein::process {

/// 32 hexadecimal digits, the same in every release: made of the kind's name (RFC 4122, version 5).
[[nodiscard]] std::string message_id(mission::EventKind kind);

/// The fields of one line, "NAME=value", without the event's where there is none. The priorities
/// are syslog's.
[[nodiscard]] std::vector<std::string> journal_fields(std::string_view text, int priority,
                                                      Instant now,
                                                      const mission::MissionEvent* event);

/// What journalctl --catalog explains the ids by; packaging/systemd/skein.catalog is printed from
/// it.
[[nodiscard]] std::string journal_catalog();

/// Is that file descriptor the stream to the journal that `journal_stream` ($JOURNAL_STREAM, as the
/// service manager sets it) names?
[[nodiscard]] bool is_journal(int descriptor, std::string_view journal_stream);

/// An event into the log: its sentence, as a warning where a person must look; in the journal with
/// its fields.
void log_event(const mission::MissionEvent& event);

}  // namespace skein::process
