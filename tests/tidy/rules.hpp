// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// The rules of the tree that no compiler checks (docs/architecture.md, docs/scope.md).
namespace skein::tidy {

struct File {
  std::string path;  ///< from the root of the repository, with '/'
  std::string text;
};

struct Finding {
  std::string path;
  std::size_t line = 0;  ///< from 1
  std::string rule;      ///< its name, one word
  std::string message;   ///< what is wrong, and what to do instead
};

/// Every breach of a rule in the files, in their order. The rule of files without a target needs
/// the CMakeLists.txt among them.
[[nodiscard]] std::vector<Finding> check(const std::vector<File>& files);

}  // namespace skein::tidy
