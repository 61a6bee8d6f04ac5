// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/vehicle_process.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "link_params.hpp"
#include "skein/can/bus.hpp"
#include "skein/codec/codec.hpp"
#include "skein/configuration/setup_params.hpp"
#include "skein/detectors/detector_socket.hpp"
#include "skein/hal/simulated_flight_controller.hpp"
#include "skein/hal/simulated_multirotor.hpp"
#include "skein/mission/concerns.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/setup_book.hpp"
#include "skein/mission/setup_filter.hpp"
#include "skein/network/node.hpp"
#include "skein/onboard/agent_loop.hpp"
#include "skein/onboard/can_flight_controller.hpp"
#include "skein/onboard/control_loop.hpp"
#include "skein/onboard/load_book.hpp"
#include "skein/onboard/node_config.hpp"
#include "skein/onboard/planner.hpp"
#include "skein/onboard/preflight_watch.hpp"
#include "skein/onboard/recorder.hpp"
#include "skein/onboard/status.hpp"
#include "skein/onboard/threads.hpp"
#include "skein/process/close_limit.hpp"
#include "skein/process/host.hpp"
#include "skein/process/key_watch.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/service.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/wake.hpp"
#include "skein/version/version.hpp"

namespace skein::onboard {
namespace {

/// What flies the vehicle; `on_can` is the same object where it is on a bus.
struct FlightControllers {
  std::unique_ptr<hal::FlightController> any;
  CanFlightController* on_can = nullptr;
};

Result<FlightControllers> flight_controllers(const configuration::VehicleConfig& config,
                                             Instant now) {
  FlightControllers made;
  if (config.flight_controller.kind == configuration::FlightControllerKind::ardupilot) {
    auto origin = MissionOrigin::make(config.origin);
    if (!origin) return origin.error();
    const auto params = can_params(config, config.time.epoch_unix_ns / 1000);
    if (!params) return params.error();
    auto bus = can::open(config.flight_controller.ardupilot.can);
    if (!bus) return bus.error();
    auto controller =
        std::make_unique<CanFlightController>(std::move(bus).value(), *params, *origin, now);
    made.on_can = controller.get();
    made.any = std::move(controller);
    return made;
  }
  const auto& wind = config.flight_controller.wind;
  if (config.vehicle.is_copter()) {
    hal::SimulatedMultirotorParams params;
    params.start = {config.start.x_m, config.start.y_m, 0.0};
    params.yaw_rad = config.start.heading_rad;
    params.wind_mps = -wind.speed_mps * unit_vector(wind.from_rad);
    params.gust_mps = wind.gust_mps;
    params.seed = config.seed;
    made.any = std::make_unique<hal::SimulatedMultirotor>(params);
    return made;
  }
  made.any = std::make_unique<hal::SimulatedFlightController>(
      config.vehicle, config.start,
      models::WindParams{.steady_mps = -wind.speed_mps * unit_vector(wind.from_rad),
                         .gust_mps = wind.gust_mps,
                         .seed = config.seed},
      // Where the mission has begun without it, it begins now: not so many months ago.
      std::max(Instant{}, now));
  return made;
}

/// With what keeps its flight controller from flying it.
mission::Health with_flight_controller(mission::Health health, const CanFlightController* on_can) {
  if (on_can == nullptr) return health;
  for (const std::string& problem : on_can->problems()) {
    if (health.problems.size() >= mission::kProblemsMax) break;
    health.problems.push_back(problem.substr(0, kTextMax));
  }
  return health;
}

/// Whether it is of a ground station that was not heard before; `known` is that from then on.
bool is_of_new_ground_station(const mission::Message& message, InstanceId& known) {
  const auto* setup = std::get_if<mission::Setup>(&message);
  return setup != nullptr && setup->node == kGroundStation &&
         std::exchange(known, setup->instance) != setup->instance;
}

AgentLink link_to(network::Node& node, const CanFlightController* on_can, HealthBoard& health) {
  return {.receive = [&node]() -> std::optional<AgentLink::Received> {
            auto received = node.poll();
            if (!received) {
              process::log_troubles(node);
              return std::nullopt;
            }
            return AgentLink::Received{std::move(received->message), received->sender};
          },
          .send =
              [&node, on_can, &health](const mission::Message& message) {
                const auto* told = std::get_if<mission::Health>(&message);
                if (told == nullptr) {
                  node.publish(message);
                  return;
                }
                const mission::Health whole = health.with_host(
                    with_receptions(with_flight_controller(*told, on_can), node.receptions()));
                health.put(whole);
                node.publish(mission::Message{whole});
              },
          .dropped = [&node] { return process::traffic_of(node).dropped; }};
}

Result<std::optional<detectors::DetectorSocket>> detector_socket(
    const configuration::VehicleConfig& config) {
  if (config.detections_socket.empty()) return std::optional<detectors::DetectorSocket>{};
  const auto origin = MissionOrigin::make(config.origin);
  if (!origin) return origin.error();
  auto socket = detectors::DetectorSocket::open(config.detections_socket, *origin);
  if (!socket) return socket.error();
  return std::optional<detectors::DetectorSocket>{std::move(*socket)};
}

/// After what the network has, what detectors on this machine tell.
void listen_to(detectors::DetectorSocket& socket, AgentLink& link) {
  link.receive = [receive = std::move(link.receive),
                  &socket]() -> std::optional<AgentLink::Received> {
    if (auto received = receive()) return received;
    auto detection = socket.poll();
    if (const auto trouble = socket.poll_trouble()) {
      spdlog::warn("a detection cannot be read: {}", *trouble);
    }
    if (!detection) return std::nullopt;
    return AgentLink::Received{mission::Message{*std::move(detection)}, mission::kSensors};
  };
}

/// Beside what the node says, several times a second, what the vehicle's checks find.
void tell_checks(PreflightWatch& preflight, network::Node& node, AgentRing* records,
                 const process::MissionClock& clock, AgentLink& link) {
  link.receive = [receive = std::move(link.receive), &preflight,
                  ground = InstanceId{}]() mutable -> std::optional<AgentLink::Received> {
    auto received = receive();
    if (received && is_of_new_ground_station(received->message, ground)) preflight.ask();
    return received;
  };
  link.send = [send = std::move(link.send), &preflight, &node, records,
               &clock](const mission::Message& message) {
    send(message);
    const auto due = preflight.due();
    if (!due) return;
    const mission::Message told{*due};
    if (records != nullptr) {
      records->push(recording::MessageRecord{told, due->vehicle, clock.now()});
    }
    node.publish(told);
  };
}

AgentLink link_to(network::Node& node, CanFlightController* on_can, HealthBoard& health,
                  PreflightWatch& preflight, std::optional<detectors::DetectorSocket>& socket,
                  AgentRing* records, const process::MissionClock& clock) {
  AgentLink link = link_to(node, on_can, health);
  tell_checks(preflight, node, records, clock, link);
  link.now = [&clock] { return clock.now(); };
  if (socket) listen_to(*socket, link);
  if (records != nullptr) {
    link.record = [records](recording::AgentRecord record) { records->push(std::move(record)); };
  }
  if (on_can == nullptr) return link;
  link.mode = [on_can] { return on_can->mode(); };
  link.notice = [on_can]() -> std::optional<mission::FlightNotice> {
    auto notice = on_can->poll_notice();
    if (!notice) return std::nullopt;
    return mission::FlightNotice{notice->time, notice->warning, std::move(notice->what)};
  };
  link.dropped = [dropped = std::move(link.dropped), on_can] {
    return dropped() + on_can->notices_dropped();
  };
  link.give_back = [on_can](Instant issued) { on_can->give_back(issued); };
  link.keep_fence = [on_can](const Fence& fence) { on_can->keep_fence(fence); };
  return link;
}

/// The threads of threads.hpp around the objects that they run, from construction to stop().
class Threads {
 public:
  Threads(const configuration::VehicleConfig& config, const std::optional<TimedPath>& route,
          const process::MissionClock& clock, network::Node& node, process::Wake& wake_agent,
          InstanceId instance, std::optional<recording::Writer> writer, LoadBook loads,
          FlightControllers flight_controllers, std::optional<detectors::DetectorSocket> detectors,
          HealthBoard& health, PreflightWatch& preflight, Instant now)
      : clock_{clock},
        detectors_{std::move(detectors)},
        wake_agent_{wake_agent},
        flight_controllers_{std::move(flight_controllers)},
        control_{config.vehicle, *flight_controllers_.any, ports_,
                 config.flight_controller.follower()},
        agent_{node_config(config, route, instance, "skein-onboard " + version()),
               link_to(node, flight_controllers_.on_can, health, preflight, detectors_,
                       writer ? &records_ : nullptr, clock),
               ports_,
               planner_,
               events_,
               now},
        recorder_{std::move(writer), ports_, events_, records_, std::move(loads)} {
    recorder_thread_ = start_thread(ThreadRole::recorder, [this] { recorder_.run(); });
    planner_thread_ = start_thread(ThreadRole::planner, [this] { planner_.run(); });
    if (flight_controllers_.on_can != nullptr) {
      can_thread_ = start_thread(ThreadRole::can, [this] { run_can(); });
    }
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
    if (can_thread_.joinable()) can_thread_.join();
    recorder_.stop();
    recorder_thread_.join();
  }

  /// Moves with every period of control, and with every step of the agent.
  [[nodiscard]] std::array<std::uint64_t, 2> progress() const {
    return {ports_.periods.load(std::memory_order_relaxed),
            agent_steps_.load(std::memory_order_relaxed)};
  }
  [[nodiscard]] const ControlPorts& ports() const { return ports_; }

  void log_summary(const network::Node& node) const {
    const auto traffic = process::traffic_of(node);
    const mission::Counters counters = agent_.node().counters();
    spdlog::info(
        "ended: {} control periods, {} overruns, {} without a state; messages sent {}, received "
        "{}, dropped {}, refused of their senders {}; datagrams of strangers {}, decisions "
        "unproven {}; network restarted {} times, messages not sent meanwhile {}; "
        "protocol errors {}; records dropped {}",
        ports_.periods.load(), ports_.overruns.load(), ports_.stale_states.load(), traffic.sent,
        traffic.received, traffic.dropped + counters.messages_dropped, counters.refused,
        traffic.of_strangers, traffic.unproven, traffic.restarts, traffic.unconnected,
        counters.protocol_errors + counters.bad_messages,
        counters.events_dropped + ports_.track.dropped() + ports_.plans.dropped() +
            events_.dropped() + records_.dropped());
    process::log_air(node);
    if (flight_controllers_.on_can == nullptr) return;
    const auto& link = flight_controllers_.on_can->link();
    const auto& bus = link.bus().statistics();
    spdlog::info(
        "bus {}: frames sent {}, received {}, refused {}, lost {}; transfers broken {}, dropped "
        "{}; MAVLink packets {}, lost {}",
        link.bus().name(), bus.sent, bus.received, bus.refused, bus.lost,
        link.reassembly().broken(), link.transfers_dropped(), link.companion().parser().packets,
        link.companion().parser().lost);
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

  void run_can() {
    while (!stopping_) {
      flight_controllers_.on_can->step(clock_.now());
      flight_controllers_.on_can->wait(spec_of(ThreadRole::can).period);
    }
  }

  void run_agent() {
    while (!stopping_) {
      const Instant now = clock_.now();
      agent_.step(now);
      agent_steps_.fetch_add(1, std::memory_order_relaxed);
      clock_.sleep_until(now + AgentLoop::kStepSpacing);
      wake_agent_.wait_until(clock_.steady_time_of(agent_.next_step()));
    }
  }

  ControlPorts ports_;
  EventRing events_;
  AgentRing records_;
  Planner planner_{[this] { wake_agent_.notify(); }, [this] { return clock_.now(); }};
  const process::MissionClock& clock_;
  std::optional<detectors::DetectorSocket> detectors_;
  process::Wake& wake_agent_;
  FlightControllers flight_controllers_;
  ControlLoop control_;
  AgentLoop agent_;
  Recorder recorder_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> agent_steps_{0};
  std::thread control_thread_;
  std::thread can_thread_;
  std::thread agent_thread_;
  std::thread planner_thread_;
  std::thread recorder_thread_;
};

/// What the process tells its host, from its main thread: the watchdog, fed by progress alone; the
/// status socket; the machine's clock and disk.
class HostDesk {
 public:
  HostDesk(const configuration::VehicleConfig& config, const HostOptions& options,
           const process::MissionClock& clock, const network::Node& node, HealthBoard& health,
           const Threads& threads, const process::Service& service)
      : folder_{config.recording_folder},
        among_machines_{process::among_machines(config.network)},
        vehicle_{config.vehicle.id},
        clock_{clock},
        node_{node},
        health_{health},
        threads_{threads},
        service_{service} {
    if (options.status_socket.empty()) return;
    auto opened = StatusSocket::open(options.status_socket);
    if (opened) {
      socket_ = std::move(*opened);
    } else {
      spdlog::warn("there is no status socket: {}", opened.error().message);
    }
  }

  /// How often step() is to be called.
  [[nodiscard]] std::chrono::nanoseconds period() const {
    const auto watchdog = service_.watchdog_period();
    return watchdog ? std::min<std::chrono::nanoseconds>(*watchdog, kPeriod) : kPeriod;
  }

  void step() {
    const auto now = std::chrono::steady_clock::now();
    if (progress_.all_moved(threads_.progress(), now)) service_.feed_watchdog();
    if (now >= next_look_) look(now);
    if (socket_) socket_->serve([this, now] { return status_json(status(now)); });
  }

 private:
  static constexpr std::chrono::nanoseconds kPeriod = std::chrono::milliseconds{200};
  static constexpr std::chrono::seconds kLookPeriod{5};
  static constexpr std::chrono::seconds kTold{60};  ///< what is over, so that people see it

  void look(std::chrono::steady_clock::time_point now) {
    clock_state_ = process::clock_state();
    if (!folder_.empty()) {
      const std::uint64_t bytes = process::bytes_in(folder_);
      const std::chrono::duration<double> since = now - looked_at_;
      const double rate =
          bytes < bytes_ ? 0.0 : static_cast<double>(bytes - bytes_) / since.count();
      recording_ = Status::Recording{folder_, process::free_bytes(folder_), bytes,
                                     looked_at_ == decltype(looked_at_){} ? 0.0 : rate};
      bytes_ = bytes;
    }
    mission::HostFacts facts;
    if (recording_) facts.disk_free_bytes = recording_->free_bytes;
    if (among_machines_ && clock_state_) {
      facts.clock = mission::HostFacts::Clock{clock_state_->synchronised, clock_state_->error_max};
    }
    const std::uint64_t restarts = process::traffic_of(node_).restarts;
    if (std::exchange(network_restarts_, restarts) != restarts) tell_restarts_until_ = now + kTold;
    if (now < tell_restarts_until_) facts.network_restarts = restarts;
    health_.put(facts);
    looked_at_ = now;
    next_look_ = now + kLookPeriod;
  }

  [[nodiscard]] Status status(std::chrono::steady_clock::time_point now) const {
    const ControlPorts& ports = threads_.ports();
    Status status{.health = health_.get(),
                  .now = clock_.now(),
                  .airborne = ports.airborne.load(std::memory_order_relaxed),
                  .clock = clock_state_,
                  .recording = recording_,
                  .overruns = ports.overruns.load(std::memory_order_relaxed),
                  .stale_states = ports.stale_states.load(std::memory_order_relaxed),
                  .control_age = progress_.age(0, now),
                  .agent_age = progress_.age(1, now),
                  .watched = service_.watchdog_period().has_value(),
                  .network_restarts = process::traffic_of(node_).restarts};
    status.health.vehicle = vehicle_;
    return status;
  }

  std::string folder_;
  bool among_machines_;  ///< else it does not matter what time it is here
  VehicleId vehicle_;
  const process::MissionClock& clock_;
  const network::Node& node_;
  HealthBoard& health_;
  const Threads& threads_;
  const process::Service& service_;
  process::ProgressWatch progress_{2, std::chrono::steady_clock::now()};
  std::unique_ptr<StatusSocket> socket_;
  std::optional<process::ClockState> clock_state_;
  std::optional<Status::Recording> recording_;
  std::uint64_t bytes_ = 0;
  std::chrono::steady_clock::time_point looked_at_{};
  std::chrono::steady_clock::time_point next_look_{};
  std::uint64_t network_restarts_ = 0;  ///< when it looked
  std::chrono::steady_clock::time_point tell_restarts_until_{};
};

/// What the vehicle acts on, asked before it is verified; DDS asks from several threads.
class Ear {
 public:
  Ear(const mission::SetupParams& setup, VehicleId self) : self_{self}, filter_{setup, self} {}
  bool heeds(const mission::Message& message, Instant now) {
    if (!mission::concerns(message, self_)) return false;
    const std::lock_guard lock{mutex_};
    return filter_.heeds(message, now);
  }

 private:
  VehicleId self_;
  std::mutex mutex_;
  mission::SetupFilter filter_;
};

/// Nothing where nothing is to be recorded, nor where nothing can be any more in the mission in
/// which something was: who starts anew has an aircraft to fly.
Result<std::optional<recording::Writer>> open_recording(const configuration::VehicleConfig& config,
                                                        InstanceId instance,
                                                        const process::MissionClock& clock) {
  if (config.recording_folder.empty()) return std::optional<recording::Writer>{};
  recording::Writer::Options options;
  options.session = {config.vehicle.id,     instance,       "skein-onboard", version(),
                     clock.epoch_unix_ns(), to_yaml(config)};
  options.bytes_max = config.recording_limit_mb * 1'000'000ULL;
  auto opened = recording::Writer::open(config.recording_folder, options);
  if (opened) return std::optional<recording::Writer>{std::move(*opened)};
  std::error_code nothing_there;
  const bool was_recorded =
      !std::filesystem::is_empty(config.recording_folder, nothing_there) && !nothing_there;
  if (clock.now() < Instant{} || !was_recorded) return opened.error();
  spdlog::error("nothing is recorded: {}", opened.error().message);
  return std::optional<recording::Writer>{};
}

/// The loads that its earlier programs in this mission have used are gone.
configuration::VehicleConfig with_loads_left(configuration::VehicleConfig config,
                                             const LoadBook& loads) {
  if (loads.used() == 0) return config;
  spdlog::info("goes on with this mission: {} of its {} loads are used", loads.used(),
               config.vehicle.loads);
  config.vehicle.loads -=
      static_cast<std::uint8_t>(std::min<std::size_t>(loads.used(), config.vehicle.loads));
  return config;
}

/// What does not change of what the vehicle's checks find.
mission::Preflight preflight_base(const configuration::VehicleConfig& config, InstanceId instance) {
  std::string common;
  const auto setup = configuration::setup_params(config, {version(), codec::wire_versions()});
  for (const mission::SetupItem& item : mission::items_of(setup)) {
    common += std::to_string(item.key) + " " + std::to_string(item.value) + "\n";
  }
  mission::Preflight base;
  base.vehicle = config.vehicle.id;
  base.instance = instance;
  base.copter = config.vehicle.is_copter();
  base.release = version().substr(0, mission::kCheckNameMax);
  base.configuration = mission::setup_hash(common);
  return base;
}

/// The clock must outlive the node.
Result<std::unique_ptr<network::Node>> join(const configuration::VehicleConfig& config,
                                            const process::NodeStart& start,
                                            const process::MissionClock& clock,
                                            process::Wake& wake) {
  auto node = process::node_config(config.network, start, [&wake] { wake.notify(); });
  node.isolated = config.network.isolated;
  const auto setup = configuration::setup_params(config, {version(), codec::wire_versions()});
  const auto ear = std::make_shared<Ear>(setup, start.self);
  node.heeds = [ear, &clock](const mission::Message& message) {
    return ear->heeds(message, clock.now());
  };
  return network::Node::open(node);
}

}  // namespace

int fly(const configuration::VehicleConfig& config, const HostOptions& host) {
  const process::Shutdown shutdown;
  // Mission time is the clock's time since the epoch: either may be moved.
  const process::MissionClock clock{config.time.epoch_unix_ns - host.clock_ahead.count(),
                                    config.time.rate};
  process::start_log(clock);
  process::CloseLimit close_limit;

  auto route = configuration::timed_path(config.route, config.vehicle);
  if (!route) {
    spdlog::critical("the route cannot be flown: {}", route.error().message);
    return process::kExitBadInput;
  }
  auto start = process::start_node(config.network, config.vehicle.id);
  if (!start) {
    spdlog::critical("cannot join the mission network: {}", start.error().message);
    return process::kExitCannotStart;
  }
  const InstanceId instance = start->instance;
  LoadBook loads{config.recording_folder, config.time.epoch_unix_ns};
  auto writer = open_recording(config, instance, clock);
  if (!writer) {
    spdlog::critical("cannot record: {}", writer.error().message);
    return process::kExitCannotStart;
  }
  process::Wake wake_agent;
  auto node = join(config, *start, clock, wake_agent);
  if (!node) {
    spdlog::critical("cannot join the mission network: {}", node.error().message);
    return process::kExitCannotStart;
  }

  auto controllers = flight_controllers(config, clock.now());
  if (!controllers) {
    spdlog::critical("cannot reach the flight controller: {}", controllers.error().message);
    return process::kExitCannotStart;
  }

  auto detectors = detector_socket(config);
  if (!detectors) {
    spdlog::critical("cannot listen to detectors: {}", detectors.error().message);
    return process::kExitCannotStart;
  }

  spdlog::info("vehicle {} joins the mission network {}, instance {:016x}", config.vehicle.id.value,
               process::how_it_speaks(*start), instance.value);
  process::log_unused_keys(config.network, config.recording_folder);
  std::optional<process::KeyWatch> keys;
  if (start->identity) keys.emplace(**node, std::move(*start->identity), config.network.keys);
  HealthBoard health;
  PreflightWatch preflight{config, preflight_base(config, instance), clock,
                           [on_can = controllers->on_can] { return on_can->facts(); }};
  const auto threads = std::make_unique<Threads>(
      with_loads_left(config, loads), *route, clock, **node, wake_agent, instance,
      std::move(*writer), std::move(loads), std::move(controllers).value(), std::move(*detectors),
      health, preflight, clock.now());
  const process::Service service;
  HostDesk desk{config, host, clock, **node, health, *threads, service};
  service.ready();
  const char* signal = nullptr;
  while ((signal = shutdown.wait_for(desk.period())) == nullptr) desk.step();
  service.stopping();
  spdlog::info("{}: stopping", signal);
  preflight.stop();
  threads->stop();
  threads->log_summary(**node);
  close_limit.start(process::kCloseWithin);
  return 0;
}

}  // namespace skein::onboard
