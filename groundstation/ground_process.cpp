// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/ground_process.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/formation_desk.hpp"
#include "skein/groundstation/line_reader.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/network/node.hpp"
#include "skein/process/close_limit.hpp"
#include "skein/process/event_text.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/wake.hpp"
#include "skein/recording/writer.hpp"

namespace skein::groundstation {
namespace {

constexpr Duration kStepPeriod = std::chrono::milliseconds{50};
constexpr Duration kStepSpacing = std::chrono::milliseconds{20};  // telemetry comes all the time
constexpr Duration kFlushPeriod = std::chrono::seconds{1};

mission::GroundAgentConfig agent_config(const configuration::GroundConfig& config) {
  mission::GroundAgentConfig agent;
  agent.expected = config.vehicles;
  for (const auto& decision : config.operator_decisions) {
    agent.decisions.push_back({.site = decision.site,
                               .grant = decision.grant,
                               .reaction = decision.reaction,
                               .not_before = decision.not_before});
  }
  return agent;
}

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

/// Carries messages and typed lines to the agent, and its messages, events and requests away.
class GroundLoop {
 public:
  GroundLoop(const configuration::GroundConfig& config, const MissionOrigin& origin,
             std::string operator_name, const process::MissionClock& clock,
             const process::Shutdown& shutdown, network::Node& node, process::Wake& wake,
             std::optional<recording::Writer> writer, FormationDesk formation,
             std::unique_ptr<ControlSocket> control)
      : agent_config_{agent_config(config)},
        origin_{origin},
        operator_name_{std::move(operator_name)},
        clock_{clock},
        shutdown_{shutdown},
        node_{node},
        wake_{wake},
        writer_{std::move(writer)},
        agent_{agent_config_, clock.now()},
        formation_{std::move(formation)},
        control_{std::move(control)} {}

  void run() {
    LineReader prompt{STDIN_FILENO, [this] { wake_.notify(); }};
    while (!stopping_) {
      const Instant now = clock_.now();
      while (const auto received = node_.poll()) {
        agent_.on_message(received->message, received->sender, now);
        formation_.on_message(received->message, received->sender, now);
      }
      while (const auto line = prompt.next()) {
        const Answer given = answer(*line, now);
        print((given.done ? "" : "error: ") + given.text);
      }
      while (const auto request = control_ ? control_->next() : std::nullopt) {
        spdlog::info("told by another program: {}", request->line);
        request->reply(answer(request->line, now));
      }
      agent_.on_timeout(now);
      formation_.on_timeout(now);
      hand_out(now);
      const Instant soonest = now + kStepSpacing;
      clock_.sleep_until(soonest);
      wake_.wait_until(
          clock_.steady_time_of(std::clamp(agent_.next_timeout(), soonest, now + kStepPeriod)));
    }
    flush();
  }
  /// From another thread.
  void stop() {
    stopping_ = true;
    wake_.notify();
  }

 private:
  Answer answer(const std::string& line, Instant now) {
    const auto input = parse_input(line);
    if (!input) return refusal(input.error());
    if (const auto* view = std::get_if<View>(&*input)) return {true, text_of(*view, now)};
    if (const auto* decision = std::get_if<Decision>(&*input)) {
      return answer_to(decision->grant ? agent_.authorise(decision->site, operator_name_, now)
                                       : agent_.refuse(decision->site, operator_name_, now));
    }
    if (const auto* order = std::get_if<Order>(&*input)) {
      return answer_to(agent_.command(order->vehicle, order->kind, now));
    }
    if (const auto* typed = std::get_if<Formation>(&*input)) {
      auto answered = formation_.answer(*typed, now);
      if (!answered) return refusal(answered.error());
      return {true, std::move(*answered)};
    }
    if (std::holds_alternative<Wait>(*input)) return {false, "'wait' is for scripts\n"};
    if (std::holds_alternative<Quit>(*input)) shutdown_.request();
    return {true, ""};
  }

  [[nodiscard]] std::string text_of(View view, Instant now) const {
    switch (view) {
      case View::help:
        return help_text();
      case View::status:
        return fleet_table(agent_.fleet(), agent_config_.expected, now);
      case View::sites:
        return sites_.text();
      case View::pending:
        return pending_text(agent_.authorisations(), origin_, now);
      case View::places:
        return formation_.places_table(now);
    }
    return "";
  }

  static Answer refusal(const Error& error) { return {false, error.message + "\n"}; }
  static Answer answer_to(const Result<void>& outcome) {
    return outcome ? Answer{true, "done\n"} : refusal(outcome.error());
  }

  void hand_out(Instant now) {
    while (const auto message = agent_.poll_message()) node_.publish(*message);
    while (const auto message = formation_.poll_message()) {
      node_.publish(*message);
      if (const auto* change = std::get_if<formation::Change>(&*message)) record(*change);
    }
    while (const auto event = formation_.poll_event()) {
      node_.publish(mission::Message{*event});
      tell_of(*event);
    }
    while (const auto event = agent_.poll_event()) {
      sites_.on_event(*event);
      tell_of(*event);
    }
    for (const auto& pending : agent_.authorisations()) {
      if (pending.decision || is_scripted(pending.request.site)) continue;
      if (!shown_.emplace(pending.request.site, pending.request.round).second) continue;
      print(request_text(pending, origin_, now));
    }
    if (now >= next_flush_) {
      next_flush_ = now + kFlushPeriod;
      flush();
    }
  }

  /// Each change once, however often it is sent.
  void record(const formation::Change& change) {
    if (!writer_ || change.number == recorded_change_) return;
    recorded_change_ = change.number;
    for (const formation::Mover& mover : change.movers) {
      writer_->write(
          recording::PlaceRecord{change.number, change.start, mover.vehicle, mover.points.back()});
    }
  }

  void tell_of(const mission::MissionEvent& event) {
    const bool warning = event.kind == mission::EventKind::warning;
    spdlog::log(warning ? spdlog::level::warn : spdlog::level::info, process::text_of(event));
    if (writer_) writer_->write(event);
  }

  void flush() {
    if (!writer_) return;
    const auto flushed = writer_->flush();
    if (flushed) return;
    spdlog::error("recording stops: {}", flushed.error().message);
    writer_.reset();
  }

  [[nodiscard]] bool is_scripted(SiteId site) const {
    return std::any_of(agent_config_.decisions.begin(), agent_config_.decisions.end(),
                       [&](const auto& decision) { return decision.site == site; });
  }

  mission::GroundAgentConfig agent_config_;
  MissionOrigin origin_;
  std::string operator_name_;
  const process::MissionClock& clock_;
  const process::Shutdown& shutdown_;
  network::Node& node_;
  process::Wake& wake_;
  std::optional<recording::Writer> writer_;
  mission::GroundAgent agent_;
  FormationDesk formation_;
  std::unique_ptr<ControlSocket> control_;
  std::uint32_t recorded_change_ = 0;
  SiteBoard sites_;
  std::set<std::pair<SiteId, coalition::Round>> shown_;
  Instant next_flush_{Instant::min()};
  std::atomic<bool> stopping_{false};
};

}  // namespace

std::string control_socket_of(const configuration::GroundConfig& config) {
  return config.control_socket.empty() ? control_socket_name(config.network.port)
                                       : config.control_socket;
}

int run(const configuration::GroundConfig& config, const std::string& operator_name) {
  const process::Shutdown shutdown;
  const process::MissionClock clock{config.time.epoch_unix_ns, config.time.rate};
  process::start_log(clock);
  process::CloseLimit close_limit;

  const auto origin = MissionOrigin::make(config.origin);
  if (!origin) {
    spdlog::critical("the mission origin is unusable: {}", origin.error().message);
    return process::kExitBadInput;
  }
  auto formation = FormationDesk::open(config.formation, config.vehicles, clock.now());
  if (!formation) {
    spdlog::critical("the formation's orders are unusable: {}", formation.error().message);
    return process::kExitBadInput;
  }
  std::optional<recording::Writer> writer;
  if (!config.recording_folder.empty()) {
    auto opened = recording::Writer::open(config.recording_folder);
    if (!opened) {
      spdlog::critical("cannot record: {}", opened.error().message);
      return process::kExitCannotStart;
    }
    writer = std::move(*opened);
  }
  process::Wake wake;
  auto node = network::Node::open(process::node_config(
      config.network, kGroundStation, process::new_instance(), [&wake] { wake.notify(); }));
  if (!node) {
    spdlog::critical("cannot join the mission network: {}", node.error().message);
    return process::kExitCannotStart;
  }

  auto control = ControlSocket::open(control_socket_of(config), [&wake] { wake.notify(); });
  if (!control) {
    spdlog::warn("takes no orders from other programs: {}", control.error().message);
  }

  spdlog::info("ground station of {} vehicles, {}; type help", config.vehicles.size(),
               config.operator_decisions.empty()
                   ? "decisions by " + operator_name
                   : std::string{"with decisions scripted by the scenario"});
  GroundLoop loop{config,
                  *origin,
                  operator_name,
                  clock,
                  shutdown,
                  **node,
                  wake,
                  std::move(writer),
                  std::move(*formation),
                  control ? std::move(*control) : nullptr};
  std::thread thread{[&loop] { loop.run(); }};
  spdlog::info("{}: stopping", shutdown.wait());
  loop.stop();
  thread.join();
  const auto traffic = process::traffic_of(**node);
  spdlog::info("ended: messages sent {}, received {}, dropped {}", traffic.sent, traffic.received,
               traffic.dropped);
  close_limit.start(process::kCloseWithin);
  return 0;
}

}  // namespace skein::groundstation
