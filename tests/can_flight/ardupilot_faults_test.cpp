// SPDX-License-Identifier: Apache-2.0
//
// A vehicle with a user's own ArduPlane or ArduCopter, which SKEIN_ARDUPLANE and SKEIN_ARDUCOPTER
// name: what goes wrong between them in the air, one thing after another in one flight. Prints how
// each was noticed, and how it ended. The autopilot speaks on mcast:0, so it gets a network of its
// own.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "onboard_test.hpp"
#include "skein/base/random.hpp"
#include "skein/can/bus.hpp"
#include "skein/hil/bench.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"
#include "skein/mavlink/parser.hpp"
#include "user_autopilots.hpp"

namespace skein {
namespace {

using std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr const char* kCompanionBus = "mcast:77";
constexpr const char* kPiloted = "the mode was changed to RTL by the pilot or a failsafe";
constexpr const char* kLands = "the mode was changed to LAND by the pilot or a failsafe";
constexpr const char* kWouldNotArm = "the autopilot would not arm: ";
constexpr const char* kTakesOff = "taking off";
constexpr VehicleId kVehicle{1};
constexpr double kNoticed_s = 2.0;  // 0.1 s and what a loaded machine takes

struct Craft {
  const char* variable;  ///< of the environment
  Airframe airframe;
  float rtl;
  double speed_mps;
  double turn_radius_m;
  /// Said within 20 s without GNSS, and the aircraft is its pilot's; else it is flown on for 10 s,
  /// by what its filter makes of its airspeed.
  const char* without_gnss;
};
constexpr Craft kPlane{"SKEIN_ARDUPLANE", Airframe::plane, 11.0F, 25.0, 100.0, nullptr};
constexpr Craft kCopter{"SKEIN_ARDUCOPTER", Airframe::copter, 6.0F, 7.0, 30.0, kLands};

std::string name_of(const testing::TestParamInfo<Craft>& craft) {
  return std::string{to_string(craft.param.airframe)};
}

/// Carries frames between the autopilot's bus and the companion's: all, none, or a share.
class Bridge {
 public:
  Bridge(std::unique_ptr<can::Bus> a, std::unique_ptr<can::Bus> b)
      : a_{std::move(a)}, b_{std::move(b)}, thread_{[this] { run(); }} {}
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;
  ~Bridge() {
    stop_ = true;
    thread_.join();
  }
  /// 1: it is cut.
  void lose(double share) { lost_ = share; }

 private:
  void carry(can::Bus& from, can::Bus& to) {
    while (const auto frame = from.receive()) {
      if (!random_.chance(lost_) && !frame->error) (void)to.send({&*frame, 1});
    }
    to.flush();
  }
  void run() {
    while (!stop_) {
      carry(*a_, *b_);
      carry(*b_, *a_);
      std::this_thread::sleep_for(500us);
    }
  }
  std::unique_ptr<can::Bus> a_;
  std::unique_ptr<can::Bus> b_;
  Random random_{1};  // of the thread
  std::atomic<double> lost_{0.0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The pilot's own link: answers whoever speaks to it.
class Pilot {
 public:
  Pilot() {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof own;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), size), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size), 0);
    port_ = ntohs(own.sin_port);
  }
  Pilot(const Pilot&) = delete;
  Pilot& operator=(const Pilot&) = delete;
  ~Pilot() { ::close(socket_); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Until the autopilot has answered.
  void order(mavlink::Command what, float param1, float param2 = 0.0F, float param6 = 0.0F) {
    mavlink::CommandLong command;
    command.command = static_cast<std::uint16_t>(what);
    command.param1 = param1;
    command.param2 = param2;
    command.param6 = param6;
    command.target_system = command.target_component = 1;
    say(command, [&](const mavlink::Packet& packet) {
      const auto ack = mavlink::decode<mavlink::CommandAck>(packet);
      return ack && ack->command == command.command;
    });
  }
  void set_parameter(const char* name, float value) {
    mavlink::ParamSet set;
    set.param_id = mavlink::field_of<16>(name);
    set.param_value = value;
    set.param_type = static_cast<std::uint8_t>(mavlink::ParamType::real32);
    set.target_system = set.target_component = 1;
    say(set, [&](const mavlink::Packet& packet) {
      const auto told = mavlink::decode<mavlink::ParamValue>(packet);
      return told && mavlink::text_of(told->param_id) == name && told->param_value == value;
    });
  }

 private:
  template <class Message, class IsAnswer>
  void say(const Message& message, const IsAnswer& is_answer) {
    const auto until = steady_clock::now() + 20s;
    auto again = steady_clock::now();
    while (steady_clock::now() < until) {
      std::array<std::uint8_t, 1024> buffer;
      sockaddr_in peer{};
      socklen_t size = sizeof peer;
      const auto got = ::recvfrom(socket_, buffer.data(), buffer.size(), 0,
                                  reinterpret_cast<sockaddr*>(&peer), &size);
      if (got <= 0) continue;
      bool answered = false;
      parser_.parse(std::span{buffer}.first(static_cast<std::size_t>(got)),
                    [&](const auto& packet) { answered = answered || is_answer(packet); });
      if (answered) return;
      if (steady_clock::now() < again) continue;
      again = steady_clock::now() + 1s;
      const auto bytes = encoder_.encode(message);
      (void)::sendto(socket_, &*bytes.begin(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&peer), size);
    }
    ADD_FAILURE() << "the autopilot does not answer its pilot";
  }

  mavlink::Parser parser_;
  int socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::uint16_t port_ = 0;
  mavlink::Encoder encoder_{255, 190};
};

class ArdupilotFaults : public OnboardTest, public testing::WithParamInterface<Craft> {
 protected:
  ArdupilotFaults() : OnboardTest{kVehicle, "ardupilot-faults"} {
    VehicleSpec& vehicle = config_.vehicle;
    vehicle.airframe = GetParam().airframe;
    vehicle.cruise_speed_mps = GetParam().speed_mps;
    vehicle.speed_min_mps = 0.8 * GetParam().speed_mps;
    vehicle.speed_max_mps = 1.2 * GetParam().speed_mps;
    vehicle.turn_radius_m = GetParam().turn_radius_m;
    vehicle.sensor_radius_m = 1.3 * GetParam().turn_radius_m;
    vehicle.height_m = 100.0;
    config_.origin = {31.522062, 105.044327, 480.0};
    config_.search = {{0.0, 800.0}};
    config_.flight_controller.ardupilot.can = hil::kAutopilotBus;
    config_.flight_controller.ardupilot.take_over = configuration::TakeOverKind::from_ground;
  }
  void TearDown() override {
    autopilot_.reset();
    OnboardTest::TearDown();
  }
  void boot(const char* program) {
    pilot_ = std::make_unique<Pilot>();
    auto a = can::open(hil::kAutopilotBus);
    auto b = can::open(kCompanionBus);
    ASSERT_TRUE(a.ok() && b.ok());
    hil::UserAutopilots autopilots;
    (GetParam().airframe == Airframe::copter ? autopilots.copter : autopilots.plane) =
        std::filesystem::absolute(program);
    const auto command =
        hil::autopilot_command(autopilots, config_, 1, pilot_->port(), folder_ / "fc");
    ASSERT_TRUE(command.ok()) << command.error().message;
    autopilot_ = start(*command, "fc.log");
    ASSERT_TRUE(autopilot_);
    const auto up = hil::await_autopilot(config_, *autopilot_, folder_ / "fc.log");
    ASSERT_TRUE(up.ok()) << up.error().message;
    bridge_ = std::make_unique<Bridge>(std::move(a).value(), std::move(b).value());
    config_.flight_controller.ardupilot.can = kCompanionBus;
    operator_.open();
    start_vehicle();
  }
  /// When the vehicle says that, mission time, after what was waited for before.
  double wait_for(const std::string& words, std::chrono::seconds patience = 60s,
                  const std::string& or_words = {}) {
    const auto until = steady_clock::now() + patience;
    while (steady_clock::now() < until) {
      const std::string text = log();
      auto at = text.find(words, read_);
      if (!or_words.empty()) at = std::min(at, text.find(or_words, read_));
      if (at != std::string::npos) {
        read_ = at + 1;
        return now_s();
      }
      operator_.hear();
      std::this_thread::sleep_for(2ms);
    }
    ADD_FAILURE() << "never said: " << words;
    return 1e9;
  }
  /// What was not said for so long is taken not to be said.
  [[nodiscard]] bool stays_unsaid(const std::string& words, std::chrono::seconds length) {
    const auto until = steady_clock::now() + length;
    while (steady_clock::now() < until) {
      operator_.hear();
      if (log().find(words, read_) != std::string::npos) return false;
      std::this_thread::sleep_for(20ms);
    }
    return true;
  }
  void give_back() { operator_.give_back(now_s()); }
  /// The fault lasts that long; then `ends` is said.
  void cut_for(std::chrono::milliseconds length, const char* ends) {
    const auto begin = steady_clock::now();
    const double begin_s = now_s();
    bridge_->lose(1.0);
    const double noticed_s = wait_for(kLost, 60s, kSilent) - begin_s;
    std::this_thread::sleep_until(begin + length);
    const double end_s = now_s();
    bridge_->lose(0.0);
    const double over_s = wait_for(ends) - end_s;
    EXPECT_LE(noticed_s, kNoticed_s);
    std::printf("bus cut for %.1f s: noticed after %.0f ms; %.0f ms after its end: %s\n",
                1e-3 * static_cast<double>(length.count()), 1e3 * noticed_s, 1e3 * over_s, ends);
  }

  /// A third of each second there is no link.
  void give_back_on_a_flapping_link() {
    const double begin_s = now_s();
    give_back();
    const auto flies = [this] { return log().find(kFlying, read_) != std::string::npos; };
    for (int i = 0; i < 20 && !flies(); ++i) {
      bridge_->lose(1.0);
      std::this_thread::sleep_for(300ms);
      bridge_->lose(0.0);
      std::this_thread::sleep_for(700ms);
      give_back();
    }
    std::printf("given back on a flapping link: flown on after %.1f s\n",
                wait_for(kFlying) - begin_s);
  }

  void lose_gnss() {
    const double begin_s = now_s();
    pilot_->set_parameter("SIM_GPS_DISABLE", 1.0F);
    if (GetParam().without_gnss != nullptr) {
      std::printf("no GNSS: %s after %.1f s\n", GetParam().without_gnss,
                  wait_for(GetParam().without_gnss, 20s) - begin_s);
      pilot_->set_parameter("SIM_GPS_DISABLE", 0.0F);
      give_back_until(kFlying);
      return;
    }
    EXPECT_TRUE(stays_unsaid("the mode was changed", 10s));
    pilot_->set_parameter("SIM_GPS_DISABLE", 0.0F);
    std::printf("no GNSS for 10 s: flown on\n");
  }
  /// It is refused until the filter knows again where it is.
  void give_back_until(const char* words) {
    const double begin_s = now_s();
    const auto said = [this, words] { return log().find(words, read_) != std::string::npos; };
    for (int i = 0; i < 30 && !said(); ++i) {
      give_back();
      (void)stays_unsaid(words, 1s);
    }
    std::printf("given back: flown on after %.1f s\n", wait_for(words) - begin_s);
  }

  std::unique_ptr<Pilot> pilot_;  ///< in the autopilot's network
  Process autopilot_;
  std::unique_ptr<Bridge> bridge_;
};

TEST_P(ArdupilotFaults, EndAsTheDocumentSays) {
  // One thread yet. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* program = std::getenv(GetParam().variable);
  if (program == nullptr) {
    GTEST_SKIP() << "no ArduPilot: set " << GetParam().variable
                 << " to the path of one (docs/ardupilot.md)";
  }
  const auto kept = hil::keep_autopilots_on_loopback(false);
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  boot(program);
  if (HasFatalFailure()) return;
  wait_for(kWouldNotArm, 30s);
  std::printf("arming refused: told %.1f s after the start\n", now_s());
  wait_for(kFlying, 240s);
  if (HasFailure()) return;

  cut_for(300ms, kFlying);
  cut_for(2s, kFlying);
  bridge_->lose(0.05);
  EXPECT_TRUE(stays_unsaid("the mode was changed", 10s));
  bridge_->lose(0.0);
  read_ = log().size();
  EXPECT_TRUE(stays_unsaid("the mode was changed", 1s));
  read_ = log().size();  // it was silent and heard again many times
  std::printf("5 %% of the frames lost for 10 s: flown on\n");

  // FS_LONG_TIMEOUT and FS_GCS_TIMEOUT are 5 s: the autopilot returns by itself.
  cut_for(6s, kPiloted);
  EXPECT_TRUE(stays_unsaid(kFlying, 2s));
  double begin = now_s();
  give_back();
  std::printf("given back: flown on after %.0f ms\n", 1e3 * (wait_for(kFlying) - begin));

  begin = now_s();
  pilot_->order(mavlink::Command::do_set_mode, 1.0F, GetParam().rtl);
  const double piloted_s = wait_for(kPiloted) - begin;
  EXPECT_LE(piloted_s, kNoticed_s);
  std::printf("the pilot switches to RTL: noticed after %.0f ms\n", 1e3 * piloted_s);
  bridge_->lose(1.0);
  EXPECT_TRUE(stays_unsaid(kFlying, 2s));
  bridge_->lose(0.0);
  EXPECT_TRUE(stays_unsaid(kFlying, 3s)) << "the link is back, and the aircraft its pilot's";

  give_back_on_a_flapping_link();

  lose_gnss();

  begin = now_s();
  pilot_->set_parameter("BATT_CAPACITY", 100.0F);
  std::printf("low battery: comes home after %.1f s\n",
              wait_for("flies home: its battery leaves") - begin);

  constexpr float kInFlight = 20190226.0F;
  pilot_->order(mavlink::Command::preflight_reboot_shutdown, 1.0F, 0.0F, kInFlight);
  begin = now_s();
  std::printf("reboot: noticed after %.1f s\n", wait_for(kRebooted) - begin);
  EXPECT_TRUE(stays_unsaid(kTakesOff, 40s)) << "nobody launches it a second time";
}

INSTANTIATE_TEST_SUITE_P(Crafts, ArdupilotFaults, testing::Values(kPlane, kCopter), name_of);

}  // namespace
}  // namespace skein
