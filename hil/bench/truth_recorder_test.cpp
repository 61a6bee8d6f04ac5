// SPDX-License-Identifier: Apache-2.0
#include "truth_recorder.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "skein/base/angles.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"
#include "skein/recording/reader.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kVehicle{7};
constexpr std::uint8_t kSystem = 3;
constexpr double kGeoid_m = 40.0;
const Wgs84 kOrigin{31.5, 105.0, 480.0};

/// A simulator's end of the link.
class Simulator {
 public:
  explicit Simulator(std::uint16_t port) : socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    const timeval limit{60, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  ~Simulator() { close(socket_); }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  template <class Message>
  void say(const Message& message, std::uint8_t system = kSystem) {
    mavlink::Encoder encoder{system, mavlink::kComponentAutopilot};
    const auto packet = encoder.encode(message);
    EXPECT_EQ(send(socket_, packet.begin(), packet.size(), 0), static_cast<ssize_t>(packet.size()));
  }
  /// The next command that it is given.
  std::optional<mavlink::CommandLong> command() {
    std::array<std::uint8_t, 512> bytes{};
    const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
    std::optional<mavlink::CommandLong> command;
    if (count > 0) {
      parser_.parse({bytes.data(), static_cast<std::size_t>(count)},
                    [&](const mavlink::Packet& packet) {
                      command = mavlink::decode<mavlink::CommandLong>(packet);
                    });
    }
    return command;
  }

 private:
  int socket_;
  mavlink::Parser parser_;
};

class TruthRecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-truth-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    auto opened = TruthRecorder::open({{kVehicle, kSystem, kGeoid_m}}, kOrigin);
    ASSERT_TRUE(opened) << opened.error().message;
    recorder_ = std::move(opened).value();
    simulator_.emplace(recorder_->port(kVehicle));
    ASSERT_TRUE(recorder_->record(folder_, recording::Session::kEpochOfTests,
                                  [] { return Instant{} + 12s; }));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// What was recorded until now; it records no more.
  recording::Recording recorded() {
    recorder_.reset();
    const auto all = recording::read_run(folder_ / kTruthFolder);
    EXPECT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->size(), 1U);
    return all->at(0);
  }

  std::filesystem::path folder_;
  std::unique_ptr<TruthRecorder> recorder_;
  std::optional<Simulator> simulator_;
};

TEST_F(TruthRecorderTest, AsksASimulatorThatSaysOtherThings) {
  simulator_->say(mavlink::Heartbeat{});
  const auto command = simulator_->command();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->command, static_cast<std::uint16_t>(mavlink::Command::set_message_interval));
  EXPECT_EQ(command->target_system, kSystem);
  EXPECT_EQ(command->param1, 108.0F);
}

TEST_F(TruthRecorderTest, RecordsWhereTheAircraftReallyIsInTheMissionsFrame) {
  mavlink::SimState told;
  told.lat_int = 315'010'000;
  told.lon_int = 1'050'010'000;
  told.alt = 740.0F;  // above the geoid
  told.yaw = static_cast<float>(radians(90.0));
  told.vn = 3.0F;
  told.ve = 4.0F;
  told.vd = -1.0F;
  simulator_->say(told, kSystem + 1);  // another's
  simulator_->say(told);
  simulator_->say(mavlink::Heartbeat{});
  ASSERT_TRUE(simulator_->command());  // it asks again after a second, and has heard all that
  const recording::Recording recording = recorded();
  ASSERT_EQ(recording.vehicle, kVehicle);
  ASSERT_EQ(recording.track.size(), 1U);
  const VehicleState& state = recording.track[0].state;
  EXPECT_EQ(state.time, Instant{} + 12s);
  EXPECT_NEAR(state.x_m, 95.0, 0.2);    // 0.001 deg of longitude at 31.5 N
  EXPECT_NEAR(state.y_m, 110.87, 0.2);  // and of latitude
  EXPECT_NEAR(state.z_m, 300.0, 1e-3);
  EXPECT_NEAR(state.groundspeed_mps, 5.0, 1e-6);
  EXPECT_NEAR(state.course_rad, std::atan2(3.0, 4.0), 1e-6);
  EXPECT_NEAR(state.heading_rad, 0.0, 1e-6);  // east
  EXPECT_NEAR(state.climb_mps, 1.0, 1e-6);
}

}  // namespace
}  // namespace skein::hil
