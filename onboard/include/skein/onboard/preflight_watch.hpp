// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "skein/onboard/preflight_report.hpp"
#include "skein/process/mission_clock.hpp"

namespace skein::onboard {

/// Looks again and again at what a flight needs, in a thread of its own: files, keys and
/// interfaces may take their time. Whoever speaks to the team asks what is to be told.
class PreflightWatch {
 public:
  /// What is asked of files and the kernel; of the autopilot it is the thread's period.
  static constexpr std::chrono::seconds kHostPeriod{4};

  /// `facts`: what the autopilot says of itself, from any thread; nothing while it is not known.
  /// Empty where the flight controller is simulated. All must outlive stop().
  PreflightWatch(const configuration::VehicleConfig& config, mission::Preflight base,
                 const process::MissionClock& clock,
                 std::function<std::optional<ardupilot::AutopilotFacts>()> facts);
  ~PreflightWatch() { stop(); }
  PreflightWatch(const PreflightWatch&) = delete;
  PreflightWatch& operator=(const PreflightWatch&) = delete;
  void stop();

  // Of any thread.
  [[nodiscard]] std::optional<mission::Preflight> due();
  void ask();

 private:
  void run();
  [[nodiscard]] mission::Preflight look();

  const configuration::VehicleConfig& config_;
  mission::Preflight base_;
  const process::MissionClock& clock_;
  std::function<std::optional<ardupilot::AutopilotFacts>()> facts_;
  Checks host_;
  std::optional<std::chrono::steady_clock::time_point> host_at_;
  std::mutex mutex_;
  std::condition_variable wake_;
  PreflightTeller teller_;  ///< of the mutex
  bool stopping_ = false;   ///< of the mutex
  std::thread thread_;
};

}  // namespace skein::onboard
