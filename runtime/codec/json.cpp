// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/json.hpp"

#include "skein/codec/codec.hpp"
#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/idl/formation_fields.hpp"
#include "skein/idl/mission_fields.hpp"

namespace skein::codec {

std::string json_of(const mission::Message& message) {
  return std::visit([](const auto& m) { return json_text(JsonWriter::of(m)); }, message);
}

}  // namespace skein::codec
