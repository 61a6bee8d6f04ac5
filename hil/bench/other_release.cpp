// SPDX-License-Identifier: Apache-2.0
#include "other_release.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>

#include "skein/base/contains.hpp"
#include "skein/hil/child_process.hpp"

namespace skein::hil {
namespace {

constexpr auto kCheckWithin = std::chrono::seconds{10};
/// A group that is unknown may have hidden others; no file is as deep.
constexpr int kRounds = 20;
constexpr const char* kUnknown = "is no key of this group";

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in{file};
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::size_t indent_of(const std::string& line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

/// Of "FILE:LINE: KEY: is no key of this group, ...".
struct Unknown {
  std::vector<int> lines;
  std::vector<std::string> keys;
};
Unknown unknown_in(const std::string& said, const std::string& file) {
  Unknown found;
  std::istringstream lines{said};
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(file + ":");
    if (at == std::string::npos || line.find(kUnknown) == std::string::npos) continue;
    const std::string rest = line.substr(at + file.size() + 1);
    int number = 0;
    if (std::from_chars(rest.data(), rest.data() + rest.size(), number).ec != std::errc{}) continue;
    found.lines.push_back(number);
    const auto key = rest.find(": ");
    const auto end = key == std::string::npos ? key : rest.find(": ", key + 2);
    if (end != std::string::npos) found.keys.push_back(rest.substr(key + 2, end - key - 2));
  }
  return found;
}

}  // namespace

std::string without_keys(const std::string& yaml, const std::vector<int>& lines) {
  std::istringstream in{yaml};
  std::string kept;
  int number = 0;
  std::size_t deeper_than = std::string::npos;  // what is left out goes on so far
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (deeper_than != std::string::npos && indent_of(line) > deeper_than) continue;
    deeper_than = contains(lines, number) ? indent_of(line) : std::string::npos;
    if (deeper_than == std::string::npos) kept += line + "\n";
  }
  return kept;
}

Result<std::vector<std::string>> fit_configuration(const std::filesystem::path& file,
                                                   const std::filesystem::path& program,
                                                   const std::filesystem::path& log) {
  std::vector<std::string> left_out;
  for (int round = 0; round < kRounds; ++round) {
    std::ofstream{log, std::ios::trunc}.close();
    auto check = ChildProcess::start(
        {program.string(), "--config", file.string(), "--check-config"}, log, {});
    if (!check) return check.error();
    if (check->wait(kCheckWithin) && check->clean()) return left_out;
    const std::string said = text_of(log);
    const Unknown unknown = unknown_in(said, file.string());
    if (unknown.lines.empty()) {
      return Error{"the other release cannot fly with " + file.string() + ": " + said};
    }
    const std::string fitted = without_keys(text_of(file), unknown.lines);
    std::ofstream{file} << fitted;
    left_out.insert(left_out.end(), unknown.keys.begin(), unknown.keys.end());
  }
  return Error{"the other release goes on to refuse " + file.string()};
}

Result<std::string> write_configuration(configuration::VehicleConfig config,
                                        const std::filesystem::path& file,
                                        const std::filesystem::path* other) {
  if (other != nullptr) config.network.transport_plugin.clear();
  std::ofstream{file} << configuration::to_yaml(config);
  if (other == nullptr) return std::string{};
  std::filesystem::path log = file;
  log += ".fitted.log";
  const auto left_out = fit_configuration(file, *other / "skein-onboard", log);
  if (!left_out) return left_out.error();
  return fmt::format("{}", fmt::join(*left_out, ", "));
}

}  // namespace skein::hil
