// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skein::mcap {

using Bytes = std::vector<std::uint8_t>;

/// Writes over what stands there, little endian, as all of MCAP.
template <class T>
void put_at(Bytes& to, std::size_t offset, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    to[offset + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
  }
}
template <class T>
void put(Bytes& to, T value) {
  const std::size_t at = to.size();
  to.resize(at + sizeof(T));
  put_at(to, at, value);
}
inline void put_bytes(Bytes& to, std::span<const std::uint8_t> bytes) {
  const std::size_t at = to.size();
  to.resize(at + bytes.size());
  std::copy(bytes.begin(), bytes.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
}
inline void put_text(Bytes& to, std::string_view text) {
  put<std::uint32_t>(to, static_cast<std::uint32_t>(text.size()));
  put_bytes(to, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}
inline void put_map(Bytes& to, const std::map<std::string, std::string>& map) {
  const std::size_t length_at = to.size();
  put<std::uint32_t>(to, 0);
  for (const auto& [key, value] : map) {
    put_text(to, key);
    put_text(to, value);
  }
  put_at(to, length_at, static_cast<std::uint32_t>(to.size() - length_at - sizeof(std::uint32_t)));
}

/// Takes values from bytes. Where they end too soon, it gives zeros and is no longer ok.
class Taker {
 public:
  explicit Taker(std::span<const std::uint8_t> bytes) : rest_{bytes} {}

  template <class T>
  T take() {
    std::uint64_t value = 0;
    const auto bytes = take_bytes(sizeof(T));
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << (8U * i);
    return static_cast<T>(value);
  }
  std::span<const std::uint8_t> take_bytes(std::uint64_t size) {
    if (size > rest_.size()) {
      ok_ = false;
      rest_ = {};
    }
    const auto taken = rest_.first(ok_ ? static_cast<std::size_t>(size) : 0);
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  std::string take_text() {
    const auto bytes = take_bytes(take<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  std::map<std::string, std::string> take_map() {
    std::map<std::string, std::string> map;
    Taker inner{take_bytes(take<std::uint32_t>())};
    while (inner.ok_ && !inner.rest_.empty()) {
      std::string key = inner.take_text();
      map[std::move(key)] = inner.take_text();
    }
    ok_ = ok_ && inner.ok_;
    return map;
  }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

}  // namespace skein::mcap
