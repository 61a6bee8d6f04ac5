// SPDX-License-Identifier: Apache-2.0
#include "skein/process/event_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skein::process {
namespace {

/// Does the event concern one task, rather than a site or nothing?
bool names_task(mission::EventKind kind) {
  using enum mission::EventKind;
  return kind == task_started || kind == task_done || kind == task_failed ||
         kind == lease_granted || kind == lease_ended;
}

}  // namespace

std::string text_of(VehicleId vehicle) {
  return vehicle == kGroundStation ? "ground station" : fmt::format("vehicle {}", vehicle.value);
}

std::string text_of(const mission::MissionEvent& event) {
  std::string kind{to_string(event.kind)};
  std::replace(kind.begin(), kind.end(), '_', ' ');
  std::string line = fmt::format("{}: {}", text_of(event.vehicle), kind);
  if (names_task(event.kind)) {
    line += ", " + to_string(event.task);
  } else if (event.task.site != SiteId{}) {
    line += fmt::format(", site {}", event.task.site.value);
  }
  if (event.value != 0.0) line += fmt::format(" ({:.4g})", event.value);
  if (!event.text.empty()) line += ": " + event.text;
  return line;
}

}  // namespace skein::process
