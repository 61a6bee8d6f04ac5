// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "skein/domain/remote_id.hpp"
#include "skein/mavlink/remote_id.hpp"

/// What a vehicle says of itself by Remote ID, as messages; to nobody in particular.
namespace skein::mavlink {

/// `by_airframe` stands for a RemoteId::UaType of that name.
[[nodiscard]] OpenDroneIdBasicId basic_id_of(const RemoteId& id, RemoteId::UaType by_airframe);
[[nodiscard]] OpenDroneIdSelfId self_id_of(const RemoteId& id);
[[nodiscard]] OpenDroneIdOperatorId operator_id_of(const RemoteId& id);
/// The operator where `id` has him, or else where the vehicle took off; unknown while neither is.
[[nodiscard]] OpenDroneIdSystem system_of(const RemoteId& id, const std::optional<Wgs84>& take_off,
                                          std::int64_t unix_ns);

}  // namespace skein::mavlink
