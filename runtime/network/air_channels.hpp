// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "skein/air/link.hpp"
#include "skein/codec/topics.hpp"

namespace skein::network {

/// One for each topic, in their order.
[[nodiscard]] inline std::vector<air::Channel> air_channels() {
  std::vector<air::Channel> channels;
  for (const codec::TopicInfo& topic : codec::kTopics) {
    channels.push_back(
        {topic.reliable, topic.urgency, static_cast<std::size_t>(topic.writer_history)});
  }
  return channels;
}

}  // namespace skein::network
