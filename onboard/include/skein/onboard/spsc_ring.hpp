// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace skein::onboard {

/// A queue from one pushing thread to one popping thread. Both sides are wait-free; the ring itself
/// never allocates after construction. When full, the newest is refused and counted.
template <class T, std::size_t Capacity>
class SpscRing {  // NOLINT(clang-analyzer-optin.performance.Padding): cache lines of their own
  static_assert(Capacity > 0 && (Capacity & (Capacity - 1)) == 0, "a power of two");

 public:
  /// From the pushing thread. False, and counted, when full.
  bool push(T value) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == Capacity) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[tail % Capacity] = std::move(value);
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  /// From the popping thread.
  [[nodiscard]] std::optional<T> pop() {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return std::nullopt;
    std::optional<T> value;
    value.swap(slots_[head % Capacity]);
    head_.store(head + 1, std::memory_order_release);
    return value;
  }
  /// From any thread.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::vector<std::optional<T>> slots_ = std::vector<std::optional<T>>(Capacity);
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace skein::onboard
