// SPDX-License-Identifier: Apache-2.0
//
// A SocketCAN interface that goes down, is unplugged, and reports a controller's errors. It takes
// an interface of its own for that: SKEIN_CAN_SCRATCH_INTERFACE names one that may be broken.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "skein/can/bus.hpp"
#include "socket.hpp"

namespace skein::can {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr std::chrono::seconds kPatience{20};

class SocketCanFaults : public testing::Test {
 protected:
  void SetUp() override {
    // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
    const char* interface = std::getenv("SKEIN_CAN_SCRATCH_INTERFACE");
    if (interface == nullptr) GTEST_SKIP() << "no SKEIN_CAN_SCRATCH_INTERFACE to break";
    name_ = interface;
    auto bus = open(name_);
    ASSERT_TRUE(bus) << bus.error().message;
    bus_ = std::move(*bus);
    raw_ = Descriptor{::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)};
    ASSERT_TRUE(raw_);
  }

  /// Steps the bus as its user does, each millisecond, until it is in that state; how long it took.
  milliseconds until(State state) {
    const auto began = Clock::now();
    while (bus_->state() != state && Clock::now() - began < kPatience) {
      bus_->flush();
      while (bus_->receive()) continue;
      std::this_thread::sleep_for(milliseconds{1});
    }
    EXPECT_EQ(bus_->state(), state);
    return std::chrono::duration_cast<milliseconds>(Clock::now() - began);
  }

  void set_up(bool up) {
    ifreq request{};
    std::copy(name_.begin(), name_.end(), std::begin(request.ifr_name));
    ASSERT_EQ(::ioctl(raw_.get(), SIOCGIFFLAGS, &request), 0);
    request.ifr_flags =
        static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
    ASSERT_EQ(::ioctl(raw_.get(), SIOCSIFFLAGS, &request), 0) << "needs CAP_NET_ADMIN";
  }

  /// What a controller's driver tells of it.
  void report(canid_t error, std::uint8_t controller) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(name_.c_str()));
    ASSERT_EQ(::bind(raw_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    can_frame frame{};
    frame.can_id = CAN_ERR_FLAG | error;
    frame.can_dlc = CAN_ERR_DLC;
    frame.data[1] = controller;
    ASSERT_EQ(::write(raw_.get(), &frame, sizeof(frame)), ssize_t{sizeof(frame)});
  }

  std::string name_;
  std::unique_ptr<Bus> bus_;
  Descriptor raw_;
};

TEST_F(SocketCanFaults, AnInterfaceThatGoesDownIsNoticedAndTakenUpAgain) {
  Frame frame;
  frame.id = 1;
  ASSERT_TRUE(bus_->send(frame));
  for (int i = 1; i <= 3; ++i) {
    set_up(false);
    const auto noticed = until(State::gone);
    EXPECT_FALSE(bus_->send(frame));
    set_up(true);
    const auto back = until(State::error_active);
    EXPECT_TRUE(bus_->send(frame));
    std::cout << "down: noticed after " << noticed.count() << " ms, taken up again after "
              << back.count() << " ms\n";
    EXPECT_EQ(bus_->statistics().restarts, static_cast<std::uint64_t>(i));
  }
  auto other = open(name_);
  ASSERT_TRUE(other);
  ASSERT_TRUE(bus_->send(frame));
  const auto deadline = Clock::now() + kPatience;
  std::optional<Frame> heard;
  while (!(heard = (*other)->receive()) && Clock::now() < deadline) continue;
  EXPECT_TRUE(heard);
}

TEST_F(SocketCanFaults, AnInterfaceThatIsUnpluggedComesBackAsAnother) {
  const auto ip = [this](const std::string& words) {
    // A test of its own machine. NOLINTNEXTLINE(bugprone-command-processor,concurrency-mt-unsafe)
    ASSERT_EQ(std::system(("ip link " + words + " " + name_).c_str()), 0);
  };
  const Filter only{.id = 0x100, .mask = 0x1FFFFFFF, .extended = true};
  ASSERT_TRUE(bus_->set_filters({&only, 1}));
  ip("del dev");
  const auto noticed = until(State::gone);
  pollfd waiting{bus_->descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&waiting, 1, 1), 0) << "nothing is left that wakes its reader";
  ip("add type vcan dev");
  ip("set up dev");
  const auto back = until(State::error_active);
  Frame frame;
  frame.id = 1;
  EXPECT_TRUE(bus_->send(frame));
  EXPECT_EQ(bus_->pending(), 0U);
  auto other = open(name_);
  ASSERT_TRUE(other);
  for (const std::uint32_t id : {0x200U, 0x100U}) {
    frame.extended = true;
    frame.id = id;
    ASSERT_TRUE((*other)->send(frame));
  }
  const auto deadline = Clock::now() + kPatience;
  std::optional<Frame> heard;
  while (!(heard = bus_->receive()) && Clock::now() < deadline) continue;
  ASSERT_TRUE(heard) << "the kernel forgets the filters with the interface";
  EXPECT_EQ(heard->id, 0x100U);
  std::cout << "unplugged: noticed after " << noticed.count() << " ms, taken up again after "
            << back.count() << " ms\n";
}

TEST_F(SocketCanFaults, WhatTheControllerReportsIsTheState) {
  report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  until(State::error_passive);
  report(CAN_ERR_BUSOFF, 0);
  const auto noticed = until(State::bus_off);
  Frame frame;
  frame.id = 1;
  EXPECT_FALSE(bus_->send(frame));
  report(CAN_ERR_RESTARTED, 0);
  const auto back = until(State::error_active);
  EXPECT_TRUE(bus_->send(frame));
  report(CAN_ERR_BUSOFF, 0);
  until(State::bus_off);
  auto other = open(name_);
  ASSERT_TRUE(other);
  ASSERT_TRUE((*other)->send(frame));
  until(State::error_active);  // what is heard was not told of a restart
  std::cout << "bus-off: noticed after " << noticed.count() << " ms, back after " << back.count()
            << " ms\n";
  EXPECT_EQ(bus_->statistics().bus_offs, 2U);
  EXPECT_EQ(bus_->statistics().error_frames, 4U);
}

}  // namespace
}  // namespace skein::can
