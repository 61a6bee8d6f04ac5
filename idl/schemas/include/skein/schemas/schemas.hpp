// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

/// The messages and records of idl/ in the language of ROS 2's .msg files. The CDR bytes of both
/// are the same: an enumeration is a uint32 with constants; a message that ends in a union, which
/// .msg files do not have, is one schema for each of its branches, with the discriminator as a
/// field; the version of the whole and the sizes of parts stand as fields.
namespace skein::schemas {

struct Schema {
  std::string_view type;    ///< as tools know it: "Telemetry"
  std::int32_t kind;        ///< the discriminator, where this is one branch of a union; else -1
  std::string_view branch;  ///< its name: "lease_renewal"; empty without a union
  std::string_view name;    ///< "skein/msg/Telemetry"
  std::uint16_t version;
  std::string_view text;  ///< with the definitions of all that it is made of
};

/// By type and kind; the same for the life of the program.
[[nodiscard]] std::span<const Schema> all();

}  // namespace skein::schemas
