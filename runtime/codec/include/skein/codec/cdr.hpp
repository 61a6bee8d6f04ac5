// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/text.hpp"
#include "skein/codec/describe.hpp"

/// Described types as XCDR1 in little endian with its header of 4 bytes, and back. The low two bits
/// of the header's options say how many bytes at the end only fill up to a multiple of 4, as
/// DDS-XTypes 1.3 (7.6.3.1.2) has it; so the end of what a sender knows is exact, and fields may be
/// appended (idl/README.md).
namespace skein::codec {

static_assert(std::endian::native == std::endian::little);

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::size_t kHeaderBytes = 4;

/// Why bytes are no message.
enum class Fault : std::uint8_t {
  malformed,     ///< too short, too long, or not what CDR allows
  bad_version,   ///< of a version of its type that is not ours
  bad_value,     ///< a field is out of its range
  unknown_kind,  ///< of a later release: an enumerator or a union's member that we do not know
};
struct Refusal {
  Fault fault = Fault::malformed;
  std::uint16_t version = 0;  ///< of the sender's type, where the fault is bad_version
};

class CdrWriter {
 public:
  CdrWriter() : bytes_(256), at_{kHeaderBytes} {}

  /// None where a value is out of its range.
  [[nodiscard]] std::optional<Bytes> finish() {
    if (!ok_) return std::nullopt;
    const std::size_t end = (at_ + 3) / 4 * 4;
    bytes_.resize(end);
    std::fill(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(), std::uint8_t{0});
    bytes_[0] = 0;
    bytes_[1] = 1;
    bytes_[2] = 0;
    bytes_[3] = static_cast<std::uint8_t>(end - at_);
    return std::move(bytes_);
  }

  template <class T>
  void whole(const T& value) {
    put(Type<T>::kVersion);
    content(value);
  }

  static constexpr bool at_end() { return false; }

  void operator()(const char*, bool value, Flag) { put(std::uint8_t{value}); }
  void operator()(const char*, double value, Real limits) {
    require(value >= limits.min && value <= limits.max);  // false for what is not a number
    put(value);
  }
  template <class T, class Wire>
  void operator()(const char*, const T& value, Whole<Wire> limits) {
    const auto number = number_of(value);
    require(std::in_range<Wire>(number) && std::cmp_greater_equal(number, limits.min) &&
            std::cmp_less_equal(number, limits.max));
    put(static_cast<Wire>(number));
  }
  template <class E>
  void operator()(const char*, E value, Name) {
    require(value < E::count);
    put(static_cast<std::uint32_t>(value));
  }
  void operator()(const char*, const std::string& value, Text limits) {
    const std::string text = as_text(value, limits.bytes_max);
    require(is_text(text));
    put(static_cast<std::uint32_t>(text.size() + 1));
    reserve(text.size() + 1);
    std::memcpy(bytes_.data() + at_, text.c_str(), text.size() + 1);
    at_ += text.size() + 1;
  }
  template <class T>
  void operator()(const char*, const T& value, Part) {
    part(value);
  }
  template <class T>
  void operator()(const char*, const std::shared_ptr<const T>& value, Kept) {
    part(*value);
  }
  template <class T>
  void operator()(const char*, const T& value, Choice) {
    content(value);
  }
  template <class T, class Element>
  void operator()(const char* name, const std::optional<T>& value, Maybe<Element> maybe) {
    put(std::uint8_t{value.has_value()});
    (*this)(name, value.value_or(T{}), maybe.element);
  }
  template <class Range, class Element>
  void operator()(const char* name, const Range& values, Many<Element> many) {
    require(values.size() <= many.count_max);
    if (!ok_) return;
    put(static_cast<std::uint32_t>(values.size()));
    for (const auto& value : values) (*this)(name, value, many.element);
  }

 private:
  void require(bool condition) { ok_ = ok_ && condition; }
  void reserve(std::size_t more) {
    if (at_ + more > bytes_.size()) bytes_.resize(2 * (at_ + more));
  }
  template <class Number>
  void put(Number number) {
    reserve(2 * sizeof number);
    const std::size_t from = at_;
    at_ = (at_ - kHeaderBytes + sizeof number - 1) / sizeof number * sizeof number + kHeaderBytes;
    std::memset(bytes_.data() + from, 0, at_ - from);
    std::memcpy(bytes_.data() + at_, &number, sizeof number);
    at_ += sizeof number;
  }
  template <class T>
  void part(const T& value) {
    if constexpr (Type<T>::kGrows) {
      put(std::uint32_t{0});
      const std::size_t begin = at_;
      fields(value, *this);
      const auto size = static_cast<std::uint32_t>(at_ - begin);
      std::memcpy(bytes_.data() + begin - sizeof size, &size, sizeof size);
    } else {
      fields(value, *this);
    }
  }
  template <class T>
  void content(const T& value) {
    fields(value, *this);
  }
  template <Union T>
  void content(const T& value) {
    put(static_cast<std::uint32_t>(value.index()));
    std::visit([this](const auto& branch) { this->part(branch); }, value);
  }

  Bytes bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Never reads beyond the bytes. Counts and sizes are checked before memory is taken: against their
/// limits, and against what is left of the bytes.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> bytes) : bytes_{bytes} {
    constexpr std::uint8_t kPaddingMask = 3;
    const bool known = bytes.size() >= kHeaderBytes && bytes[0] == 0 && bytes[1] == 1;
    const std::size_t padding = known ? bytes[3] & kPaddingMask : 0;
    require(known && bytes.size() >= kHeaderBytes + padding, Fault::malformed);
    if (refusal_) return;
    at_ = kHeaderBytes;
    end_ = bytes.size() - padding;
  }

  [[nodiscard]] const std::optional<Refusal>& refusal() const { return refusal_; }

  template <class T>
  void whole(T& value) {
    const auto version = take<std::uint16_t>();
    if (!refusal_ && version != Type<T>::kVersion) refusal_ = {Fault::bad_version, version};
    if (!refusal_) content(value);
  }

  /// Of what the sender knows of the type: what is appended to it keeps its default.
  [[nodiscard]] bool at_end() const { return at_ == end_; }

  void operator()(const char*, bool& value, Flag) {
    const auto byte = take<std::uint8_t>();
    require(byte <= 1, Fault::bad_value);
    value = byte == 1;
  }
  void operator()(const char*, double& value, Real limits) {
    value = take<double>();
    require(value >= limits.min && value <= limits.max, Fault::bad_value);
  }
  template <class T, class Wire>
  void operator()(const char*, T& value, Whole<Wire> limits) {
    const auto number = take<Wire>();
    require(number >= limits.min && number <= limits.max, Fault::bad_value);
    value = from_number<T>(number);
  }
  template <class E>
  void operator()(const char*, E& value, Name) {
    const auto number = take<std::uint32_t>();
    require(number < static_cast<std::uint32_t>(E::count), Fault::unknown_kind);
    if (!refusal_) value = static_cast<E>(number);
  }
  void operator()(const char*, std::string& value, Text limits) {
    const std::size_t size = take<std::uint32_t>();
    require(size >= 1 && size <= left(), Fault::malformed);
    require(size <= limits.bytes_max + 1, Fault::bad_value);
    if (refusal_) return;
    const std::string_view text{reinterpret_cast<const char*>(bytes_.data()) + at_, size - 1};
    require(bytes_[at_ + size - 1] == 0, Fault::malformed);
    require(is_text(text), Fault::bad_value);
    at_ += size;
    if (!refusal_) value = text;
  }
  template <class T>
  void operator()(const char*, T& value, Part) {
    part(value);
  }
  template <class T>
  void operator()(const char*, std::shared_ptr<const T>& value, Kept) {
    auto kept = std::make_shared<T>();
    part(*kept);
    value = std::move(kept);
  }
  template <class T>
  void operator()(const char*, T& value, Choice) {
    content(value);
  }
  template <class T, class Element>
  void operator()(const char* name, std::optional<T>& value, Maybe<Element> maybe) {
    bool has = false;
    (*this)(name, has, Flag{});
    T there{};
    (*this)(name, there, maybe.element);
    if (has) value = there;
  }
  template <class Range, class Element>
  void operator()(const char* name, Range& values, Many<Element> many) {
    const std::size_t count = take<std::uint32_t>();
    require(count <= many.count_max, Fault::bad_value);
    require(count <= left(), Fault::malformed);  // no element has no bytes
    if (refusal_) return;
    if constexpr (requires { values.reserve(count); }) values.reserve(count);
    for (std::size_t i = 0; i < count && !refusal_; ++i) {
      typename Range::value_type value{};
      (*this)(name, value, many.element);
      values.push_back(std::move(value));
    }
  }

 private:
  [[nodiscard]] std::size_t left() const { return end_ - at_; }
  void require(bool condition, Fault fault) {
    if (!condition && !refusal_) refusal_ = Refusal{fault};
  }
  template <class Number>
  Number take() {
    const std::size_t at =
        (at_ - kHeaderBytes + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number) + kHeaderBytes;
    require(at + sizeof(Number) <= end_, Fault::malformed);
    if (refusal_) return {};
    Number number{};
    std::memcpy(&number, bytes_.data() + at, sizeof number);
    at_ = at + sizeof number;
    return number;
  }
  template <class T>
  void part(T& value) {
    if constexpr (Type<T>::kGrows) {
      const std::size_t size = take<std::uint32_t>();
      require(size <= left(), Fault::malformed);
      if (refusal_) return;
      const std::size_t outer = end_;
      const std::size_t own = at_ + size;
      end_ = own;
      fields(value, *this);
      at_ = own;  // past what a later release has appended
      end_ = outer;
    } else {
      fields(value, *this);
    }
  }
  template <class T>
  void content(T& value) {
    fields(value, *this);
  }
  template <Union T>
  void content(T& value) {
    const std::size_t kind = take<std::uint32_t>();
    require(kind < std::variant_size_v<VariantOf<T>>, Fault::unknown_kind);
    if (refusal_) return;
    with_alternative<T>(kind, [&]<class Branch>() { part(value.template emplace<Branch>()); });
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;
  std::optional<Refusal> refusal_;
};

/// None where a value is out of its range: nobody sends what others would drop. Texts are made fit.
template <class T>
[[nodiscard]] std::optional<Bytes> to_cdr(const T& value) {
  CdrWriter writer;
  writer.whole(value);
  return writer.finish();
}

/// Any bytes are safe.
template <class T>
[[nodiscard]] std::variant<T, Refusal> from_cdr(std::span<const std::uint8_t> bytes) {
  std::variant<T, Refusal> result;
  CdrReader reader{bytes};
  reader.whole(std::get<T>(result));
  if (reader.refusal()) result = *reader.refusal();
  return result;
}

}  // namespace skein::codec
