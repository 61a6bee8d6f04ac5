// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "skein/base/result.hpp"
#include "skein/identity/keys.hpp"

namespace skein::identity {

/// Numbers big endian, one after the other.
class ByteWriter {
 public:
  ByteWriter& number(std::uint64_t value, unsigned bytes) {
    std::array<std::uint8_t, 8> digits{};
    for (unsigned i = 0; i < bytes; ++i) {
      digits.at(i) = static_cast<std::uint8_t>(value >> (8U * (bytes - 1 - i)));
    }
    return add(Span{digits}.first(bytes));
  }
  ByteWriter& add(Span bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  ByteWriter& add(std::string_view text) {
    out_.insert(out_.end(), text.begin(), text.end());
    return *this;
  }
  [[nodiscard]] Bytes take() { return std::move(out_); }

 private:
  Bytes out_;
};

/// What such a writer wrote, by anybody: reads no further than there is, and remembers the first
/// field that was not as it must be. After that all is zero.
class ByteReader {
 public:
  /// `what` and the fields are named to people.
  ByteReader(Span bytes, const char* what) : left_{bytes}, what_{what} {}

  Span take(std::size_t count, const char* field) {
    require(count <= left_.size(), field);
    if (wrong_ != nullptr) return {};
    const Span taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  std::uint64_t number(unsigned bytes, const char* field) {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : take(bytes, field)) value = value << 8U | byte;
    return value;
  }
  template <std::size_t N>
  std::array<std::uint8_t, N> array(const char* field) {
    std::array<std::uint8_t, N> value{};
    const Span taken = take(N, field);
    std::copy(taken.begin(), taken.end(), value.begin());
    return value;
  }
  std::string text(std::size_t count, const char* field) {
    const Span taken = take(count, field);
    return {taken.begin(), taken.end()};
  }
  void require(bool holds, const char* field) {
    if (!holds && wrong_ == nullptr) wrong_ = field;
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }
  /// Everything was there, and nothing else.
  [[nodiscard]] Result<void> finish() const;
  template <class T>
  [[nodiscard]] Result<T> finish(T value) const {
    if (auto all = finish(); !all) return all.error();
    return value;
  }

 private:
  Span left_;
  const char* what_;
  const char* wrong_ = nullptr;
};

}  // namespace skein::identity
