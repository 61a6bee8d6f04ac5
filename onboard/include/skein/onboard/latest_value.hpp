// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace skein::onboard {

/// The newest value from one writing thread to one reading thread: a triple buffer. Both sides are
/// wait-free, never allocate, and never see half a value; values that nobody read in time are lost,
/// which is what "latest" means.
template <class T>
class LatestValue {  // NOLINT(clang-analyzer-optin.performance.Padding): cache lines of their own
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// From the writing thread.
  void write(const T& value) {
    slots_[back_] = value;
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) &
            kIndex;
  }
  /// From the reading thread: the newest value, or nothing when it has been read before. Valid
  /// until the next read().
  [[nodiscard]] const T* read() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return nullptr;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return &slots_[front_];
  }

 private:
  static constexpr std::uint8_t kIndex = 0x3;
  static constexpr std::uint8_t kFresh = 0x4;  ///< the middle slot was written and not yet read

  std::array<T, 3> slots_{};
  alignas(64) std::uint8_t back_ = 0;  ///< the writer's
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t front_ = 2;  ///< the reader's
};

}  // namespace skein::onboard
