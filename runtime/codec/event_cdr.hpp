// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastcdr/Cdr.h>

#include "skein/mission/messages.hpp"

/// Events as CDR, field by field (event_fields.hpp), as idl/events.idl has them.
namespace skein::codec {

/// All after the encapsulation, version first. Texts are cut.
void write(eprosima::fastcdr::Cdr& cdr, const mission::MissionEvent& event);
/// All after the version. Sets `ok` to false where a field is out of its range; throws Fast CDR's
/// exceptions where the bytes end too soon.
[[nodiscard]] mission::MissionEvent read_event(eprosima::fastcdr::Cdr& cdr, bool& ok);

}  // namespace skein::codec
