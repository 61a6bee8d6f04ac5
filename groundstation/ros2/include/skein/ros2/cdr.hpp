// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Messages as ROS 2 has them on the wire: plain CDR (XCDR1, little endian) after its header of
/// four bytes; numbers aligned to their size, counted from the end of that header. In pure
/// functions.
namespace skein::ros2 {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::array<std::uint8_t, 4> kCdrHeader{0x00, 0x01, 0x00, 0x00};

/// A struct that the generator has made.
template <class T>
concept Message = requires {
  T::kType;
};

class CdrWriter {
 public:
  CdrWriter() : bytes_(kCdrHeader.begin(), kCdrHeader.end()) {}
  [[nodiscard]] std::vector<std::uint8_t> take() && { return std::move(bytes_); }

  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    while ((bytes_.size() - kCdrHeader.size()) % sizeof(T) != 0) bytes_.push_back(0);
    const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) bytes_.push_back(static_cast<std::uint8_t>(c));
    bytes_.push_back(0);
  }
  template <class T>
  void put(const std::vector<T>& many) {
    put(static_cast<std::uint32_t>(many.size()));
    for (const T& one : many) put(one);
  }
  template <class T, std::size_t Count>
  void put(const std::array<T, Count>& many) {
    for (const T& one : many) put(one);
  }
  template <Message T>
  void put(const T& message) {
    T::for_each_field(message, [this](const auto& field) { this->put(field); });
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Reads what others have written; every length is held against what is there.
class CdrReader {
 public:
  /// `bytes` without the header.
  explicit CdrReader(std::span<const std::uint8_t> bytes) : bytes_{bytes} {}
  [[nodiscard]] bool good() const { return good_; }

  template <class T>
  requires std::is_arithmetic_v<T>
  void get(T& value) {
    at_ += (sizeof(T) - at_ % sizeof(T)) % sizeof(T);
    if (!has(sizeof(T))) return;
    if constexpr (std::is_same_v<T, bool>) {
      value = bytes_[at_] != 0;
    } else {
      std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    }
    at_ += sizeof(T);
  }
  /// Whatever follows a first NUL is dropped.
  void get(std::string& text) {
    std::uint32_t size = 0;
    get(size);
    if (!has(size)) return;
    text.assign(reinterpret_cast<const char*>(bytes_.data() + at_), size);
    text.resize(std::min(text.size(), text.find('\0')));
    at_ += size;
  }
  template <class T>
  void get(std::vector<T>& many) {
    std::uint32_t size = 0;
    get(size);
    if (!has(size)) return;  // no element has less than a byte
    many.clear();
    for (std::uint32_t i = 0; good_ && i < size; ++i) get(many.emplace_back());
  }
  template <class T, std::size_t Count>
  void get(std::array<T, Count>& many) {
    for (T& one : many) get(one);
  }
  template <Message T>
  void get(T& message) {
    T::for_each_field(message, [this](auto& field) { this->get(field); });
  }

 private:
  bool has(std::size_t size) {
    good_ = good_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
    return good_;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

template <Message T>
[[nodiscard]] std::vector<std::uint8_t> to_cdr(const T& message) {
  CdrWriter writer;
  writer.put(message);
  return std::move(writer).take();
}

/// Nothing where it is no such message, or not in plain little-endian CDR. Bytes after it are
/// padding.
template <Message T>
[[nodiscard]] std::optional<T> from_cdr(std::span<const std::uint8_t> bytes) {
  // The last two are options: how much of the end is padding.
  if (bytes.size() < kCdrHeader.size() || bytes[0] != kCdrHeader[0] || bytes[1] != kCdrHeader[1]) {
    return std::nullopt;
  }
  CdrReader reader{bytes.subspan(kCdrHeader.size())};
  T message;
  reader.get(message);
  if (!reader.good()) return std::nullopt;
  return message;
}

}  // namespace skein::ros2
