// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/recall.hpp"

#include <algorithm>
#include <variant>

#include "skein/recording/log.hpp"

namespace skein::groundstation {

std::size_t recall(const std::filesystem::path& folder, std::int64_t epoch_unix_ns,
                   mission::GroundNode& node) {
  auto log = recording::Log::open(folder);
  if (!log) return 0;
  const bool of_this_mission = std::ranges::all_of(log->sessions(), [&](const auto& session) {
    return session.node == kGroundStation && session.epoch_unix_ns == epoch_unix_ns;
  });
  if (!of_this_mission) return 0;
  std::size_t messages = 0;
  while (const auto entry = log->next()) {
    const auto* message = std::get_if<mission::Message>(&entry->content);
    if (message == nullptr) continue;
    node.recall(*message, entry->sender, entry->time);
    ++messages;
  }
  return messages;
}

}  // namespace skein::groundstation
