// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "skein/codec/describe.hpp"
#include "skein/codec/json_text.hpp"

/// Described types as JSON. Integers of 64 bits are strings, since a double cannot hold them; what
/// is not there is null; a union is its kind and its body.
namespace skein::codec {

class JsonWriter {
 public:
  template <class T>
  [[nodiscard]] static Json of(const T& value) {
    JsonWriter writer;
    fields(value, writer);
    return std::move(writer.json_);
  }
  template <Union T>
  [[nodiscard]] static Json of(const T& value) {
    return std::visit(
        []<class Branch>(const Branch& branch) {
          return Json{{"kind", Type<Branch>::kName}, {"body", of(branch)}};
        },
        value);
  }

  static constexpr bool at_end() { return false; }

  template <class T, class Description>
  void operator()(const char* name, const T& value, Description description) {
    json_[name] = element(value, description);
  }

 private:
  static Json element(bool value, Flag) { return value; }
  static Json element(double value, Real) { return value; }
  static Json element(const std::string& value, Text) { return value; }
  template <class E>
  static Json element(E value, Name) {
    return to_string(value);
  }
  template <class T, class Wire>
  static Json element(const T& value, Whole<Wire>) {
    const auto number = static_cast<Wire>(number_of(value));
    if constexpr (sizeof number == 8) return std::to_string(number);
    return number;
  }
  template <class T>
  static Json element(const T& value, Part) {
    return of(value);
  }
  template <class T>
  static Json element(const std::shared_ptr<const T>& value, Kept) {
    return of(*value);
  }
  template <class T>
  static Json element(const T& value, Choice) {
    return of(value);
  }
  template <class T, class Element>
  static Json element(const std::optional<T>& value, Maybe<Element> maybe) {
    return value ? element(*value, maybe.element) : Json(nullptr);
  }
  template <class Range, class Element>
  static Json element(const Range& values, Many<Element> many) {
    Json all = Json::array();
    for (const auto& value : values) all.push_back(element(value, many.element));
    return all;
  }

  Json json_ = Json::object();
};

}  // namespace skein::codec
