// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace skein::tidy {

/// Who includes or needs whom, by name.
using Graph = std::map<std::string, std::set<std::string>>;

/// Our files that a file of ours includes: every key is a path from the root, its text is without
/// comments. "skein/..." is looked for in each include folder, the rest beside the includer.
[[nodiscard]] Graph includes_of(const std::map<std::string, std::string>& code_of_path);

/// Cycles, each with its nodes in order and the first one again at its end; none where there is
/// none, and not always every one where some share nodes.
[[nodiscard]] std::vector<std::vector<std::string>> cycles_of(const Graph& graph);

}  // namespace skein::tidy
