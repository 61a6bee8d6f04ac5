// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/radio/link_table.hpp"
#include "skein/hil/radio/radio_model.hpp"

/// The bench's radio on other machines, which do not share its memory: a datagram to each of their
/// nodes, many times a second, says whom the node hears at this moment, and how.
namespace skein::hil::radio {

/// How one node hears all others.
struct Hearing {
  VehicleId self;
  Link hop;                                            ///< every one; its `up` says nothing
  std::array<std::uint8_t, LinkTable::kNodes> hops{};  ///< from whom over how many, by id; 0: not
};

[[nodiscard]] std::vector<std::uint8_t> encode(const Hearing& hearing);
/// Nothing where these bytes are no such datagram.
[[nodiscard]] std::optional<Hearing> decode(std::span<const std::uint8_t> bytes);

/// UDP port where the node listens for them.
[[nodiscard]] constexpr std::uint16_t feed_port(VehicleId node) {
  constexpr std::uint16_t kFirst = 11000;
  return static_cast<std::uint16_t>(kFirst + node.value);
}

class FeedSender {
 public:
  [[nodiscard]] static Result<FeedSender> open();
  ~FeedSender();
  FeedSender(FeedSender&& other) noexcept;
  FeedSender& operator=(FeedSender&&) = delete;
  FeedSender(const FeedSender&) = delete;
  FeedSender& operator=(const FeedSender&) = delete;

  /// To the node's machine, an IPv4 address. Does not wait; what the network does not take is lost,
  /// and the next one says the same.
  void send(const Hearing& hearing, const std::string& address) const;

 private:
  explicit FeedSender(int socket) : socket_{socket} {}
  int socket_;
};

/// Keeps a table of its own as it is told, on a thread. Before it is told anything, and after three
/// seconds of silence, all hear all: it is not the radio's end that parts a team.
class FeedReceiver {
 public:
  /// Fails where the port is taken.
  [[nodiscard]] static Result<std::shared_ptr<FeedReceiver>> open(VehicleId self);
  ~FeedReceiver();
  FeedReceiver(const FeedReceiver&) = delete;
  FeedReceiver& operator=(const FeedReceiver&) = delete;

  [[nodiscard]] const LinkTable& table() const { return table_; }

 private:
  FeedReceiver(VehicleId self, int socket, LinkTable table);
  void listen();

  VehicleId self_;
  int socket_;
  LinkTable table_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace skein::hil::radio
