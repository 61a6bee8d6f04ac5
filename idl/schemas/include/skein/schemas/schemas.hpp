// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

/// The structs of idl/ in the language of ROS 2's .msg files. The CDR bytes of both are the same:
/// an enumeration is a uint32 with constants, and a struct that ends in a union, which .msg files
/// do not have, is one schema for each of its branches, with the discriminator as a field.
namespace skein::schemas {

struct Schema {
  std::string_view type;              ///< in idl/: "skein::wire::Telemetry"
  std::optional<std::uint32_t> kind;  ///< the discriminator, where this is one branch of a union
  std::string_view branch;            ///< its name: "lease_renewal"; empty without a union
  std::string_view name;              ///< "skein/msg/Telemetry"
  std::string_view text;              ///< with the definitions of all that it is made of
};

/// By type and kind; the same for the life of the program.
[[nodiscard]] std::span<const Schema> all();

/// That of the type, or of that branch of it; null where there is none.
[[nodiscard]] const Schema* find(std::string_view type,
                                 std::optional<std::uint32_t> kind = std::nullopt);

}  // namespace skein::schemas
