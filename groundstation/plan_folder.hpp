// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"

/// The folder that a plan is written into.
namespace skein::groundstation {

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] inline Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return Error{folder.string() + ": cannot be made: " + failed.message()};
  return {};
}

/// Gives the files' names.
[[nodiscard]] inline Result<std::vector<std::string>> write_files(
    const std::filesystem::path& folder, const NamedTexts& files) {
  std::vector<std::string> names;
  for (const auto& [name, text] : files) {
    std::ofstream out{folder / name, std::ios::binary};
    out << text;
    out.close();
    if (!out) {
      return Error{(folder / name).string() + ": cannot be written; check the folder and the disk"};
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace skein::groundstation
