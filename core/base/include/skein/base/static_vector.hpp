// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "skein/base/assert.hpp"

namespace skein {

/// A vector of at most `Capacity` trivially copyable elements, stored in place: it can be handed
/// between threads by value and never allocates. As a contiguous range it becomes a std::span.
template <class T, std::size_t Capacity>
class StaticVector {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  using value_type = T;

  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == Capacity; }
  void clear() { size_ = 0; }

  /// Precondition: !full().
  void push_back(const T& value) {
    SKEIN_ASSERT(!full());
    items_[size_++] = value;
  }
  /// False, and nothing added, when full.
  [[nodiscard]] bool try_push_back(const T& value) {
    if (full()) return false;
    items_[size_++] = value;
    return true;
  }

  [[nodiscard]] const T& operator[](std::size_t i) const {
    SKEIN_ASSERT(i < size_);
    return items_[i];
  }
  [[nodiscard]] T& operator[](std::size_t i) {
    SKEIN_ASSERT(i < size_);
    return items_[i];
  }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] T& back() { return (*this)[size_ - 1]; }
  void pop_back() {
    SKEIN_ASSERT(size_ > 0);
    --size_;
  }

  [[nodiscard]] const T* begin() const { return items_.data(); }
  [[nodiscard]] const T* end() const { return items_.data() + size_; }
  [[nodiscard]] T* begin() { return items_.data(); }
  [[nodiscard]] T* end() { return items_.data() + size_; }

 private:
  std::array<T, Capacity> items_{};
  std::size_t size_ = 0;
};

}  // namespace skein
