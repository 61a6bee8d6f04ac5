// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/preflight_watch.hpp"

#include <chrono>
#include <utility>

#include "check_makers.hpp"
#include "skein/ardupilot/firmware.hpp"
#include "skein/onboard/threads.hpp"

namespace skein::onboard {

PreflightWatch::PreflightWatch(const configuration::VehicleConfig& config, mission::Preflight base,
                               const process::MissionClock& clock,
                               std::function<std::optional<ardupilot::AutopilotFacts>()> facts)
    : config_{config}, base_{std::move(base)}, clock_{clock}, facts_{std::move(facts)} {
  thread_ = start_thread(ThreadRole::preflight, [this] { run(); });
}

void PreflightWatch::stop() {
  {
    const std::lock_guard lock{mutex_};
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::optional<mission::Preflight> PreflightWatch::due() {
  const Instant now = clock_.now();
  const std::lock_guard lock{mutex_};
  return teller_.due(now);
}

void PreflightWatch::ask() {
  const std::lock_guard lock{mutex_};
  teller_.ask();
}

void PreflightWatch::run() {
  std::unique_lock lock{mutex_};
  while (!stopping_) {
    lock.unlock();
    mission::Preflight found = look();
    lock.lock();
    teller_.put(std::move(found));
    wake_.wait_for(lock, spec_of(ThreadRole::preflight).period, [this] { return stopping_; });
  }
}

mission::Preflight PreflightWatch::look() {
  const std::chrono::nanoseconds unix_time = std::chrono::system_clock::now().time_since_epoch();
  const auto now = std::chrono::steady_clock::now();
  const bool simulated =
      config_.flight_controller.kind != configuration::FlightControllerKind::ardupilot;
  if (!host_at_ || now - *host_at_ >= kHostPeriod) {
    host_at_ = now;
    host_ = check_host_of_running(config_, unix_time.count());
    if (!simulated) {
      const auto interface = can::interface_of(config_.flight_controller.ardupilot.can);
      append(host_, check_interface(interface));
    }
  }
  mission::Preflight found = base_;
  Checks all = host_;
  const auto facts = simulated ? std::nullopt : facts_();
  found.complete = simulated || facts;
  if (facts) {
    const auto since = clock_.now() - facts->time_at;
    const auto unix_s_at_gnss = std::chrono::floor<std::chrono::seconds>(unix_time - since);
    append(all, check_autopilot(config_, *facts, unix_s_at_gnss.count()));
    found.in_flight = facts->in_flight;
    found.parameters = digest_of(*facts);
    if (facts->firmware) found.firmware = ardupilot::firmware_text(*facts->firmware);
  }
  return preflight_of(std::move(found), all);
}

}  // namespace skein::onboard
