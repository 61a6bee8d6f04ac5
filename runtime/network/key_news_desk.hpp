// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/network/key_news.hpp"

namespace skein::network {

/// The key changes that a node tells and hears. From any thread.
class KeyNewsDesk {
 public:
  static constexpr Duration kAgain = std::chrono::milliseconds{250};
  static constexpr std::size_t kHeardMax = 16;

  explicit KeyNewsDesk(VehicleId self) : self_{self} {}

  void tell(const std::vector<KeyNews>& all);
  [[nodiscard]] bool has_any() const { return any_.load(std::memory_order_relaxed); }
  /// What is due to that node, which was heard under a key of `its_epoch`.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> due(VehicleId node, std::uint8_t its_epoch,
                                                             Instant now);
  /// Kept for take(), each once at a time. Precondition: is_key_news().
  void hear(std::span<const std::uint8_t> datagram);
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take();

 private:
  struct Told {
    std::uint8_t epoch = 0;
    std::vector<std::uint8_t> datagram;
    Instant next{Instant::min()};
  };
  const VehicleId self_;
  std::atomic<bool> any_{false};
  std::mutex mutex_;  ///< of everything below
  std::map<VehicleId, Told> told_;
  std::deque<std::vector<std::uint8_t>> heard_;
};

}  // namespace skein::network
