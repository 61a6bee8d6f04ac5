// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace skein::tidy {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Where the piece that starts at `from` ends (one past it): a comment or a literal.
std::size_t end_of_line(std::string_view text, std::size_t from) {
  return std::min(text.find('\n', from), text.size());
}
std::size_t end_after(std::string_view text, std::string_view closing, std::size_t from) {
  const std::size_t at = text.find(closing, from);
  return at == std::string_view::npos ? text.size() : at + closing.size();
}
std::size_t end_of_quoted(std::string_view text, std::size_t from) {
  const char quote = text[from];
  std::size_t i = from + 1;
  while (i < text.size() && text[i] != quote && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
  return std::min(i + 1, text.size());
}
std::size_t end_of_raw_string(std::string_view text, std::size_t quote) {
  const std::size_t open = text.find('(', quote);
  if (open == std::string_view::npos) return text.size();
  const std::string closing = ")" + std::string{text.substr(quote + 1, open - quote - 1)} + "\"";
  return end_after(text, closing, open);
}

}  // namespace

std::string without_comments(std::string_view cpp, Literals literals) {
  std::string out{cpp};
  const auto blank = [&out](std::size_t from, std::size_t to) {
    std::replace_if(
        out.begin() + static_cast<std::ptrdiff_t>(from),
        out.begin() + static_cast<std::ptrdiff_t>(to), [](char c) { return c != '\n'; }, ' ');
  };
  std::size_t i = 0;
  while (i < cpp.size()) {
    const char before = i > 0 ? cpp[i - 1] : ' ';
    std::size_t end = i + 1;
    if (cpp.substr(i, 2) == "//") {
      end = end_of_line(cpp, i);
      blank(i, end);
    } else if (cpp.substr(i, 2) == "/*") {
      end = end_after(cpp, "*/", i + 2);
      blank(i, end);
    } else if (cpp[i] == '"' || (cpp[i] == '\'' && !is_word(before))) {
      end = cpp[i] == '"' && before == 'R' ? end_of_raw_string(cpp, i) : end_of_quoted(cpp, i);
      if (literals == Literals::blank) blank(i, end);
    }
    i = end;
  }
  return out;
}

std::string without_cmake_comments(std::string_view cmake) {
  std::string out;
  std::istringstream in{std::string{cmake}};
  for (std::string line; std::getline(in, line);) out += line.substr(0, line.find('#')) + "\n";
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string words_of(std::string_view identifier) {
  std::string words;
  char before = '_';
  for (const char c : identifier) {
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
    const bool starts = upper && std::islower(static_cast<unsigned char>(before)) != 0;
    if ((starts || c == '_') && !words.empty() && words.back() != ' ') words += ' ';
    if (c != '_') words += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    before = c;
  }
  return words;
}

}  // namespace skein::tidy
