// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::hil {

/// Where the recordings of the truth are, below the run's folder: as a run's, a folder a vehicle,
/// with tracks alone.
inline constexpr const char* kTruthFolder = "truth";

struct SimulatedAircraft {
  VehicleId vehicle;
  std::uint8_t system_id = 1;   ///< of its autopilot
  double geoid_height_m = 0.0;  ///< above the ellipsoid; the autopilot's heights are above it
};

/// Of those that a simulator flies here.
[[nodiscard]] std::vector<SimulatedAircraft> simulated_aircraft(
    const std::vector<configuration::VehicleConfig>& vehicles,
    const std::function<bool(VehicleId)>& is_external);

/// Records what simulated aircraft really do, beside what their vehicles believe: their simulators
/// say so, in MAVLink's SIM_STATE. skein-fc does unasked, an ArduPilot once it is asked to. A
/// thread of its own: a state counts for when it arrives.
class TruthRecorder {
 public:
  /// One port of loopback for each, where its simulator is to speak.
  [[nodiscard]] static Result<std::unique_ptr<TruthRecorder>> open(
      const std::vector<SimulatedAircraft>& aircraft, const Wgs84& origin);
  ~TruthRecorder();
  TruthRecorder(const TruthRecorder&) = delete;
  TruthRecorder& operator=(const TruthRecorder&) = delete;

  /// Of one that it was opened with.
  [[nodiscard]] std::uint16_t port(VehicleId vehicle) const;

  /// From now on, until the end. `mission_now` is called in the recorder's thread.
  [[nodiscard]] Result<void> record(const std::filesystem::path& run_folder,
                                    std::int64_t epoch_unix_ns,
                                    std::function<Instant()> mission_now);

 private:
  class Impl;
  explicit TruthRecorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::hil
