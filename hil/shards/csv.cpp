// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/csv.hpp"

#include <cerrno>
#include <system_error>

namespace skein::shards {

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (&field != &fields.front()) line += ',';
    if (field.find_first_of(",\"") == std::string::npos) {
      line += field;
      continue;
    }
    line += '"';
    for (const char c : field) line += c == '"' ? "\"\"" : std::string{c};
    line += '"';
  }
  return line + "\n";
}

std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string field;
  for (const std::string& text : texts) {
    if (&text != &texts.front()) field += '|';
    for (const char c : text) {
      if (c == '|' || c == '\\') field += '\\';
      field += c == '\n' ? "\\n" : c == '\r' ? "\\r" : std::string{c};
    }
  }
  return field;
}

std::vector<std::string> parted(std::string_view field) {
  std::vector<std::string> texts{""};
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] == '|') {
      texts.emplace_back();
    } else if (field[i] == '\\' && i + 1 < field.size()) {
      const char c = field[++i];
      texts.back() += c == 'n' ? '\n' : c == 'r' ? '\r' : c;
    } else {
      texts.back() += field[i];
    }
  }
  return texts;
}

Error not_written(const std::string& file) {
  return {file + ": cannot be written: " + std::generic_category().message(errno) +
          "; make room or name another folder with --out"};
}

}  // namespace skein::shards
