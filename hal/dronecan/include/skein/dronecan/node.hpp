// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/time.hpp"
#include "skein/dronecan/transfer.hpp"

namespace skein::dronecan {

struct NodeParams {
  std::uint8_t node_id = 42;  ///< 1..127; every node on a bus has its own
  std::string name = "skein.companion";
  SoftwareVersion software_version;
  /// With a unique id that stays the same: autopilots keep a table and refuse a node that changed.
  HardwareVersion hardware_version;
  bool fd = false;                                   ///< send CAN FD frames
  Duration status_period = std::chrono::seconds{1};  ///< at most 1 s
  Duration offline_after = std::chrono::seconds{3};  ///< of a node's silence
  Duration answer_within = std::chrono::seconds{1};  ///< then GetNodeInfo is asked again
  bool ask_for_info = true;                          ///< of every node that appears
  std::size_t transmit_limit = 64;                   ///< transfers that wait to be sent
};

/// Another node, as it tells of itself.
struct RemoteNode {
  std::uint8_t node_id = 0;
  bool online = false;
  NodeStatus status;
  Instant heard;                            ///< its last NodeStatus
  std::optional<GetNodeInfoResponse> info;  ///< once it has answered
};

/// Both of the duplicates are told again, each second at most, while their signs go on.
enum class NodeEventKind : std::uint8_t {
  appeared,   ///< its first NodeStatus, or the first after it was silent
  informed,   ///< has answered GetNodeInfo
  restarted,  ///< its uptime went back
  silent,     ///< no NodeStatus for `offline_after`
  duplicate,  ///< two nodes have its id: another unique id came, or its uptime goes back and forth
  duplicate_own,  ///< somebody else sends with our id
};
struct NodeEvent {
  NodeEventKind kind = NodeEventKind::appeared;
  std::uint8_t node_id = 0;
  Instant time;
};

/// A node on a DroneCAN bus, of one interface or two that carry the same: sends NodeStatus, answers
/// GetNodeInfo, asks the others, and finds two nodes with one id. No I/O: frames and times come in,
/// frames go out.
class Node {
 public:
  Node(const NodeParams& params, Instant now);

  /// A frame that was received. Returns the transfer that it completes, if that is a message to all
  /// or is addressed to this node; valid until the next call. NodeStatus and GetNodeInfo are
  /// already dealt with.
  const Transfer* on_frame(const can::Frame& frame, std::uint8_t interface, Instant now);
  /// What is due by `now`.
  void step(Instant now);
  [[nodiscard]] Instant next_timeout() const;

  /// Queues a message to all; false when the queue is full.
  template <class Message>
  bool publish(const Message& message, std::uint8_t priority) {
    Header header;
    header.type = Message::kDefinition.id;
    header.priority = priority;
    return enqueue(header, Message::kDefinition.signature, to_payload(message, params_.fd));
  }

  /// The frames of the transfer that is to be sent next: the one with the highest priority that has
  /// waited longest. Empty when there is none. Send all of it, on every interface, then pop().
  [[nodiscard]] std::span<const can::Frame> front();
  void pop();
  [[nodiscard]] std::size_t waiting() const { return outgoing_.size(); }
  /// Transfers that can still be queued.
  [[nodiscard]] std::size_t room() const { return params_.transmit_limit - outgoing_.size(); }

  void set_status(Health health, Mode mode, std::uint16_t vendor_specific = 0);
  [[nodiscard]] std::optional<NodeEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] std::span<const RemoteNode> others() const { return others_; }
  /// Null if never heard.
  [[nodiscard]] const RemoteNode* find(std::uint8_t node_id) const;
  [[nodiscard]] std::uint8_t node_id() const { return params_.node_id; }
  [[nodiscard]] const ReassemblyStatistics& reassembly() const { return reassembler_.statistics(); }
  [[nodiscard]] std::uint64_t refused() const {
    return refused_;
  }  ///< transfers, the queue being full

 private:
  struct Outgoing {
    Header header;
    std::uint64_t signature = 0;
    Payload payload;
    std::uint64_t order = 0;
  };
  struct Watch {  ///< beside others_, what is remembered to judge them
    std::optional<Instant> asked;
    unsigned questions = 0;
    unsigned restarts = 0;  ///< in short succession
    Instant last_restart;
    std::optional<Instant> duplicate_reported;
  };
  struct Counter {
    std::uint32_t key;
    std::uint8_t next;
  };

  bool enqueue(Header header, std::uint64_t signature, const Payload& payload);
  std::uint8_t take_transfer_id(const Header& header);
  void report(NodeEventKind kind, std::uint8_t node_id, Instant now);
  void on_status(const Transfer& transfer, Instant now);
  void on_info(const Transfer& transfer, Instant now);
  void answer_info(const Header& request, Instant now);
  void ask(std::size_t other, Instant now);
  std::size_t index_of(std::uint8_t node_id);
  [[nodiscard]] NodeStatus status(Instant now) const;
  void report_duplicate(std::size_t other, Instant now);

  NodeParams params_;
  Instant started_;
  Instant status_at_;
  std::optional<Instant> duplicate_reported_;  ///< of our own id
  Health health_ = Health::ok;
  Mode mode_ = Mode::operational;
  std::uint16_t vendor_specific_ = 0;
  Reassembler reassembler_;
  std::vector<Outgoing> outgoing_;
  TransferFrames front_;
  std::optional<std::uint64_t> front_order_;
  std::uint64_t next_order_ = 0;
  std::vector<Counter> counters_;
  std::vector<RemoteNode> others_;
  std::vector<Watch> watches_;
  BoundedQueue<NodeEvent> events_{64};
  std::uint64_t refused_ = 0;
};

}  // namespace skein::dronecan
