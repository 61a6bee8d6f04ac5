// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace skein::console {

/// The subprotocols of clients that speak as Foxglove does; both are spoken alike here.
inline constexpr std::array<std::string_view, 2> kFoxgloveProtocols{"foxglove.sdk.v1",
                                                                    "foxglove.websocket.v1"};

/// A topic that such clients can subscribe to.
struct LiveChannel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;
  std::string schema;  ///< ros2msg
};

/// One client of the Foxglove WebSocket protocol, version 1 (github.com/foxglove/ws-protocol,
/// docs/spec.md): it is told of the channels, and gets the records of those that it subscribes to.
/// It can neither publish nor call. Without I/O.
class FoxgloveSession {
 public:
  static constexpr std::size_t kSubscriptionsMax = 4096;

  [[nodiscard]] static std::string server_info(const std::string& name, const std::string& run);
  [[nodiscard]] static std::string advertise(std::span<const LiveChannel> channels);

  /// False for what is not of the protocol. What it asks for that is not offered is left
  /// unanswered.
  [[nodiscard]] bool on_text(const std::string& text);
  /// The binary message that takes a record to it; none where it has not subscribed.
  [[nodiscard]] std::optional<std::string> record(std::uint32_t channel, std::uint64_t time_ns,
                                                  std::span<const std::uint8_t> bytes) const;

 private:
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  ///< by channel
};

}  // namespace skein::console
