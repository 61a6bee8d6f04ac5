// SPDX-License-Identifier: Apache-2.0
#include "dds_carrier.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "free_ports.hpp"

namespace skein::network {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

struct NoSink final : CarrierSink {
  void on_sample(codec::Topic, VehicleId, InstanceId, std::span<const std::uint8_t>) override {}
  void on_certificate(std::span<const std::uint8_t>) override {}
};

bool eventually(const std::function<bool()>& condition) {
  const auto end = steady_clock::now() + seconds{60};
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds{1});
  }
  return true;
}

class Carriers : public testing::TestWithParam<bool> {
 protected:
  /// 0 the ground station, 1 a vehicle; `at` is its place in ports_.
  [[nodiscard]] CarrierConfig config(std::uint16_t id, std::size_t at) const {
    CarrierConfig config;
    config.self = VehicleId{id};
    config.instance = InstanceId{7};
    config.role = id == 0 ? codec::Role::ground : codec::Role::vehicle;
    config.endpoint = {"127.0.0.1", ports_.at(at)};
    const std::uint16_t other = id == 0 ? 1 : 0;
    config.peers = {{VehicleId{other}, {"127.0.0.1", ports_.at(other)}}};
    if (GetParam()) {
      config.seal = CarrierConfig::Seal{.start = {.sender = config.self, .number = 1, .random = 5},
                                        .key = {.epoch = 1},
                                        .counters = {}};
    }
    return config;
  }

  const std::vector<std::uint16_t> ports_ = free_port_pairs(3);
  NoSink sink_;
};
INSTANTIATE_TEST_SUITE_P(InClearAndSealed, Carriers, testing::Bool());

TEST_P(Carriers, WhoseSuccessorBuriesThemAreForgotten) {
  DdsCarrier ground{config(0, 0), sink_};
  DdsCarrier first{config(1, 1), sink_};
  for (DdsCarrier* carrier : {&ground, &first}) {
    ASSERT_TRUE(carrier->prepare().ok());
    ASSERT_TRUE(carrier->join().ok());
  }
  ASSERT_TRUE(eventually([&] { return ground.peers().size() == 1; }));

  CarrierConfig after = config(1, 2);
  after.run = 1;
  if (after.seal) after.seal->counters.first = 1U << 16U;
  DdsCarrier next{after, sink_};
  ASSERT_TRUE(next.prepare().ok());
  // One datagram: the first is alive, and is met again with its next announcement.
  next.bury_predecessor();
  EXPECT_TRUE(eventually([&] { return ground.peers().empty(); }));
}

TEST_P(Carriers, GetOn) {
  DdsCarrier ground{config(0, 0), sink_};
  ASSERT_TRUE(ground.prepare().ok());
  ASSERT_TRUE(ground.join().ok());
  EXPECT_TRUE(ground.gets_on(seconds{60}));
  // Of what it reads itself, and nobody else is there to read, nothing goes out, which is no hang.
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(ground.write(codec::Topic::setup, {1, 2, 3, 4}), Written::yes);
    ASSERT_TRUE(ground.gets_on(Duration{})) << i;
    std::this_thread::sleep_for(milliseconds{1});
  }
}

}  // namespace
}  // namespace skein::network
