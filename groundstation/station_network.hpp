// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "skein/configuration/process_config.hpp"
#include "skein/network/node.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/wake.hpp"

namespace skein::groundstation {

/// A ground station on the mission network. One alone speaks and hears as the ground station. One
/// of several hears as a node of its own, all that anybody says, and speaks as the ground station
/// while it has the command, by a second node.
class StationNetwork {
 public:
  /// `start` is that of kGroundStation, or of a station (skein/base/stations.hpp).
  [[nodiscard]] static Result<std::unique_ptr<StationNetwork>> open(
      const configuration::NetworkConfig& config, const process::NodeStart& start,
      process::Wake& wake);

  /// That hears; of one alone also the one that speaks.
  [[nodiscard]] network::Node& ear() { return *ear_; }
  /// Where the command is had: what speaks.
  [[nodiscard]] network::Node* voice() { return voice_ ? voice_.get() : ear_.get(); }

  /// From now on it speaks as the ground station, with a start that is newer than `newest`, which
  /// was heard of another. Precondition: it is one of several.
  [[nodiscard]] Result<InstanceId> speak(std::optional<InstanceId> newest);
  /// Nothing is said any more, and nothing that was said is said again.
  void fall_silent();
  /// That start of another was heard: the next of this one is counted beyond it.
  void note(InstanceId other) const;
  bool publish(const mission::Message& message);

  /// From another thread: what the ear has changed to, the voice does, too.
  void on_key(const identity::RevocationList& revoked, const seal::EpochKey& key, Duration old_for);

 private:
  StationNetwork(configuration::NetworkConfig config, process::NodeStart start)
      : config_{std::move(config)}, start_{std::move(start)} {}
  [[nodiscard]] bool is_one_of_several() const { return start_.self != kGroundStation; }

  const configuration::NetworkConfig config_;
  process::NodeStart start_;  ///< without its identity
  network::NodeConfig node_;  ///< the ear's
  std::unique_ptr<network::Node> ear_;
  std::mutex mutex_;  ///< of voice_, where it is made, given up, or given a key, and of node_
  std::unique_ptr<network::Node> voice_;
  bool silent_ = false;
};

}  // namespace skein::groundstation
