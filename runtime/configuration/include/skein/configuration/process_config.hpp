// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

/// What people configure, as plain structs: SI units, radians from east, durations. The YAML files
/// say compass degrees, metres and seconds, with the unit in the key (docs/configuration.md).
namespace skein::configuration {

/// A node of the mission network that this one may hear. The ground station is vehicle 0.
struct NetworkPeer {
  VehicleId id;
  std::string address = "127.0.0.1";  ///< IPv4
  std::uint16_t port = 0;             ///< UDP
  friend bool operator==(const NetworkPeer&, const NetworkPeer&) = default;
};

/// How a team shares the air: everything is said once, for all who hear it.
struct AirConfig {
  std::string group = "239.255.83.1";  ///< where all listen; of the organisation alone (RFC 2365)
  double limit_bytes_per_s = 0.0;      ///< that a node may take; 0: none
  std::uint8_t hops_max = 1;  ///< how many nodes may say a message; 1: nobody passes on others'
  friend bool operator==(const AirConfig&, const AirConfig&) = default;
};

struct NetworkConfig {
  std::uint16_t domain_id = 0;
  std::string address = "127.0.0.1";
  std::uint16_t port = 7400;  ///< UDP; of all on the air. With Fast DDS the next one is used, too
  std::vector<NetworkPeer> peers;  ///< to each by itself, with Fast DDS; none: by the air
  AirConfig air;
  std::string keys;              ///< folder of this node's keys; empty: in clear, on loopback only
  std::string transport_plugin;  ///< a shared library; empty: plain UDP
  bool isolated = true;          ///< Fast DDS runs in a process of its own
  friend bool operator==(const NetworkConfig&, const NetworkConfig&) = default;
};

/// Mission time = (system time - epoch) * rate.
struct TimeConfig {
  /// Of the whole fleet, and of whoever starts anew: never the moment when a process starts. 0: not
  /// given, which no file may say.
  std::int64_t epoch_unix_ns = 0;
  double rate = 1.0;
  friend bool operator==(const TimeConfig&, const TimeConfig&) = default;
};

/// A decision that a script takes in the operator's place, when a request for that site arrives.
struct OperatorDecision {
  SiteId site;
  bool grant = true;
  Duration reaction = std::chrono::seconds{2};  ///< from the request to the decision
  Instant not_before{};
  friend bool operator==(const OperatorDecision&, const OperatorDecision&) = default;
};

}  // namespace skein::configuration
