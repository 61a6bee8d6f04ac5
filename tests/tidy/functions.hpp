// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace skein::tidy {

struct Function {
  std::string name;       ///< as it is written before its parameters, "Agent::poll"
  std::size_t first = 0;  ///< line of the first word of its declaration, from 1
  std::size_t last = 0;   ///< line of its closing brace
};

/// The functions that C++ text defines in namespaces and classes, in their order; a lambda belongs
/// to the function around it, or is one if a variable of a namespace or class is made from it. The
/// text is without comments and literals (without_comments) and has balanced braces.
[[nodiscard]] std::vector<Function> functions_of(std::string_view code);

}  // namespace skein::tidy
