// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <tuple>

#include "skein/mavlink/command.hpp"
#include "skein/mavlink/mission.hpp"
#include "skein/mavlink/parameter.hpp"
#include "skein/mavlink/remote_id.hpp"
#include "skein/mavlink/sensors.hpp"
#include "skein/mavlink/vehicle.hpp"

namespace skein::mavlink {

/// The messages in use, by id: this list is the table. A message that is not here is skipped and
/// counted by the parser.
using Messages =
    std::tuple<Heartbeat, SysStatus, SystemTime, ParamRequestRead, ParamRequestList, ParamValue,
               ParamSet, GpsRawInt, RawImu, ScaledPressure, Attitude, LocalPositionNed,
               GlobalPositionInt, ServoOutputRaw, MissionRequest, MissionSetCurrent, MissionCurrent,
               MissionRequestList, MissionCount, MissionClearAll, MissionItemReached, MissionAck,
               GpsGlobalOrigin, MissionRequestInt, NavControllerOutput, RcChannels, MissionItemInt,
               VfrHud, CommandInt, CommandLong, CommandAck, SetAttitudeTarget, AttitudeTarget,
               SetPositionTargetLocalNed, PositionTargetLocalNed, SetPositionTargetGlobalInt,
               PositionTargetGlobalInt, SimState, Timesync, ScaledImu2, PowerStatus, ScaledImu3,
               TerrainRequest, TerrainReport, ScaledPressure2, BatteryStatus, AutopilotVersion,
               Meminfo, Ahrs, Simstate, Wind, Ahrs2, EkfStatusReport, Vibration, HomePosition,
               MessageInterval, ExtendedSysState, Statustext, Airspeed, AoaSsa, EscTelemetry1To4,
               OpenDroneIdBasicId, OpenDroneIdLocation, OpenDroneIdSelfId, OpenDroneIdSystem,
               OpenDroneIdOperatorId, OpenDroneIdArmStatus>;

/// What is known of them, by id.
[[nodiscard]] std::span<const MessageInfo> messages();
/// Null if it is not in use.
[[nodiscard]] const MessageInfo* find_message(std::uint32_t id);

}  // namespace skein::mavlink
