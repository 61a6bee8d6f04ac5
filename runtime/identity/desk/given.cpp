// SPDX-License-Identifier: Apache-2.0
#include "skein/identity_desk/given.hpp"

#include <chrono>
#include <fstream>
#include <iostream>

namespace skein::identity_desk {
namespace {

constexpr std::size_t kBytesMax = 4U << 20U;

/// None where there is more than that.
Result<std::vector<std::string>> lines_of(std::istream& stream, const std::string& name) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t bytes = 0;
  char c = 0;
  const auto end_line = [&] {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (!line.empty()) lines.push_back(line);
    line.clear();
  };
  while (stream.get(c)) {
    if (++bytes > kBytesMax) return Error{name + ": is longer than 4 MB"};
    if (c == '\n') {
      end_line();
    } else {
      line += c;
    }
  }
  end_line();
  if (lines.empty()) return Error{name + ": nothing is in it"};
  return lines;
}

}  // namespace

Result<std::vector<std::string>> given_lines(const std::string& argument, std::string_view prefix) {
  if (argument.starts_with(prefix)) return std::vector{argument};
  if (argument == "-") return lines_of(std::cin, name_of_given(argument, prefix));
  std::ifstream file{argument};
  if (!file) {
    return Error{std::string{"'"}
                     .append(argument)
                     .append("' is no file that can be read, nor does it begin with ")
                     .append(prefix)};
  }
  return lines_of(file, argument);
}

std::string name_of_given(const std::string& argument, std::string_view prefix) {
  if (argument.starts_with(prefix)) return "the line given";
  return argument == "-" ? "standard input" : argument;
}

Result<identity::Membership> given_membership(const std::string& argument) {
  const auto lines = given_lines(argument, "SKEIN-");
  if (!lines) return lines.error();
  if (lines->size() != 1) {
    return Error{"a membership is one line, and here are " + std::to_string(lines->size())};
  }
  auto membership = identity::membership_from_text(lines->front());
  if (!membership) {
    return Error{name_of_given(argument, "SKEIN-") + ": " + membership.error().message +
                 "; wanted is what 'skein-ground mission enrol' answered to this node's request"};
  }
  return membership;
}

std::int64_t now_unix_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace skein::identity_desk
