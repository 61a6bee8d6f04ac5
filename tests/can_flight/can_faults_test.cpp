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
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "operator_desk.hpp"
#include "skein/can/bus.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/hil/child_process.hpp"

namespace skein {
namespace {

using std::chrono::steady_clock;
using std::chrono::system_clock;
using namespace std::chrono_literals;

constexpr auto kPatience = 60s;  // for each wait, on a loaded machine
/// Far above what is measured on an idle machine; the exact limits are those of can_flight_test.
constexpr double kLoadedMachine_s = 5.0;
constexpr VehicleId kVehicle{7};

constexpr const char* kFlying = "flying the companion's setpoints";
/// Said where frames end: of them or, where the autopilot's last bytes came a moment before the
/// last frame, of these.
constexpr const char* kLost = "no frame comes from the flight controller";
constexpr const char* kSilent = "the autopilot is silent";
constexpr const char* kPiloted = "the mode was changed to RTL by the pilot";
constexpr const char* kRebooted = "the autopilot has rebooted";

class CanFaults : public ::testing::Test {
 protected:
  CanFaults() {
    std::filesystem::create_directories(folder_);
    EXPECT_EQ(::mkfifo(fifo().c_str(), 0600), 0);
  }
  void TearDown() override {
    if (input_ >= 0) ::close(input_);
    if (HasFailure()) std::printf("%s\n", log().c_str());
    flight_controller_.reset();
    vehicle_.reset();
    std::filesystem::remove_all(folder_);
  }

  [[nodiscard]] std::string fifo() const { return folder_ / "pilot"; }
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(system_clock::now() - epoch_).count();
  }

  void start_flight_controller() {
    // A shell, so that it reads what the pilot types from a pipe with a name.
    const std::string command =
        "exec '" SKEIN_FC "' --bus " + bus_ +
        " --failsafe --airborne --mode LOITER --start 0 0 300 --origin 31.5 105 480 <'" + fifo() +
        "'";
    auto started = hil::ChildProcess::start({"/bin/sh", "-c", command}, folder_ / "fc", {});
    ASSERT_TRUE(started.ok());
    flight_controller_ = std::make_unique<hil::ChildProcess>(std::move(started).value());
    if (input_ >= 0) ::close(input_);
    input_ = ::open(fifo().c_str(), O_WRONLY | O_CLOEXEC);
    ASSERT_GE(input_, 0);
  }
  void pilot(const std::string& line) const {
    const std::string text = line + "\n";
    ASSERT_EQ(::write(input_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  void start_vehicle() {
    configuration::VehicleConfig config;
    config.vehicle.id = kVehicle;
    config.vehicle.cruise_speed_mps = 50.0;
    config.vehicle.speed_min_mps = 40.0;
    config.vehicle.speed_max_mps = 70.0;
    config.vehicle.turn_radius_m = 150.0;
    config.vehicle.range_m = 40000.0;
    config.vehicle.capabilities.add(TaskKind::survey);
    config.vehicle.sensor_radius_m = 300.0;
    config.vehicle.height_m = 300.0;
    config.origin = {31.5, 105.0, 480.0};
    config.search = {{0.0, 1500.0}};
    config.flight_controller.kind = configuration::FlightControllerKind::ardupilot;
    config.flight_controller.ardupilot.can = bus_;
    config.flight_controller.ardupilot.take_over = configuration::TakeOverKind::in_flight;
    config.network = operator_.network_of(kVehicle);
    config.time.epoch_unix_ns = std::chrono::nanoseconds{epoch_.time_since_epoch()}.count();
    std::ofstream{folder_ / "v.yaml"} << to_yaml(config);
    auto started = hil::ChildProcess::start({SKEIN_ONBOARD, "--config", folder_ / "v.yaml"},
                                            folder_ / "log", {});
    ASSERT_TRUE(started.ok());
    vehicle_ = std::make_unique<hil::ChildProcess>(std::move(started).value());
  }
  [[nodiscard]] std::string log() const {
    std::ifstream file{folder_ / "log"};
    return {std::istreambuf_iterator<char>{file}, {}};
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

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("skein-can-faults-" + std::to_string(::getpid()));
  /// Not one of the first, which others use.
  std::string bus_ = "mcast:" + std::to_string(128 + ::getpid() % 127);
  system_clock::time_point epoch_ = system_clock::now();
  int input_ = -1;
  std::size_t read_ = 0;
  std::unique_ptr<hil::ChildProcess> flight_controller_;
  std::unique_ptr<hil::ChildProcess> vehicle_;
  OperatorDesk operator_{kVehicle, epoch_};
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
