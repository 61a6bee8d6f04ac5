// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/vehicle_process.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "skein/hal/simulated_flight_controller.hpp"
#include "skein/network/node.hpp"
#include "skein/onboard/agent_loop.hpp"
#include "skein/onboard/control_loop.hpp"
#include "skein/onboard/planner.hpp"
#include "skein/onboard/recorder.hpp"
#include "skein/onboard/threads.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/wake.hpp"

namespace skein::onboard {
namespace {

std::unique_ptr<hal::FlightController> flight_controller(
    const configuration::VehicleConfig& config) {
  switch (config.flight_controller.kind) {
    case configuration::FlightControllerKind::simulated:
    case configuration::FlightControllerKind::count:
      break;
  }
  const auto& wind = config.flight_controller.wind;
  return std::make_unique<hal::SimulatedFlightController>(
      config.vehicle, config.start,
      models::WindParams{.steady_mps = -wind.speed_mps * unit_vector(wind.from_rad),
                         .gust_mps = wind.gust_mps,
                         .seed = config.seed});
}

mission::VehicleAgentConfig agent_config(const configuration::VehicleConfig& config,
                                         InstanceId instance) {
  mission::VehicleAgentConfig agent;
  agent.vehicle = config.vehicle;
  agent.instance = instance;
  agent.protocol = config.protocol;
  agent.planning = config.planning;
  agent.search = config.search;
  agent.hazards = config.hazards;
  return agent;
}

AgentLink link_to(network::Node& node) {
  return {.receive = [&node]() -> std::optional<AgentLink::Received> {
            auto received = node.poll();
            if (!received) return std::nullopt;
            return AgentLink::Received{std::move(received->message), received->sender};
          },
          .send = [&node](const mission::Message& message) { node.publish(message); },
          .dropped = [&node] { return process::traffic_of(node).dropped; }};
}

/// The four threads of threads.hpp around the objects that they run, from construction to stop().
class Threads {
 public:
  Threads(const configuration::VehicleConfig& config, const process::MissionClock& clock,
          network::Node& node, process::Wake& wake_agent, InstanceId instance,
          std::optional<recording::Writer> writer)
      : clock_{clock},
        wake_agent_{wake_agent},
        flight_controller_{flight_controller(config)},
        control_{config.vehicle, *flight_controller_, ports_},
        agent_{
            agent_config(config, instance), link_to(node), ports_, planner_, events_, clock.now()},
        recorder_{std::move(writer), ports_, events_} {
    recorder_thread_ = start_thread(ThreadRole::recorder, [this] { recorder_.run(); });
    planner_thread_ = start_thread(ThreadRole::planner, [this] { planner_.run(); });
    control_thread_ = start_thread(ThreadRole::control, [this] { run_control(); });
    agent_thread_ = start_thread(ThreadRole::agent, [this] { run_agent(); });
  }

  /// Decisions end first, then control, and the recorder last, so that it gets everything.
  void stop() {
    stopping_ = true;
    wake_agent_.notify();
    agent_thread_.join();
    planner_.stop();
    planner_thread_.join();
    control_thread_.join();
    recorder_.stop();
    recorder_thread_.join();
  }

  void log_summary(const network::Node& node) const {
    const auto traffic = process::traffic_of(node);
    std::uint64_t errors = 0;
    for (const auto& [name, count] : agent_.agent().counters()) errors += count;
    spdlog::info(
        "ended: {} control periods, {} overruns, {} without a state; messages sent {}, received "
        "{}, "
        "dropped {}; agent errors {}; records dropped {}",
        ports_.periods.load(), ports_.overruns.load(), ports_.stale_states.load(), traffic.sent,
        traffic.received, traffic.dropped, errors,
        ports_.track.dropped() + ports_.plans.dropped() + events_.dropped());
  }

 private:
  void run_control() {
    PeriodicSchedule schedule{clock_.now(), spec_of(ThreadRole::control).period};
    while (!stopping_) {
      clock_.sleep_until(schedule.next());
      control_.step(clock_.now());
      ports_.overruns.fetch_add(schedule.advance(clock_.now()), std::memory_order_relaxed);
    }
  }

  void run_agent() {
    while (!stopping_) {
      const Instant now = clock_.now();
      agent_.step(now);
      clock_.sleep_until(now + AgentLoop::kStepSpacing);
      wake_agent_.wait_until(clock_.steady_time_of(agent_.next_step()));
    }
  }

  const process::MissionClock& clock_;
  process::Wake& wake_agent_;
  ControlPorts ports_;
  EventRing events_;
  Planner planner_{[this] { wake_agent_.notify(); }, [this] { return clock_.now(); }};
  std::unique_ptr<hal::FlightController> flight_controller_;
  ControlLoop control_;
  AgentLoop agent_;
  Recorder recorder_;
  std::atomic<bool> stopping_{false};
  std::thread control_thread_;
  std::thread agent_thread_;
  std::thread planner_thread_;
  std::thread recorder_thread_;
};

}  // namespace

int fly(const configuration::VehicleConfig& config) {
  const process::Shutdown shutdown;
  const process::MissionClock clock{config.time.epoch_unix_ns, config.time.rate};
  process::start_log(clock);

  std::optional<recording::Writer> writer;
  if (!config.recording_folder.empty()) {
    auto opened = recording::Writer::open(config.recording_folder);
    if (!opened) {
      spdlog::critical("cannot record: {}", opened.error().message);
      return process::kExitCannotStart;
    }
    writer = std::move(*opened);
  }
  const InstanceId instance = process::new_instance();
  process::Wake wake_agent;
  auto node = network::Node::open(process::node_config(config.network, config.vehicle.id, instance,
                                                       [&wake_agent] { wake_agent.notify(); }));
  if (!node) {
    spdlog::critical("cannot join the mission network: {}", node.error().message);
    return process::kExitCannotStart;
  }

  spdlog::info("vehicle {} joins the mission network, instance {:016x}", config.vehicle.id.value,
               instance.value);
  const auto threads =
      std::make_unique<Threads>(config, clock, **node, wake_agent, instance, std::move(writer));
  spdlog::info("{}: stopping", shutdown.wait());
  threads->stop();
  threads->log_summary(**node);
  return 0;
}

}  // namespace skein::onboard
