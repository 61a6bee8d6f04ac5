// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace skein {

/// A first-in first-out queue with a limit. When full, the newest is refused and counted, so that a
/// flood can neither exhaust memory nor push out what is already accepted. Single-threaded.
/// Small, and quick to be seen empty: an agent has a dozen and looks into all of them with every
/// message that comes.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t limit) : limit_{limit} {}

  /// False, and counted, when the queue is full.
  bool push(T value) {
    if (size() >= limit_) {
      ++dropped_;
      return false;
    }
    // Of a queue that is never emptied: as much again is popped before anything is moved up.
    if (first_ > limit_) {
      items_.erase(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    items_.push_back(std::move(value));
    return true;
  }
  [[nodiscard]] std::optional<T> pop() {
    if (empty()) return std::nullopt;
    return take();
  }
  [[nodiscard]] std::size_t size() const { return items_.size() - first_; }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  [[nodiscard]] std::optional<T> take() {
    std::optional<T> value{std::move(items_[first_])};
    if (++first_ == items_.size()) {
      items_.clear();
      first_ = 0;
    }
    return value;
  }

  std::vector<T> items_;   ///< empty as soon as all are popped
  std::size_t first_ = 0;  ///< in items_: those before it are popped
  std::size_t limit_;
  std::uint64_t dropped_ = 0;
};

}  // namespace skein
