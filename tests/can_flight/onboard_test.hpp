// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "operator_desk.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/hil/child_process.hpp"

namespace skein {

inline constexpr const char* kFlying = "flying the companion's setpoints";
/// Said where frames end: of them or, where the autopilot's last bytes came a moment before the
/// last frame, of these.
inline constexpr const char* kLost = "no frame comes from the flight controller";
inline constexpr const char* kSilent = "the autopilot is silent";
inline constexpr const char* kRebooted = "the autopilot has rebooted";

/// A skein-onboard with an autopilot on a bus, in real time, and its operator.
class OnboardTest : public ::testing::Test {
 protected:
  using Process = std::unique_ptr<hil::ChildProcess>;

  OnboardTest(VehicleId vehicle, const std::string& name)
      : folder_{std::filesystem::temp_directory_path() /
                ("skein-" + name + "-" + std::to_string(::getpid()))},
        operator_{vehicle, epoch_} {
    std::filesystem::create_directories(folder_);
    config_.vehicle.id = vehicle;
    config_.vehicle.range_m = 40000.0;
    config_.vehicle.capabilities.add(TaskKind::survey);
    config_.flight_controller.kind = configuration::FlightControllerKind::ardupilot;
    config_.network = operator_.network_of(vehicle);
    config_.time.epoch_unix_ns = std::chrono::nanoseconds{epoch_.time_since_epoch()}.count();
  }
  void TearDown() override {
    if (HasFailure()) std::printf("%s\n", log().c_str());
    vehicle_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// Null where it does not start. What it says goes to a file in the folder.
  [[nodiscard]] Process start(const std::vector<std::string>& words, const char* log_file) const {
    auto started = hil::ChildProcess::start(words, folder_ / log_file, {});
    EXPECT_TRUE(started.ok());
    if (!started) return nullptr;
    return std::make_unique<hil::ChildProcess>(std::move(started).value());
  }
  void start_vehicle() {
    std::ofstream{folder_ / "v.yaml"} << to_yaml(config_);
    vehicle_ = start({SKEIN_ONBOARD, "--config", folder_ / "v.yaml"}, "log");
    ASSERT_TRUE(vehicle_);
  }
  /// What the vehicle has said.
  [[nodiscard]] std::string log() const {
    std::ifstream file{folder_ / "log"};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  /// Mission time.
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::system_clock::now() - epoch_).count();
  }

  std::filesystem::path folder_;
  std::chrono::system_clock::time_point epoch_ = std::chrono::system_clock::now();
  OperatorDesk operator_;
  configuration::VehicleConfig config_;
  std::size_t read_ = 0;  ///< of the log
  Process vehicle_;
};

}  // namespace skein
