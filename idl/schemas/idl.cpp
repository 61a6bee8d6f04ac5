// SPDX-License-Identifier: Apache-2.0
#include "idl.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

namespace skein::schemas {
namespace {

struct Token {
  std::string text;
  std::size_t line = 1;
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Words, numbers, "::" and single signs, without comments and preprocessor lines.
std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  std::size_t line = 1;
  std::size_t i = 0;
  const auto skip_to = [&](std::string_view end) {
    const std::size_t found = std::min(text.find(end, i), text.size());
    line += static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                                text.begin() + static_cast<std::ptrdiff_t>(found),
                                                '\n'));
    i = found;
  };
  while (i < text.size()) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      ++i;
    } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
    } else if (c == '#' || text.substr(i, 2) == "//") {
      skip_to("\n");
    } else if (text.substr(i, 2) == "/*") {
      skip_to("*/");
      i = std::min(i + 2, text.size());
    } else if (is_word(c)) {
      const std::size_t begin = i;
      while (i < text.size() && is_word(text[i])) ++i;
      tokens.push_back({std::string{text.substr(begin, i - begin)}, line});
    } else {
      const std::size_t size = text.substr(i, 2) == "::" ? 2 : 1;
      tokens.push_back({std::string{text.substr(i, size)}, line});
      i += size;
    }
  }
  tokens.push_back({"", line});
  return tokens;
}

/// Goes down the grammar; the first mistake ends everything and is kept.
class Parser {
 public:
  Parser(std::vector<Token> tokens, std::string file, Definitions& into)
      : tokens_{std::move(tokens)}, file_{std::move(file)}, into_{into} {}

  Result<void> run() {
    while (!failure_ && !peek().empty()) definition();
    if (failure_) return Error{*failure_};
    return {};
  }

 private:
  [[nodiscard]] const std::string& peek() const { return tokens_[at_].text; }
  std::string take() {
    std::string text = tokens_[at_].text;
    if (at_ + 1 < tokens_.size()) ++at_;
    return text;
  }
  bool take_if(std::string_view text) {
    if (peek() != text) return false;
    take();
    return true;
  }
  void expect(std::string_view text) {
    if (!take_if(text)) fail("expected '" + std::string{text} + "' before '" + peek() + "'");
  }
  void fail(const std::string& reason) {
    if (failure_) return;
    failure_ = file_ + ":" + std::to_string(tokens_[at_].line) + ": " + reason;
    at_ = tokens_.size() - 1;
  }
  std::string word() {
    if (peek().empty() || !is_word(peek().front())) fail("expected a name before '" + peek() + "'");
    return take();
  }
  /// A name that nothing else has.
  std::string new_name() {
    std::string name = word();
    if (into_.find_struct(name) != nullptr || into_.enums.contains(name) ||
        into_.unions.contains(name)) {
      fail("a second '" + name + "'; schemas do not tell modules apart, choose another name");
    }
    return name;
  }

  void definition() {
    const std::string what = word();
    if (what == "module") {
      modules_.push_back(word());
      expect("{");
      while (!failure_ && peek() != "}" && !peek().empty()) definition();
      expect("}");
      if (!modules_.empty()) modules_.pop_back();
    } else if (what == "const") {
      (void)element();
      const std::string name = word();
      expect("=");
      into_.constants[name] = number();
    } else if (what == "struct") {
      structure();
    } else if (what == "enum") {
      enumeration();
    } else if (what == "union") {
      discriminated();
    } else {
      fail("'" + what + "' is not of the IDL that schemas are made from");
    }
    expect(";");
  }

  void structure() {
    Struct made;
    made.name = new_name();
    for (const std::string& module : modules_) made.full_name += module + "::";
    made.full_name += made.name;
    expect("{");
    while (!failure_ && peek() != "}") {
      made.members.push_back(member());
      expect(";");
    }
    expect("}");
    into_.structs.push_back(std::move(made));
  }

  void enumeration() {
    Enum made;
    made.name = new_name();
    expect("{");
    do {
      made.values.push_back(word());
    } while (!failure_ && take_if(","));
    expect("}");
    into_.enums[made.name] = made;
  }

  void discriminated() {
    Union made;
    made.name = new_name();
    expect("switch");
    expect("(");
    made.discriminator = scoped_name();
    if (!into_.enums.contains(made.discriminator)) fail("a union must be over an enum");
    expect(")");
    expect("{");
    while (!failure_ && peek() != "}") {
      expect("case");
      Union::Branch branch;
      branch.label = scoped_name();
      expect(":");
      branch.member = member();
      expect(";");
      made.branches.push_back(std::move(branch));
    }
    expect("}");
    into_.unions[made.name] = made;
  }

  Member member() {
    Member made;
    if (take_if("sequence")) {
      made.is_sequence = true;
      expect("<");
      made.type = element();
      if (take_if(",")) made.sequence_bound = number();
      expect(">");
    } else {
      made.type = element();
    }
    made.name = word();
    if (take_if("[")) {
      made.array_size = number();
      expect("]");
      if (made.is_sequence) fail("an array of sequences has no schema");
    }
    return made;
  }

  ElementType element() {
    ElementType type;
    if (take_if("string")) {
      type.primitive = "string";
      if (take_if("<")) {
        type.bound = number();
        expect(">");
      }
      return type;
    }
    const bool is_unsigned = take_if("unsigned");
    std::string first = scoped_name();
    if (first == "long" && take_if("long")) first = "long long";
    static const std::map<std::string, std::string> signed_names{
        {"boolean", "bool"}, {"octet", "uint8"},   {"short", "int16"},    {"long", "int32"},
        {"char", "uint8"},   {"float", "float32"}, {"double", "float64"}, {"long long", "int64"}};
    if (const auto known = signed_names.find(first); known != signed_names.end()) {
      type.primitive = (is_unsigned ? "u" : "") + known->second;
      return type;
    }
    if (into_.find_struct(first) == nullptr && !into_.enums.contains(first) &&
        !into_.unions.contains(first)) {
      fail("'" + first + "' is not defined before it is used");
    }
    type.name = first;
    return type;
  }

  std::string scoped_name() {
    (void)take_if("::");
    std::string name = word();
    while (take_if("::")) name = word();
    return name;
  }

  std::uint64_t number() {
    const std::string text = scoped_name();
    if (const auto known = into_.constants.find(text); known != into_.constants.end()) {
      return known->second;
    }
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
      fail("'" + text + "' is neither a number nor a constant");
    }
    return value;
  }

  std::vector<Token> tokens_;
  std::string file_;
  Definitions& into_;
  std::size_t at_ = 0;
  std::vector<std::string> modules_;
  std::optional<std::string> failure_;
};

}  // namespace

const Struct* Definitions::find_struct(std::string_view name) const {
  const auto found = std::find_if(structs.begin(), structs.end(),
                                  [name](const Struct& s) { return s.name == name; });
  return found == structs.end() ? nullptr : &*found;
}

Result<void> parse(std::string_view text, const std::string& file, Definitions& into) {
  return Parser{tokens_of(text), file, into}.run();
}

}  // namespace skein::schemas
