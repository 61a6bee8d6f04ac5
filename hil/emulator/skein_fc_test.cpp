// SPDX-License-Identifier: Apache-2.0
// The program as a real process, on a multicast bus on loopback, in real time.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"
#include "skein/can/bus.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

/// For each wait: much longer than what is waited for takes on a loaded machine.
constexpr Duration kPatience = 60s;

/// skein-fc with pipes to its standard input and output. Killed when the object goes.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    std::array<int, 2> to{};
    std::array<int, 2> from{};
    EXPECT_EQ(::pipe2(to.data(), O_CLOEXEC), 0);
    EXPECT_EQ(::pipe2(from.data(), O_CLOEXEC), 0);
    arguments.insert(arguments.begin(), SKEIN_FC);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(to[0], STDIN_FILENO);
      ::dup2(from[1], STDOUT_FILENO);
      ::execv(words[0], words.data());
      ::_exit(127);
    }
    ::close(to[0]);
    ::close(from[1]);
    input_ = to[1];
    output_ = from[0];
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (!status_) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(input_);
    ::close(output_);
  }

  void write_line(const std::string& line) const {
    const std::string text = line + "\n";
    EXPECT_EQ(::write(input_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// The first line of its output, or what came before it ended or the patience did.
  [[nodiscard]] std::string read_line() const {
    std::string line;
    const auto deadline = SteadyClock::now() + kPatience;
    while (SteadyClock::now() < deadline) {
      pollfd item{output_, POLLIN, 0};
      char c = 0;
      if (::poll(&item, 1, 100) <= 0) continue;
      if (::read(output_, &c, 1) != 1 || c == '\n') break;
      line += c;
    }
    return line;
  }
  void signal(int number) const { ::kill(pid_, number); }
  /// Its exit status once it has ended; its output ends with it.
  int wait_for_end() {
    while (!read_line().empty()) continue;
    int status = 0;
    ::waitpid(pid_, &status, 0);
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return *status_;
  }

 private:
  pid_t pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  std::optional<int> status_;
};

/// A companion on the real bus, in real time.
class RealCompanion {
 public:
  explicit RealCompanion(const std::string& bus)
      : bus_{can::open(bus).value()}, node_{node_params(), now()}, port_{{}, now()} {}

  /// Until the condition holds, or the patience ends; calls `act` every 50 ms.
  template <class Condition, class Act>
  bool run_until(const Condition& condition, const Act& act) {
    const Instant deadline = now() + kPatience;
    while (!condition()) {
      if (now() >= deadline) return false;
      if (now() >= act_at_) {
        act_at_ = now() + 50ms;
        act();
      }
      if (now() >= heartbeat_at_) {
        heartbeat_at_ = now() + 1s;
        mavlink::Heartbeat heartbeat;
        heartbeat.type = static_cast<std::uint8_t>(mavlink::VehicleType::onboard_controller);
        send(heartbeat);
      }
      step();
    }
    return true;
  }
  template <class Message>
  void send(const Message& message) {
    EXPECT_TRUE(port_.write(encoder_.encode(message)));
  }
  template <class Message>
  [[nodiscard]] std::optional<Message> last() const {
    for (std::size_t i = packets_.size(); i > 0; --i) {
      if (const auto message = mavlink::decode<Message>(packets_[i - 1])) return message;
    }
    return std::nullopt;
  }
  [[nodiscard]] const mavlink::ParserStatistics& parser() const { return parser_.statistics(); }

 private:
  [[nodiscard]] static Instant now() { return Instant{SteadyClock::now().time_since_epoch()}; }
  static dronecan::NodeParams node_params() {
    dronecan::NodeParams params;
    params.node_id = 42;
    return params;
  }

  void step() {
    port_.step(node_, now());
    node_.step(now());
    for (auto frames = node_.front(); !frames.empty(); frames = node_.front()) {
      EXPECT_TRUE(bus_->send(frames));
      node_.pop();
    }
    bus_->flush();
    pollfd item{bus_->descriptor(), POLLIN, 0};
    (void)::poll(&item, 1, 10);
    while (const auto frame = bus_->receive()) {
      if (const auto* transfer = node_.on_frame(*frame, 0, now())) {
        port_.on_transfer(*transfer, node_.node_id(), now());
      }
      std::array<std::uint8_t, 256> bytes{};
      while (const std::size_t size = port_.read(bytes)) {
        parser_.parse(std::span{bytes}.first(size),
                      [this](const mavlink::Packet& p) { packets_.push_back(p); });
      }
    }
  }

  std::unique_ptr<can::Bus> bus_;
  dronecan::Node node_;
  dronecan::TunnelPort port_;
  mavlink::Encoder encoder_{1, mavlink::kComponentOnboardComputer};
  mavlink::Parser parser_;
  std::vector<mavlink::Packet> packets_;
  Instant heartbeat_at_;
  Instant act_at_;
};

/// One that no other test on this machine is likely to use.
std::string own_bus() { return "mcast:" + std::to_string(50 + ::getpid() % 40); }

TEST(SkeinFc, ACompanionTurnsItAndThePilotTakesItBack) {
  const std::string bus = own_bus();
  Process process{{"--bus", bus, "--airborne", "--start", "100", "-200", "300", "--no-noise"}};
  ASSERT_EQ(process.read_line().rfind("ready: node 10 on " + bus, 0), 0U);
  RealCompanion companion{bus};
  const auto nothing = [] {};
  const auto mode = [&] {
    const auto heartbeat = companion.last<mavlink::Heartbeat>();
    return heartbeat ? heartbeat->custom_mode : 99U;
  };
  const auto course_deg = [&] {
    const auto at = companion.last<mavlink::GlobalPositionInt>();
    if (!at) return 0.0;
    return degrees(std::atan2(static_cast<double>(at->vy), static_cast<double>(at->vx)));
  };
  ASSERT_TRUE(companion.run_until([&] { return mode() == 15; }, nothing));
  EXPECT_TRUE(companion.last<mavlink::Heartbeat>()->base_mode & mavlink::mode_safety_armed);

  mavlink::CommandLong streams;
  streams.command = static_cast<std::uint16_t>(mavlink::Command::set_message_interval);
  streams.param1 = static_cast<float>(mavlink::GlobalPositionInt::kDefinition.id);
  streams.param2 = 50000.0F;
  streams.target_system = 1;
  companion.send(streams);
  ASSERT_TRUE(companion.run_until([&] { return companion.last<mavlink::CommandAck>().has_value(); },
                                  nothing));
  EXPECT_EQ(companion.last<mavlink::CommandAck>()->result, 0);

  // It would orbit to the right by itself: this turns it to the left, on and on.
  const Eigen::Quaterniond q = attitude_from({.roll_rad = radians(-55.0)});
  mavlink::SetAttitudeTarget roll;
  roll.q = {static_cast<float>(q.w()), static_cast<float>(q.x()), 0.0F, 0.0F};
  roll.type_mask = mavlink::ignore_attitude | mavlink::ignore_thrust | mavlink::ignore_pitch_rate |
                   mavlink::ignore_body_yaw_rate;
  EXPECT_TRUE(companion.run_until([&] { return course_deg() < -20.0 && course_deg() > -170.0; },
                                  [&] { companion.send(roll); }));

  process.write_line("mode RTL");
  EXPECT_TRUE(companion.run_until([&] { return mode() == 11; }, nothing));
  EXPECT_EQ(companion.parser().bad_crc, 0U);
  EXPECT_EQ(companion.parser().unknown, 0U);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait_for_end(), 0);
}

TEST(SkeinFc, BadArgumentsAreStatusTwoAndABadBusThree) {
  EXPECT_EQ((Process{{"--node", "500"}}.wait_for_end()), 2);
  EXPECT_EQ((Process{{"--turn-radius", "20"}}.wait_for_end()), 2);
  EXPECT_EQ((Process{{"--at", "now"}}.wait_for_end()), 2);
  EXPECT_EQ((Process{{"--airborne", "--mode", "FLY", "--start", "0", "0", "50"}}.wait_for_end()),
            2);
  EXPECT_EQ((Process{{"--bus", "mcast:900"}}.wait_for_end()), 3);
}

}  // namespace
}  // namespace skein::hil
