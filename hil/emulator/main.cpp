// SPDX-License-Identifier: Apache-2.0
#include <netinet/in.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "arguments.hpp"
#include "skein/can/bus.hpp"
#include "skein/hil/emulated_flight_controller.hpp"
#include "skein/system/descriptor.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;

constexpr int kExitCannotStart = 3;

/// Time since the program began.
class Clock {
 public:
  [[nodiscard]] Instant now() const { return Instant{std::chrono::steady_clock::now() - steady_}; }
  [[nodiscard]] std::int64_t unix_ns() const { return unix_ns_; }

 private:
  std::chrono::steady_clock::time_point steady_ = std::chrono::steady_clock::now();
  std::int64_t unix_ns_ =
      std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count();
};

/// Standard input, a line at a time, until it ends.
class Lines {
 public:
  [[nodiscard]] int descriptor() const { return ended_ ? -1 : STDIN_FILENO; }
  void read_some() {
    std::array<char, 256> bytes{};
    const ssize_t size = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    ended_ = size <= 0;
    if (size > 0) text_.append(bytes.data(), static_cast<std::size_t>(size));
  }
  std::optional<std::string> next() {
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }

 private:
  std::string text_;
  bool ended_ = false;
};

/// SIGINT and SIGTERM as something to poll.
int signals_descriptor() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGINT);
  ::sigaddset(&set, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_CLOEXEC);
}

/// Tells the truth to whoever judges.
class TruthSender {
 public:
  explicit TruthSender(std::uint16_t port)
      : socket_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)} {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }

  void step(EmulatedFlightController& of, Instant now) {
    if (now < next_) return;
    next_ = next_multiple(now, kPeriod);
    const auto packet = of.truth();
    (void)::sendto(socket_.get(), packet.data(), packet.size(), 0,
                   reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  static constexpr Duration kPeriod = 50ms;
  system::Descriptor socket_;
  sockaddr_in to_{};
  Instant next_{};
};

class Program {
 public:
  Program(std::unique_ptr<can::Bus> bus, EmulatedFlightController controller, const Clock& clock,
          std::deque<std::pair<Instant, std::string>> script,
          std::optional<std::uint16_t> truth_port)
      : bus_{std::move(bus)},
        controller_{std::move(controller)},
        clock_{clock},
        script_{std::move(script)} {
    if (truth_port) truth_.emplace(*truth_port);
  }

  void run(int signals) {
    while (true) {
      const Instant now = clock_.now();
      while (const auto frame = bus_->receive()) controller_.on_frame(*frame, now);
      while (!script_.empty() && script_.front().first <= now) {
        interfere(script_.front().second, now);
        script_.pop_front();
      }
      while (const auto line = lines_.next()) interfere(*line, now);
      controller_.step(now);
      if (truth_) truth_->step(controller_, now);
      for (auto frames = controller_.front(); !frames.empty(); frames = controller_.front()) {
        // What a bus refuses is lost, as it is to an ArduPilot after 20 ms.
        (void)bus_->send(frames);
        controller_.pop();
      }
      bus_->flush();
      if (wait(signals)) return;
    }
  }

 private:
  void interfere(const std::string& line, Instant now) {
    const auto done = controller_.interfere(line, now);
    if (!done) std::fprintf(stderr, "skein-fc: %s\n", done.error().message.c_str());
  }

  /// Until there is something to do. True when asked to end.
  bool wait(int signals) {
    Instant until = controller_.next_timeout();
    if (!script_.empty()) until = std::min(until, script_.front().first);
    Duration left = std::max(until - clock_.now(), Duration{});
    if (bus_->pending() > 0) left = std::min<Duration>(left, 1ms);
    const timespec timeout{.tv_sec = static_cast<time_t>(left / 1s),
                           .tv_nsec = static_cast<long>((left % 1s).count())};
    std::array<pollfd, 3> items{pollfd{bus_->descriptor(), POLLIN, 0},
                                pollfd{lines_.descriptor(), POLLIN, 0}, pollfd{signals, POLLIN, 0}};
    (void)::ppoll(items.data(), items.size(), &timeout, nullptr);
    if (items[1].revents != 0) lines_.read_some();
    return items[2].revents != 0;
  }

  std::unique_ptr<can::Bus> bus_;
  EmulatedFlightController controller_;
  const Clock& clock_;
  std::deque<std::pair<Instant, std::string>> script_;
  Lines lines_;
  std::optional<TruthSender> truth_;
};

int fly(FcArguments arguments) {
  const int signals = signals_descriptor();
  const Clock clock;
  EmulatorConfig& config = arguments.config;
  config.unix_us = clock.unix_ns() / 1000;
  if (arguments.hold_until_unix_ns) {
    config.hold_until = Instant{Duration{*arguments.hold_until_unix_ns - clock.unix_ns()}};
  }
  auto bus = can::open(arguments.bus);
  if (!bus) {
    std::fprintf(stderr, "skein-fc: %s\n", bus.error().message.c_str());
    return kExitCannotStart;
  }
  auto controller = EmulatedFlightController::make(config, clock.now());
  if (!controller) {
    std::fprintf(stderr, "skein-fc: %s\n", controller.error().message.c_str());
    return kExitCannotStart;
  }
  const Instant script_from = std::max(config.hold_until, Instant{});
  std::deque<std::pair<Instant, std::string>> script;
  for (auto& [after, line] : arguments.script) {
    script.emplace_back(script_from + after, std::move(line));
  }
  std::printf("ready: node %d on %s for node %d, MAVLink system %d\n", config.node_id,
              arguments.bus.c_str(), config.companion_node, config.system_id);
  std::fflush(stdout);
  Program{std::move(bus).value(), std::move(controller).value(), clock, std::move(script),
          arguments.truth_port}
      .run(signals);
  return 0;
}

}  // namespace
}  // namespace skein::hil

int main(int argc, char** argv) {
  auto arguments = skein::hil::parse_arguments(argc, argv);
  if (const int* const status = std::get_if<int>(&arguments)) return *status;
  return skein::hil::fly(std::move(*std::get_if<skein::hil::FcArguments>(&arguments)));
}
