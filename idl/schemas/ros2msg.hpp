// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "idl.hpp"
#include "skein/base/result.hpp"

namespace skein::schemas {

/// As Schema of schemas.hpp, while it is being made.
struct MadeSchema {
  std::string type;
  std::optional<std::uint32_t> kind;
  std::string branch;
  std::string name;
  std::string text;
};

/// One for each struct, or for each branch of one that has a union. A union may be the last member
/// only. Definitions of what a struct is made of follow it, each after a line of 80 '=' and
/// "MSG: skein/Name" (MCAP's "ros2msg" encoding). Fails with the name of what has no such schema.
[[nodiscard]] Result<std::vector<MadeSchema>> ros2msg_schemas(const Definitions& definitions);

/// The C++ source that defines all() and find().
[[nodiscard]] std::string cpp_source(const std::vector<MadeSchema>& schemas);

}  // namespace skein::schemas
