// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <string>

namespace skein::command_line {

inline constexpr int kExitBadArguments = 2;

/// What is wrong, in a line: a word in a command's place is named, where CLI11 says only that there
/// is no command.
inline std::string refusal(const CLI::App* app, const CLI::Error& error) {
  const CLI::App* last = app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
  const auto words = app->remaining(true);
  const bool lacks = last->get_require_subcommand_min() > 0 && !words.empty();
  if (!lacks || words.front().starts_with('-')) return CLI::FailureMessage::simple(app, error);
  return words.front() + ": there is no such command; --help lists those that there are\n";
}

/// As CLI::Range, which takes what is no number: "nan" is neither below nor above anything.
inline CLI::Validator number_in(double least, double most) {
  const CLI::Range range{least, most};
  const auto refuse = [range](std::string& text) {
    double value = 0.0;
    const bool is_read = CLI::detail::lexical_cast(text, value);
    return is_read && std::isnan(value) ? text + " is not a number" : range(text);
  };
  return CLI::Validator{refuse, range.get_description()};
}

/// Reads the program's arguments. If it is to end with that, its exit status: 0 after --help or
/// --version, else kExitBadArguments, and what is wrong was told.
inline std::optional<int> read(CLI::App& app, int argc, char** argv) {
  app.failure_message(refusal);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitBadArguments;
  }
  return std::nullopt;
}

}  // namespace skein::command_line
