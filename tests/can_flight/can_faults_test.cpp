// SPDX-License-Identifier: Apache-2.0
//
// One vehicle with its flight controller on a bus, as real processes in real time, and what can go
// wrong between them. Prints how long each fault took to be noticed and to be over.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "onboard_test.hpp"
#include "skein/can/bus.hpp"

namespace skein {
namespace {

using std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kPatience = 60s;  // for each wait, on a loaded machine
/// Far above what is measured on an idle machine; the exact limits are those of can_flight_test.
constexpr double kLoadedMachine_s = 5.0;
constexpr VehicleId kVehicle{7};

constexpr const char* kPiloted = "the mode was changed to RTL by the pilot";

class CanFaults : public OnboardTest {
 protected:
  CanFaults() : OnboardTest{kVehicle, "can-faults"} {
    EXPECT_EQ(::mkfifo(fifo().c_str(), 0600), 0);
    VehicleSpec& plane = config_.vehicle;
    plane.cruise_speed_mps = 50.0;
    plane.speed_min_mps = 40.0;
    plane.speed_max_mps = 70.0;
    plane.turn_radius_m = 150.0;
    plane.sensor_radius_m = 300.0;
    plane.height_m = 300.0;
    config_.origin = {31.5, 105.0, 480.0};
    config_.search = {{0.0, 1500.0}};
    config_.flight_controller.ardupilot.can = bus_;
    config_.flight_controller.ardupilot.take_over = configuration::TakeOverKind::in_flight;
  }
  void TearDown() override {
    if (input_ >= 0) ::close(input_);
    OnboardTest::TearDown();
  }

  [[nodiscard]] std::string fifo() const { return folder_ / "pilot"; }

  void start_flight_controller() {
    // A shell, so that it reads what the pilot types from a pipe with a name.
    const std::string command =
        "exec '" SKEIN_FC "' --bus " + bus_ +
        " --failsafe --airborne --mode LOITER --start 0 0 300 --origin 31.5 105 480 <'" + fifo() +
        "'";
    flight_controller_ = start({"/bin/sh", "-c", command}, "fc");
    ASSERT_TRUE(flight_controller_);
    if (input_ >= 0) ::close(input_);
    input_ = ::open(fifo().c_str(), O_WRONLY | O_CLOEXEC);
    ASSERT_GE(input_, 0);
  }
  void pilot(const std::string& line) const {
    const std::string text = line + "\n";
    ASSERT_EQ(::write(input_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  /// When the flight controller's next word with that beginning was said, mission time. Words
  /// before it are over then.
  std::optional<double> wait_for(const std::string& words) {
    const std::string label = "flight controller, ";
    const auto until = steady_clock::now() + kPatience;
    while (steady_clock::now() < until) {
      const std::string text = log();
      for (auto at = text.find(label, read_); at != std::string::npos;
           at = text.find(label, at + 1)) {
        const auto colon = text.find(": ", at);
        const auto says = [&](const std::string& what) {
          return text.compare(colon + 2, what.size(), what) == 0;
        };
        if (colon == std::string::npos) continue;
        if (!says(words) && !(words == kLost && says(kSilent))) continue;
        read_ = colon;
        return std::stod(text.substr(at + label.size()));
      }
      operator_.hear();
      std::this_thread::sleep_for(2ms);
    }
    ADD_FAILURE() << "never said: " << words;
    return std::nullopt;
  }
  /// The fault begins now: how long until these words.
  double noticed_within(const std::string& words, double since_s) {
    const auto at = wait_for(words);
    const double taken = at ? *at - since_s : 1e9;
    EXPECT_LE(taken, kLoadedMachine_s) << words;
    return taken;
  }

  /// Not one of the first, which others use.
  std::string bus_ = "mcast:" + std::to_string(128 + ::getpid() % 127);
  int input_ = -1;
  Process flight_controller_;
};

TEST_F(CanFaults, AreNoticedAndFlownOnFrom) {
  if (const auto bus = can::open(bus_); !bus) GTEST_SKIP() << bus.error().message;
  operator_.open();
  start_flight_controller();
  start_vehicle();
  ASSERT_TRUE(wait_for(kFlying));
  const auto print = [](const char* what, double noticed_s, double over_s, const char* how) {
    std::printf("%-40s noticed after %4.0f ms, flown on %5.0f ms after %s\n", what, 1e3 * noticed_s,
                1e3 * over_s, how);
  };

  double begin = now_s();
  flight_controller_->signal(SIGSTOP);  // no frame comes, as from a bus that is off or unplugged
  const double lost = noticed_within(kLost, begin);
  begin = now_s();
  flight_controller_->signal(SIGCONT);
  print("no frame on the bus", lost, noticed_within(kFlying, begin), "its end");

  begin = now_s();
  pilot("silent on");
  const double silent = noticed_within(kLost, begin);
  begin = now_s();
  pilot("silent off");
  print("the autopilot falls silent", silent, noticed_within(kFlying, begin), "its end");

  begin = now_s();
  pilot("mode RTL");
  const double piloted = noticed_within(kPiloted, begin);
  if (HasFailure()) return;  // nothing to answer
  operator_.give_back(begin + piloted);
  begin = now_s();
  print("the pilot switches to RTL", piloted, noticed_within(kFlying, begin), "it is given back");

  // Nodes tell their uptime in whole seconds: younger than that a reboot does not show.
  while (now_s() < 5.0) std::this_thread::sleep_for(20ms);
  begin = now_s();
  pilot("reboot");
  const double rebooting = noticed_within(kLost, begin);
  const auto rebooted = wait_for(kRebooted);
  const auto flying = wait_for(kFlying);
  ASSERT_TRUE(rebooted && flying);
  print("the autopilot reboots", rebooting, *flying - *rebooted, "it is heard again");

  begin = now_s();
  flight_controller_->signal(SIGKILL);
  const double killed = noticed_within(kLost, begin);
  start_flight_controller();
  const auto found = wait_for(kRebooted);
  const auto again = wait_for(kFlying);
  ASSERT_TRUE(found && again);
  print("the autopilot dies, another takes over", killed, *again - *found, "it is heard first");

  vehicle_->signal(SIGTERM);
  ASSERT_TRUE(vehicle_->wait(kPatience));
  EXPECT_EQ(vehicle_->ended(), "exit status 0");
}

}  // namespace
}  // namespace skein
