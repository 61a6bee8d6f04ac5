// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace skein::schemas {

/// What the bytes hold, as "{vehicle: 1, points: [{x_m: 0.5}], text: \"no\"}": `bytes` are XCDR1 in
/// little endian with its header of 4 bytes, `schema` is the text of a Schema. Numbers are the
/// shortest that read back the same; enumerators have their names. Where the bytes end too soon it
/// ends with "...".
[[nodiscard]] std::string text_of(std::string_view schema, std::span<const std::uint8_t> bytes);

}  // namespace skein::schemas
