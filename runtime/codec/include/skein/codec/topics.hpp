// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/idl/topics.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

[[nodiscard]] constexpr const TopicInfo& info(Topic topic) {
  return kTopics.at(static_cast<std::size_t>(topic));
}

static_assert(kTopicCount == std::variant_size_v<mission::Message::variant>);

/// The topic that carries the message.
[[nodiscard]] inline Topic topic_of(const mission::Message& message) {
  return static_cast<Topic>(message.index());
}

}  // namespace skein::codec
