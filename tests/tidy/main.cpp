// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "rules.hpp"

namespace {

namespace fs = std::filesystem;

bool is_text(const fs::path& path) {
  static const std::array<std::string, 16> extensions{
      ".cpp", ".hpp",  ".idl", ".cmake", ".txt", ".md",  ".yaml", ".json",
      ".sh",  ".html", ".css", ".js",    ".ts",  ".csv", ".svg",  ".py"};
  if (path.filename() == "dev" || path.filename() == "run") return true;
  return std::find(extensions.begin(), extensions.end(), path.extension().string()) !=
         extensions.end();
}

std::vector<skein::tidy::File> read_tree(const fs::path& root) {
  static const std::array<std::string, 4> not_ours{".git", "build", "runs", "node_modules"};
  std::vector<skein::tidy::File> files;
  for (fs::recursive_directory_iterator it{root}, end; it != end; ++it) {
    const std::string name = it->path().filename().string();
    if (it->is_directory() && std::find(not_ours.begin(), not_ours.end(), name) != not_ours.end()) {
      it.disable_recursion_pending();
    } else if (it->is_regular_file() && is_text(it->path())) {
      std::ifstream in{it->path(), std::ios::binary};
      files.push_back({it->path().lexically_relative(root).generic_string(),
                       {std::istreambuf_iterator<char>{in}, {}}});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  const fs::path root = argc == 2 ? argv[1] : "";
  if (!fs::exists(root / "CMakeLists.txt")) {
    std::cerr << "usage: skein-tidy FOLDER, the root of the repository\n";
    return 2;
  }
  const auto files = read_tree(root);
  const auto findings = skein::tidy::check(files);
  for (const auto& f : findings) {
    std::cout << f.path << ':' << f.line << ": " << f.message << " [" << f.rule << "]\n";
  }
  std::cout << files.size() << " files, " << findings.size() << " findings\n";
  return findings.empty() ? 0 : 1;
}
