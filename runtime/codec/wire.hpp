// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/mission/messages.hpp"
#include "skein/wire/formation.h"
#include "skein/wire/mission.h"

/// Between the messages of core and the generated types of idl/.
namespace skein::codec {

[[nodiscard]] wire::CoalitionMessage to_wire(const coalition::Message& m);
[[nodiscard]] wire::Telemetry to_wire(const mission::Telemetry& m);
[[nodiscard]] wire::AuthorisationRequest to_wire(const mission::AuthorisationRequest& m);
[[nodiscard]] wire::Authorisation to_wire(const mission::Authorisation& m);
[[nodiscard]] wire::Command to_wire(const mission::Command& m);
[[nodiscard]] wire::SiteReport to_wire(const mission::SiteReport& m);
[[nodiscard]] wire::HazardReport to_wire(const mission::HazardReport& m);
[[nodiscard]] wire::FormationChange to_wire(const formation::Change& m);
[[nodiscard]] wire::FormationStatus to_wire(const mission::FormationStatus& m);
[[nodiscard]] wire::PlanReport to_wire(const mission::PlanReport& m);
[[nodiscard]] wire::Health to_wire(const mission::Health& m);

/// Each sets `ok` to false, and is then of no use, where a field is out of its range.
[[nodiscard]] mission::Message from_wire(const wire::CoalitionMessage& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::Telemetry& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::AuthorisationRequest& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::Authorisation& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::Command& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::SiteReport& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::HazardReport& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::FormationChange& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::FormationStatus& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::PlanReport& w, bool& ok);
[[nodiscard]] mission::Message from_wire(const wire::Health& w, bool& ok);

}  // namespace skein::codec
