// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace skein {

/// A first-in first-out queue with a limit. When full, the newest is refused and counted, so that a
/// flood can neither exhaust memory nor push out what is already accepted. Single-threaded.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t limit) : limit_{limit} {}

  /// False, and counted, when the queue is full.
  bool push(T value) {
    if (items_.size() >= limit_) {
      ++dropped_;
      return false;
    }
    items_.push_back(std::move(value));
    return true;
  }
  [[nodiscard]] std::optional<T> pop() {
    if (items_.empty()) return std::nullopt;
    std::optional<T> value{std::move(items_.front())};
    items_.pop_front();
    return value;
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::deque<T> items_;
  std::size_t limit_;
  std::uint64_t dropped_ = 0;
};

}  // namespace skein
