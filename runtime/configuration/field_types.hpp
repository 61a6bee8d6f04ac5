// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "field_visitor.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

/// The values that keys stand for, and their units inside and outside.
namespace skein::configuration {

inline constexpr Range kMetres{-1e6, 1e6, "m"};
inline constexpr Range kSeconds{0.0, 1e6, "s"};
inline constexpr std::size_t kListMax = 256;
inline constexpr std::size_t kVehiclesMax = 1000;           ///< of a fleet
inline constexpr std::size_t kNodesMax = kVehiclesMax + 1;  ///< and the ground station

void seconds(FieldVisitor& v, const Field& field, const Range& range, Duration& value);
void seconds(FieldVisitor& v, const Field& field, const Range& range, Instant& value);
void milliseconds(FieldVisitor& v, const Field& field, const Range& range, Duration& value);
/// Compass degrees outside, radians from east inside.
void compass(FieldVisitor& v, const Field& field, double& heading_rad);
void compass(FieldVisitor& v, const Field& field, std::optional<double>& heading_rad);
/// An angle that is no direction.
void angle(FieldVisitor& v, const Field& field, const Range& range, double& rad);

template <class T>
void whole(FieldVisitor& v, const Field& field, const Range& range, T& value) {
  auto shown = static_cast<std::int64_t>(value);  // a number: NOLINT(bugprone-signed-char-misuse)
  v.integer(field, range, shown);
  value = static_cast<T>(shown);
}
template <class T>
void whole(FieldVisitor& v, const Field& field, const Range& range, std::optional<T>& value) {
  std::optional<std::int64_t> shown;
  if (value) shown = static_cast<std::int64_t>(*value);
  v.integer(field, range, shown);
  value = shown ? std::optional<T>{static_cast<T>(*shown)} : std::nullopt;
}
/// `first` is 1, or 0 where the ground station may be meant.
template <class Tag>
void id(FieldVisitor& v, const Field& field, Id<Tag, std::uint16_t>& value, int first = 1) {
  whole(v, field, {static_cast<double>(first), 65535.0}, value.value);
}

template <class T, class Element>
List list_of(std::vector<T>& values, std::size_t size_max, Element element) {
  return {values.size(),
          size_max,
          [&values](std::size_t n) { values.resize(n); },
          [&values, element](FieldVisitor& v, std::size_t i) { element(v, values[i]); },
          "",
          {}};
}
/// A list of groups of keys, one group an element.
template <class T, class Group>
List groups_of(std::vector<T>& values, std::size_t size_max, Group group) {
  return list_of(values, size_max, [group](FieldVisitor& v, T& value) {
    v.section({}, [&group, &value](FieldVisitor& inner) { group(inner, value); });
  });
}
/// As groups_of, where no two elements may have the same id.
template <class T, class Group, class IdOf>
List unique_groups_of(std::vector<T>& values, std::size_t size_max, Group group,
                      std::string_view noun, IdOf id_of) {
  List list = groups_of(values, size_max, group);
  list.noun = noun;
  list.id_of = [&values, id_of](std::size_t i) { return std::uint32_t{id_of(values[i])}; };
  return list;
}
template <class Tag>
void ids(FieldVisitor& v, const Field& field, std::vector<Id<Tag, std::uint16_t>>& values,
         std::string_view noun, int first = 1) {
  using Element = Id<Tag, std::uint16_t>;
  List list = list_of(values, kNodesMax, [first](FieldVisitor& inner, Element& value) {
    id(inner, {}, value, first);
  });
  list.noun = noun;
  list.id_of = [&values](std::size_t i) { return std::uint32_t{values[i].value}; };
  v.list(field, list);
}

}  // namespace skein::configuration
