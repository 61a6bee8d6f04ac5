// SPDX-License-Identifier: Apache-2.0
#include "processes.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace skein::isolation {

std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator{"/proc", failed}) {
    const std::string name = entry.path().filename();
    if (!std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    const auto process = static_cast<pid_t>(std::stol(name));
    const auto status = status_of(process);
    const auto its = status.find("PPid");
    if (its == status.end() || its->second != std::to_string(parent)) continue;
    if (!status.at("State").starts_with("Z")) children.push_back(process);
  }
  return children;
}

std::map<std::string, std::string> status_of(pid_t process) {
  std::ifstream file{"/proc/" + std::to_string(process) + "/status"};
  std::map<std::string, std::string> fields;
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(':');
    const auto value = line.find_first_not_of(" \t", colon + 1);
    if (colon != std::string::npos && value != std::string::npos) {
      fields.emplace(line.substr(0, colon), line.substr(value));
    }
  }
  return fields;
}

std::uint64_t resident_bytes(pid_t process) {
  const auto status = status_of(process);
  const auto field = status.find("VmRSS");
  return field == status.end() ? 0 : std::stoull(field->second) * 1024;
}

}  // namespace skein::isolation
