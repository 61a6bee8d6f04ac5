// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "commands.hpp"
#include "skein/can/bus.hpp"
#include "skein/can/candump.hpp"
#include "skein/hil/bus_listener.hpp"

namespace skein::hil {
namespace {

using Clock = std::chrono::steady_clock;

/// How long a signal to end may go unnoticed, and the state of the bus.
constexpr int kLook_ms = 100;
/// A bus that takes nothing for so long is not waited for.
constexpr std::chrono::seconds kStuck{2};

std::atomic<bool> g_end_asked{false};

void end_at_signal() {
  const auto ask = [](int) { g_end_asked = true; };
  (void)std::signal(SIGINT, ask);
  (void)std::signal(SIGTERM, ask);
}

std::string time_of(const can::Frame& frame) {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(frame.timestamp).count();
  return fmt::format("({}.{:06})", us / 1'000'000, us % 1'000'000);
}

void print_lines(BusListener& listener, const can::Frame& frame) {
  for (const std::string& line : listener.on_frame(frame)) {
    fmt::print("{} {}\n", time_of(frame), line);
  }
}

/// The tools that read such logs know names of interfaces only: "mcast:0@lo" becomes "mcast_0_lo".
std::string name_in_log(std::string name) {
  for (char& c : name) {
    if (c == ':' || c == '@') c = '_';
  }
  return name;
}

/// Tells of a change of the bus's state.
void watch_state(const can::Bus& bus, can::State& last) {
  if (bus.state() == last) return;
  last = bus.state();
  fmt::print(stderr, "{} is {}\n", bus.name(), can::to_string(last));
}

int dump(can::Bus& bus, const CanDumpArguments& arguments) {
  std::ofstream log;
  if (!arguments.log.empty()) {
    log.open(arguments.log);
    if (!log) {
      fmt::print(stderr, "{}: cannot be written\n", arguments.log.string());
      return kExitBadInput;
    }
  }
  const std::string interface = name_in_log(arguments.bus);
  BusListener listener;
  can::State state = bus.state();
  end_at_signal();
  fmt::print(stderr, "listening on {}; Ctrl-C ends\n", bus.name());
  const auto end = Clock::now() + std::chrono::duration<double>(arguments.seconds.value_or(0));
  while (!g_end_asked && (!arguments.seconds || Clock::now() < end)) {
    while (const auto frame = bus.receive()) {
      print_lines(listener, *frame);
      if (log.is_open()) log << can::to_candump(interface, *frame) << '\n';
    }
    std::fflush(stdout);
    log.flush();
    watch_state(bus, state);
    pollfd readable{bus.descriptor(), POLLIN, 0};
    (void)::poll(&readable, 1, kLook_ms);
  }
  fmt::print("{}", listener.summary());
  if (bus.statistics().lost > 0) {
    fmt::print("{} frames lost: this program was too slow\n", bus.statistics().lost);
  }
  log.close();
  if (!arguments.log.empty() && !log) {
    fmt::print(stderr, "{}: could not be written to its end\n", arguments.log.string());
    return kExitBadInput;
  }
  return kExitHeld;
}

/// Waits until it is time for the frame; false when asked to end.
bool wait_until(Clock::time_point due) {
  while (!g_end_asked && Clock::now() < due) {
    std::this_thread::sleep_until(
        std::min(due, Clock::now() + std::chrono::milliseconds{kLook_ms}));
  }
  return !g_end_asked;
}

bool send_now(can::Bus& bus, const can::Frame& frame) {
  const auto given_up = Clock::now() + kStuck;
  while (!bus.send(frame)) {
    if (g_end_asked || Clock::now() > given_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return true;
}

/// Sends the frames of a log at their times.
class Replayer {
 public:
  Replayer(can::Bus& bus, double rate) : bus_{bus}, rate_{rate} {}

  /// False when asked to end.
  Result<bool> send(const can::Frame& frame) {
    if (frame.error) return true;  // what a controller said of its bus is no frame on it
    if (frame.fd && !bus_.fd()) {
      return Error{bus_.name() + " takes no CAN FD frames; 'ip link set " + bus_.name() +
                   " mtu 72'"};
    }
    if (!first_) first_ = frame.timestamp;
    const auto after = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(to_seconds(frame.timestamp - *first_) / rate_));
    if (!wait_until(start_ + after)) return false;
    if (!send_now(bus_, frame)) {
      return Error{
          fmt::format("{} is {} and takes no frames", bus_.name(), can::to_string(bus_.state()))};
    }
    return true;
  }

  void finish() {
    const auto given_up = Clock::now() + kStuck;
    while (bus_.pending() > 0 && Clock::now() < given_up) {
      bus_.flush();
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }

 private:
  can::Bus& bus_;
  double rate_;
  Clock::time_point start_ = Clock::now();
  std::optional<Duration> first_;
};

/// Shows the log and, with a replayer, sends it.
Result<void> replay(std::istream& log, Replayer* replayer) {
  BusListener listener;
  end_at_signal();
  std::size_t number = 0;
  for (std::string line; !g_end_asked && std::getline(log, line);) {
    ++number;
    if (line.empty()) continue;
    const auto entry = can::parse_candump(line);
    if (!entry) return Error{fmt::format("line {}: {}", number, entry.error().message)};
    print_lines(listener, entry->frame);
    if (replayer == nullptr) continue;
    const auto sent = replayer->send(entry->frame);
    if (!sent) return Error{fmt::format("line {}: {}", number, sent.error().message)};
    if (!*sent) break;
  }
  if (replayer != nullptr) replayer->finish();
  fmt::print("{}", listener.summary());
  return {};
}

}  // namespace

int dump_can(const CanDumpArguments& arguments) {
  auto bus = can::open(arguments.bus);
  if (!bus) {
    fmt::print(stderr, "{}\n", bus.error().message);
    return kExitBadInput;
  }
  return dump(**bus, arguments);
}

int replay_can(const CanReplayArguments& arguments) {
  std::ifstream log{arguments.log};
  if (!log) {
    fmt::print(stderr, "{}: cannot be read\n", arguments.log.string());
    return kExitBadInput;
  }
  std::unique_ptr<can::Bus> bus;
  std::optional<Replayer> replayer;
  if (!arguments.bus.empty()) {
    auto opened = can::open(arguments.bus);
    if (!opened) {
      fmt::print(stderr, "{}\n", opened.error().message);
      return kExitBadInput;
    }
    bus = std::move(*opened);
    replayer.emplace(*bus, arguments.rate);
  }
  if (const auto done = replay(log, replayer ? &*replayer : nullptr); !done) {
    fmt::print(stderr, "{}, {}\n", arguments.log.string(), done.error().message);
    return kExitBadInput;
  }
  return kExitHeld;
}

}  // namespace skein::hil
