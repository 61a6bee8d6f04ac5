// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/ros2/publication.hpp"

namespace skein::ros2 {

struct RosNodeConfig {
  std::uint32_t domain = 0;
  std::string address = "127.0.0.1";  ///< IPv4 of the one interface that is used
  std::vector<std::string> peers;     ///< IPv4 of hosts that multicast does not reach
  std::string name_space = "skein";   ///< begins all topics
  std::uint32_t gid_bytes = 16;       ///< of ros_discovery_info; 24 in ROS 2 Humble
};

/// A node of ROS 2, "skein_bridge", as far as others can tell: a participant of DDS by Fast DDS,
/// its topics, types and their hashes under the names that ROS 2 gives them, and the word on
/// ros_discovery_info that makes a node of it. Publishes, and hears one topic: site_proposal.
class RosNode {
 public:
  static constexpr std::size_t kTopicsMax = 4000;
  static constexpr const char* kProposalTopic = "site_proposal";

  /// Fails where Fast DDS has no room. Precondition: the address is of this machine.
  [[nodiscard]] static Result<std::unique_ptr<RosNode>> open(const RosNodeConfig& config);
  RosNode(const RosNode&) = delete;
  RosNode& operator=(const RosNode&) = delete;
  virtual ~RosNode() = default;

  /// Makes the topic where it is new. False where it could not be taken: too many topics, or no
  /// room. Never waits for a reader.
  virtual bool publish(const Publication& publication) = 0;
  /// To be called when a round of publications is over: tells others of new topics.
  virtual void tell_of_topics() = 0;
  /// The next sample of SiteProposal as it came, CDR with its header.
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> next_proposal() = 0;

 protected:
  RosNode() = default;
};

}  // namespace skein::ros2
