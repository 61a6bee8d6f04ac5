// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/task.hpp"

/// How the types of idl/ are described to whoever writes, reads, makes or prints them. The
/// generator gives for each type a Type<> and a function fields(value, f), which calls f(name,
/// member, description) for each field in its order; the descriptions are these.
namespace skein::codec {

struct Flag {};
/// An enumerator; the type's last one is `count`.
struct Name {};
/// A number, and what core has in its place, which stands as `Wire` in the bytes.
template <class Wire>
struct Whole {
  Wire min;
  Wire max;
};
struct Real {
  double min;
  double max;
};
struct Text {
  std::size_t bytes_max;
};
/// A struct with fields() of its own, and one that is kept elsewhere.
struct Part {};
struct Kept {};
/// A std::variant of such structs.
struct Choice {};
/// A std::optional: a flag, then the value or what stands for none.
template <class Element>
struct Maybe {
  Element element;
};
template <class Element>
Maybe(Element) -> Maybe<Element>;
template <class Element>
struct Many {
  std::size_t count_max;
  Element element;
};
template <class Element>
Many(int, Element) -> Many<Element>;

/// kName in tools; kGrows: its size stands before it where it is part of another; kVersion: of a
/// whole message or record, else 0.
template <class T>
struct Type;

template <class Self, class T>
concept Of = std::same_as<std::remove_const_t<Self>, T>;

template <class T>
struct IsId : std::false_type {};
template <class Tag, class Rep>
struct IsId<Id<Tag, Rep>> : std::true_type {};

/// What core has in place of a number, as a number, and back.
template <class T>
[[nodiscard]] constexpr auto number_of(const T& value) {
  if constexpr (IsId<T>::value) {
    return value.value;
  } else if constexpr (std::is_same_v<T, Instant>) {
    return value.time_since_epoch().count();
  } else if constexpr (std::is_same_v<T, Duration>) {
    return value.count();
  } else if constexpr (std::is_same_v<T, Capabilities>) {
    return value.bits();
  } else {
    static_assert(std::is_integral_v<T>);
    return value;
  }
}
template <class T, class Wire>
[[nodiscard]] constexpr T from_number(Wire number) {
  if constexpr (std::is_same_v<T, Instant>) {
    return Instant{Duration{number}};
  } else if constexpr (std::is_same_v<T, Capabilities>) {
    return Capabilities::from_bits(number);
  } else {
    return T{number};
  }
}

/// For who wants names and values only.
template <class F>
struct NameAndValue {
  F f;
  static constexpr bool at_end() { return false; }
  template <class T, class Description>
  void operator()(const char* name, T& value, Description /*description*/) {
    f(std::string_view{name}, value);
  }
};
/// Calls f(name, member) for each field of a described struct, which may be const.
template <class T, class F>
void for_each_field(T& made, F f) {
  fields(made, NameAndValue<F>{f});
}

/// A union of the IDL is a std::variant or derived from one: this one.
template <class... Branches>
std::variant<Branches...> variant_of(const std::variant<Branches...>& value);
template <class T>
using VariantOf = decltype(variant_of(std::declval<const T&>()));
template <class T>
concept Union = requires(const T& value) {
  variant_of(value);
};

/// Calls f.template operator()<Alternative>() for the i-th type of a variant. Precondition: i is
/// less than their number.
template <Union Variant, class F>
void with_alternative(std::size_t i, F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const bool found =
        ((i == I &&
          (f.template operator()<std::variant_alternative_t<I, VariantOf<Variant>>>(), true)) ||
         ...);
    static_cast<void>(found);
  }
  (std::make_index_sequence<std::variant_size_v<VariantOf<Variant>>>{});
}

}  // namespace skein::codec
