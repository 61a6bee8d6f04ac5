// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/codec/topics.hpp"
#include "skein/mission/messages.hpp"
#include "skein/network/key_news.hpp"
#include "skein/network/sign_config.hpp"
#include "skein/seal/keys.hpp"

namespace skein::network {

/// Where a node listens. It uses two UDP ports: `port` for discovery, `port + 1` for messages.
struct Endpoint {
  std::string address;  ///< IPv4, dotted
  std::uint16_t port = 0;
};

/// Another node of the fleet.
struct PeerConfig {
  VehicleId id;
  Endpoint endpoint;
};

/// With what a node seals all that it sends, and opens what it receives (skein/seal).
struct SealConfig {
  seal::SenderStart start;
  seal::EpochKey key;
};

/// A network on which everything is said once, for all who hear it. There is no list of members.
struct AirConfig {
  Endpoint group;  ///< where all listen: a multicast address, or that of a broadcast
  /// Of the air, headers included, that this node may take; none: no limit.
  std::optional<double> bytes_per_s;
  /// How many nodes may say a message until it arrives, its author included; 1: nobody passes on
  /// what others say.
  std::uint8_t hops_max = 1;
};

struct NodeConfig {
  std::uint32_t domain = 0;  ///< nodes of other domains are not heard; 0 to 232
  VehicleId self;
  InstanceId instance;  ///< random at each start
  codec::Role role = codec::Role::vehicle;
  Endpoint endpoint;
  /// All whom this node may meet, without itself. Discovery is by unicast to these only; a node
  /// that is not listed here still finds this one if it lists it.
  std::vector<PeerConfig> peers;
  std::size_t queue_limit = 1024;  ///< received messages waiting for poll()
  /// None: in clear, to be read and written by everybody who hears it.
  std::optional<SealConfig> seal;
  /// None: decisions are neither signed nor judged.
  std::optional<SignConfig> sign;
  /// None: Fast DDS, from everybody to everybody.
  std::optional<AirConfig> air;
  /// Whether what knows Fast DDS runs in a process of its own (carrier_process.hpp), so that its
  /// faults are not this one's.
  bool isolated = false;
  /// It hears what is for vehicles alone, too: a ground station that watches another. By the air.
  bool overhears = false;
  /// A library that stands between this node and its sockets (transport_plugin.hpp). Empty: none.
  std::string transport_plugin;
  /// Whether this node does anything by that message: what it does not heed is not judged either,
  /// which costs more than all else that is heard. Called on a thread of the network. Empty: all.
  std::function<bool(const mission::Message&)> heeds;
  /// Called on a thread of the network after messages became ready for poll(). Must be short, must
  /// not call the node. Empty: none.
  std::function<void()> on_received;
};

struct Received {
  mission::Message message;
  VehicleId sender;
  InstanceId instance;  ///< of the sender's program
};

/// A node that is matched on every topic that the two roles share.
struct Peer {
  VehicleId id;
  InstanceId instance;  ///< two entries with one id: two processes claim it
  codec::Role role = codec::Role::vehicle;
  friend bool operator==(const Peer&, const Peer&) = default;
};

/// How one other node was heard in the last Node::kReceptionFor, itself and not through others: on
/// a shared radio its datagrams, over Fast DDS its messages of those that are not sent again.
struct Reception {
  VehicleId sender;
  std::uint16_t datagrams = 0;      ///< that came
  std::uint8_t lost_percent = 255;  ///< of all that it sent, those that did not; above 100: unknown
  std::uint32_t bytes = 0;          ///< of those that came
  friend bool operator==(const Reception&, const Reception&) = default;
};

/// A node of another release, one of whose types we cannot read.
struct Misfit {
  VehicleId sender;
  std::string text;  ///< "its skein::wire::Health is of version 9, ours of version 8"
};

/// This process on the mission network. All functions may be called from any thread, but poll()
/// from one at a time. Nothing here waits for another node: not even a silent or a hostile one can
/// stop the caller.
class Node {
 public:
  /// Fails where an address or a port cannot be used, a node is listed twice, or the plugin cannot
  /// be loaded.
  [[nodiscard]] static Result<std::unique_ptr<Node>> open(const NodeConfig& config);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Hands the message to the network's own thread. False, and counted, where this role does not
  /// write the topic, a value is out of the limits of skein/codec/codec.hpp, or the network has no
  /// room.
  bool publish(const mission::Message& message);

  /// The next received message, decoded and checked; none when there is none. Own messages are not
  /// received.
  [[nodiscard]] std::optional<Received> poll();

  [[nodiscard]] std::vector<Peer> peers() const;

  static constexpr Duration kReceptionFor = std::chrono::seconds{10};
  /// Of who has sent something lately, ascending by sender.
  [[nodiscard]] std::vector<Reception> receptions() const;

  /// Seals with this key from now on, and goes on to open the present one's for so long.
  /// Precondition: the node seals.
  void change_key(const seal::EpochKey& key, Duration old_for);

  /// Of the key that it seals with; none in clear.
  [[nodiscard]] std::optional<std::uint8_t> epoch() const;
  /// What members of that list have signed counts no more. Of a node that signs.
  void learn(const identity::RevocationList& revoked);
  /// From now on told to these peers, as long as each is not heard under the new key. A node in
  /// clear has no such news.
  void tell(const std::vector<KeyNews>& news);
  /// A key change that was heard, as bytes from anybody; nothing where none waits.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take_key_news();
  /// What was taken there was not the authority's.
  void count_forged_key_news();

  /// Those that were found since the last call: each sender, type and version once.
  [[nodiscard]] std::vector<Misfit> take_misfits();

  /// Sentences for people about the process that carries the network, since the last call: that it
  /// was started again, and why.
  [[nodiscard]] std::vector<std::string> take_troubles();

  /// What happened since open(): received, published, and by name whatever was dropped.
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const;

 private:
  class Impl;
  explicit Node(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::network
