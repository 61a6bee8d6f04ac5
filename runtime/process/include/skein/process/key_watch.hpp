// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "skein/identity/identity.hpp"
#include "skein/network/node.hpp"

namespace skein::process {

/// Follows the team's key while a process runs, in a thread of its own: what it writes must be on
/// the disk. A vehicle takes news that it hears; the ground station looks at what its authority has
/// decided since, and tells it to those whom it concerns.
class KeyWatch {
 public:
  using OnTold = std::function<void(const identity::RevocationList& revoked)>;
  /// On its thread, after the node has changed: another of this process has to, too.
  using OnKey = std::function<void(const identity::RevocationList& revoked,
                                   const seal::EpochKey& key, Duration old_for)>;

  /// `folder` is the node's own (network.keys). `on_told` is called, on its thread, where there are
  /// new news for the others: they go before whatever each is sent next. The node must outlive it.
  KeyWatch(
      network::Node& node, identity::Identity identity, std::filesystem::path folder,
      OnTold on_told = [](const identity::RevocationList&) {},
      OnKey on_key = [](const auto&, const auto&, Duration) {});
  ~KeyWatch();
  KeyWatch(const KeyWatch&) = delete;
  KeyWatch& operator=(const KeyWatch&) = delete;

 private:
  void run();
  void take_news();
  void look_at_changes();
  void begin_epoch();

  network::Node& node_;
  identity::Identity identity_;
  const std::filesystem::path folder_;
  const OnTold on_told_;
  const OnKey on_key_;
  std::optional<std::filesystem::file_time_type> changes_of_;
  std::string said_;  ///< the last trouble, told once
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace skein::process
