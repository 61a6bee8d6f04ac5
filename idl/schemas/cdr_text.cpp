// SPDX-License-Identifier: Apache-2.0
#include "skein/schemas/cdr_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <map>
#include <utility>
#include <vector>

namespace skein::schemas {
namespace {

constexpr std::size_t kHeader = 4;
constexpr std::string_view kSeparator = "MSG: skein/";

struct Field {
  std::string type;  ///< without bounds
  std::string name;
  enum class Many { one, sequence, array } many = Many::one;
  std::uint32_t count = 1;                     ///< of an array
  std::map<std::uint32_t, std::string> names;  ///< of an enumeration
};
using Fields = std::vector<Field>;

std::uint32_t number_in(std::string_view text) {
  std::uint32_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// The definitions of a schema's text; that of the whole has no name.
std::map<std::string, Fields> fields_of(std::string_view schema) {
  std::map<std::string, Fields> all;
  Fields* fields = &all[""];
  std::map<std::uint32_t, std::string> constants;
  while (!schema.empty()) {
    std::string_view line = schema.substr(0, schema.find('\n'));
    schema.remove_prefix(std::min(line.size() + 1, schema.size()));
    if (line.empty() || line.front() == '=') continue;
    if (line.starts_with(kSeparator)) {
      fields = &all[std::string{line.substr(kSeparator.size())}];
      continue;
    }
    const std::size_t space = line.find(' ');
    std::string_view type = line.substr(0, space);
    const std::string_view name = line.substr(std::min(space + 1, line.size()));
    if (const auto equals = name.find('='); equals != std::string_view::npos) {
      constants[number_in(name.substr(equals + 1))] = name.substr(0, equals);
      continue;
    }
    Field field;
    field.name = name;
    field.names = std::exchange(constants, {});
    if (const auto bracket = type.find('['); bracket != std::string_view::npos) {
      const std::string_view many = type.substr(bracket + 1);
      const bool is_array = !many.starts_with("<=") && !many.starts_with(']');
      field.many = is_array ? Field::Many::array : Field::Many::sequence;
      if (is_array) field.count = number_in(many);
      type = type.substr(0, bracket);
    }
    field.type = type.substr(0, type.find("<="));
    fields->push_back(std::move(field));
  }
  return all;
}

class Printer {
 public:
  Printer(std::string_view schema, std::span<const std::uint8_t> bytes)
      : definitions_{fields_of(schema)}, bytes_{bytes.subspan(std::min(kHeader, bytes.size()))} {}

  std::string run() {
    message(definitions_.at(""));
    if (cut_) text_ += " ...";
    return std::move(text_);
  }

 private:
  void message(const Fields& fields) {
    text_ += '{';
    bool first = true;
    for (const Field& field : fields) {
      if (cut_) return;
      text_ += (first ? "" : ", ") + field.name + ": ";
      first = false;
      values(field);
    }
    text_ += '}';
  }

  void values(const Field& field) {
    if (field.many == Field::Many::one) return value(field);
    const auto count =
        field.many == Field::Many::array ? field.count : static_cast<std::uint32_t>(integer(4));
    text_ += '[';
    for (std::uint32_t i = 0; i < count && !cut_; ++i) {
      if (i > 0) text_ += ", ";
      value(field);
    }
    text_ += ']';
  }

  void value(const Field& field) {
    if (const auto part = definitions_.find(field.type); part != definitions_.end()) {
      return message(part->second);
    }
    if (field.type == "string") return text();
    if (field.type == "float64") return number(std::bit_cast<double>(integer(8)));
    if (field.type == "float32") {
      return number(std::bit_cast<float>(static_cast<std::uint32_t>(integer(4))));
    }
    if (field.type == "bool") {
      text_ += integer(1) != 0 ? "true" : "false";
      return;
    }
    const bool is_signed = field.type.starts_with("int");
    const std::uint32_t bits = number_in(std::string_view{field.type}.substr(is_signed ? 3 : 4));
    const std::uint64_t raw = integer(bits / 8);
    if (const auto name = field.names.find(static_cast<std::uint32_t>(raw));
        name != field.names.end()) {
      text_ += name->second;
    } else if (is_signed) {
      const auto spare = static_cast<int>(64 - bits);
      number(static_cast<std::int64_t>(raw << spare) >> spare);
    } else {
      number(raw);
    }
  }

  template <class Number>
  void number(Number value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text_.append(digits.data(), end);
  }

  void text() {
    const auto size = static_cast<std::size_t>(integer(4));
    text_ += '"';
    for (std::size_t i = 0; i < size && !cut_; ++i) {
      const auto c = static_cast<char>(integer(1));
      if (i + 1 == size) break;  // the zero at the end
      if (c == '"' || c == '\\') text_ += '\\';
      text_ += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    text_ += '"';
  }

  std::uint64_t integer(std::size_t size) {
    if (size > 0) at_ = (at_ + size - 1) / size * size;
    if (at_ + size > bytes_.size()) {
      cut_ = true;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes_[at_ + i]} << (8U * i);
    at_ += size;
    return value;
  }

  std::map<std::string, Fields> definitions_;
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;  ///< after the header; alignment counts from there
  bool cut_ = false;
  std::string text_;
};

}  // namespace

std::string text_of(std::string_view schema, std::span<const std::uint8_t> bytes) {
  return Printer{schema, bytes}.run();
}

}  // namespace skein::schemas
