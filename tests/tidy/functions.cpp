// SPDX-License-Identifier: Apache-2.0
#include "functions.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace skein::tidy {
namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Directives, with their continued lines, as spaces.
std::string without_directives(std::string_view code) {
  std::string out{code};
  bool directive = false;
  bool begins = true;  // nothing but spaces in this line so far
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] == '\n') {
      directive = directive && i > 0 && code[i - 1] == '\\';
      begins = true;
      continue;
    }
    directive = directive || (begins && out[i] == '#');
    begins = begins && is_space(out[i]);
    if (directive) out[i] = ' ';
  }
  return out;
}

/// One past the bracket that closes the one at `open`.
std::size_t end_of_bracket(std::string_view code, std::size_t open) {
  const char opening = code[open];
  const char closing = opening == '(' ? ')' : opening == '{' ? '}' : '>';
  std::size_t depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    if (code[i] == opening) ++depth;
    if (code[i] == closing && --depth == 0) return i + 1;
  }
  return code.size();
}

enum class Brace { scope, function, value };

/// A declaration before a brace: without what may hold words that would mislead.
std::string plain_head(std::string_view head) {
  static const std::regex attribute{
      R"(\[\[[^\]]*\]\]|\balignas\s*\([^)]*\)|\b__attribute__\s*\(\([^)]*\)\))"};
  static const std::regex operator_sign{R"(\boperator\s*(\(\s*\)|\[\s*\]|[^\w\s(]+))"};
  std::string plain = std::regex_replace(std::string{head}, attribute, "");
  plain = std::regex_replace(plain, operator_sign, "operator_");
  static const std::regex begins_with_bracket{R"(^\s*(template\s*<|requires\s*\())"};
  std::smatch match;
  while (std::regex_search(plain, match, begins_with_bracket)) {
    plain.erase(0, end_of_bracket(plain, static_cast<std::size_t>(match.length()) - 1));
  }
  return plain;
}

/// The text with the contents of its parentheses and braces left out.
std::string top_level(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] != '(' && text[i] != '{') continue;
    i = end_of_bracket(text, i) - 1;
    if (i < text.size()) out += text[i];
  }
  return out;
}

Brace kind_of(std::string_view head) {
  static const std::regex scope{R"(^\s*(inline\s+)?namespace\b|^\s*extern\s*$)"};
  static const std::regex type{
      R"(^\s*((typedef|static|inline|constexpr|const|export)\s+)*(class|struct|union|enum)\b[^()=]*$)"};
  static const std::regex lambda{R"(=\s*\[[^\]]*\]\s*([(<][^]*|mutable\s*)?$)"};
  static const std::regex initialisers{R"(\)[^:]*[^:]:[^:][^]*[\w>]\s*$)"};
  const std::string plain = top_level(plain_head(head));
  if (std::regex_search(plain, scope) || std::regex_search(plain, type)) return Brace::scope;
  if (plain.find('=') != std::string::npos) {
    return std::regex_search(plain, lambda) ? Brace::function : Brace::value;
  }
  if (plain.find('(') == std::string::npos) return Brace::value;
  return std::regex_search(plain, initialisers) ? Brace::value : Brace::function;
}

std::string name_of(std::string_view head) {
  const std::string plain = plain_head(head);
  std::size_t end = std::min(plain.find_first_of("(="), plain.size());
  while (end > 0 && is_space(plain[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 &&
         (is_word(plain[begin - 1]) || plain[begin - 1] == ':' || plain[begin - 1] == '~'))
    --begin;
  return plain.substr(begin, end - begin);
}

}  // namespace

std::vector<Function> functions_of(std::string_view code) {
  const std::string text = without_directives(code);
  const auto lines_before = [&text](std::size_t end) {
    return static_cast<std::size_t>(std::count(text.data(), text.data() + end, '\n'));
  };
  std::vector<Function> found;
  std::size_t begin = 0;  // of the declaration that is being read
  std::size_t i = 0;
  while (i < text.size()) {
    if (begin == i && is_space(text[i])) {
      begin = ++i;
      continue;
    }
    const char c = text[i];
    if (c == '(') {
      i = end_of_bracket(text, i);
      continue;
    }
    const std::string_view head{text.data() + begin, i - begin};
    const bool label = c == ':' && (head == "public" || head == "private" || head == "protected");
    const Brace brace = c == '{' ? kind_of(head) : Brace::scope;
    if (c == '{' && brace != Brace::scope) {
      const std::size_t end = end_of_bracket(text, i);
      if (brace == Brace::function) {
        found.push_back({name_of(head), lines_before(begin) + 1, lines_before(end) + 1});
        begin = end;
      }
      i = end;
      continue;
    }
    ++i;
    if (c == '{' || c == '}' || c == ';' || label) begin = i;
  }
  return found;
}

}  // namespace skein::tidy
