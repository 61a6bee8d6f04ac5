// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/mission/messages.hpp"

namespace skein::detectors {

/// The Unix datagram socket where detectors on this machine tell what they have seen, one text a
/// datagram. Whoever may write to the file is believed to be a detector of this vehicle: its
/// permissions are the owner's and the group's. Single-threaded; nothing blocks.
class DetectorSocket {
 public:
  /// Fails where there is no such folder, or somebody else listens there. A file that was left by a
  /// process that is gone gives way.
  [[nodiscard]] static Result<DetectorSocket> open(const std::string& path,
                                                   const MissionOrigin& origin);
  ~DetectorSocket();
  DetectorSocket(DetectorSocket&& other) noexcept;
  DetectorSocket& operator=(DetectorSocket&&) = delete;
  DetectorSocket(const DetectorSocket&) = delete;
  DetectorSocket& operator=(const DetectorSocket&) = delete;

  /// The next one, if any. What cannot be read is passed over and counted.
  [[nodiscard]] std::optional<mission::Detection> poll();
  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }
  /// What was wrong with the newest of those, once.
  [[nodiscard]] std::optional<std::string> poll_trouble();

 private:
  DetectorSocket(int descriptor, std::string path, const MissionOrigin& origin)
      : descriptor_{descriptor}, path_{std::move(path)}, origin_{origin} {}

  int descriptor_ = -1;
  std::string path_;
  MissionOrigin origin_;
  std::uint64_t unreadable_ = 0;
  std::optional<std::string> trouble_;
};

}  // namespace skein::detectors
