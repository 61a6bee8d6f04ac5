// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/recall.hpp"

#include <variant>

#include "skein/recording/log.hpp"

namespace skein::groundstation {

std::size_t recall(const std::filesystem::path& folder, std::int64_t epoch_unix_ns,
                   mission::GroundNode& node, const Recalled& also) {
  auto log = recording::Log::of_mission(folder, kGroundStation, epoch_unix_ns);
  if (!log) return 0;
  std::size_t messages = 0;
  while (const auto entry = log->next()) {
    const auto* message = std::get_if<mission::Message>(&entry->content);
    if (message == nullptr) continue;
    node.recall(*message, entry->sender, entry->time);
    if (also) also(*message, entry->sender, entry->time);
    ++messages;
  }
  return messages;
}

}  // namespace skein::groundstation
