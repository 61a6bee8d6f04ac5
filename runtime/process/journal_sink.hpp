// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/sinks/sink.h>

#include <memory>

#include "skein/mission/messages.hpp"
#include "skein/process/mission_clock.hpp"

namespace skein::process {

/// To systemd's journal, with fields. `clock` must outlive it.
[[nodiscard]] std::shared_ptr<spdlog::sinks::sink> journal_sink(const MissionClock& clock);

/// The event that this thread is logging; null otherwise.
[[nodiscard]] const mission::MissionEvent* logged_event();

}  // namespace skein::process
