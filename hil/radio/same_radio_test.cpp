// SPDX-License-Identifier: Apache-2.0
//
// Simulator and bench have one radio: the plugin, handed packets by us in place of sockets, does
// with each what the simulator's radio does with it.
#include <dlfcn.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/hil/radio/link_table.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/network/rtps_guid.hpp"
#include "skein/network/transport_plugin.hpp"

namespace skein::hil::radio {
namespace {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::Locator_t;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr VehicleId kSelf{2};
constexpr std::uint64_t kSeed = 7;
constexpr std::size_t kPackets = 300;  ///< of each sender in each situation

/// When each packet came, its number in its last bytes.
class Receiver : public rtps::TransportReceiverInterface {
 public:
  void OnDataReceived(const unsigned char* data, std::uint32_t size, const Locator_t& /*local*/,
                      const Locator_t& /*remote*/) override {
    const auto now = steady_clock::now();
    std::uint32_t number = 0;
    std::memcpy(&number, data + size - sizeof number, sizeof number);
    const std::lock_guard lock{mutex_};
    came_.emplace_back(number, now);
    changed_.notify_all();
  }
  /// Once so many came and no more do.
  std::vector<std::pair<std::uint32_t, steady_clock::time_point>> take(std::size_t count) {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, seconds{60}, [&] { return came_.size() >= count; });
    changed_.wait_for(lock, milliseconds{200}, [&] { return came_.size() > count; });
    return std::exchange(came_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<std::uint32_t, steady_clock::time_point>> came_;
};

std::vector<unsigned char> packet(VehicleId from, std::uint32_t number) {
  std::vector<unsigned char> bytes(network::kRtpsHeaderSize + sizeof number);
  std::memcpy(bytes.data(), "RTPS", 4);
  auto* prefix = bytes.data() + network::kRtpsGuidPrefixOffset;
  std::copy(network::kGuidMark.begin(), network::kGuidMark.end(), prefix);
  prefix[4] = static_cast<unsigned char>(from.value >> 8U);
  prefix[5] = static_cast<unsigned char>(from.value & 0xFFU);
  std::memcpy(bytes.data() + network::kRtpsHeaderSize, &number, sizeof number);
  return bytes;
}

std::vector<Interference> situations() {
  std::vector<Interference> all(8);
  all[1].disturbance.loss = 0.6;
  all[2].disturbance = {0.1, milliseconds{20}, milliseconds{15},
                        Disorder{0.3, 0.2, milliseconds{80}}};
  all[3].cuts = {cut_off({VehicleId{1}, kSelf})};
  all[4].cuts = {cut_off({VehicleId{1}}, Cut::Kind::one_way)};
  all[5].cuts = {cut_off({kSelf}, Cut::Kind::bridge)};
  all[5].cuts[0].bridge = VehicleId{1};
  all[6].cuts = {silence({kSelf})};
  all[7].healed = true;
  return all;
}

struct Transport {
  std::shared_ptr<rtps::TransportDescriptorInterface> descriptor =
      std::make_shared<rtps::UDPv4TransportDescriptor>();
  std::unique_ptr<rtps::ChainingTransport> radio;
};

Transport open_plugin(const LinkTable& table) {
  // NOLINTBEGIN(concurrency-mt-unsafe)
  EXPECT_EQ(::setenv("SKEIN_RADIO_TABLE", table.name().c_str(), 1), 0);
  EXPECT_EQ(::setenv("SKEIN_RADIO_SEED", std::to_string(kSeed).c_str(), 1), 0);
  // NOLINTEND(concurrency-mt-unsafe)
  void* library = ::dlopen(SKEIN_RADIO_PLUGIN, RTLD_NOW);
  EXPECT_NE(library, nullptr);
  const auto wrap =
      reinterpret_cast<network::WrapTransport>(::dlsym(library, network::kWrapTransportSymbol));
  Transport transport;
  EXPECT_EQ(wrap(transport.descriptor, kSelf.value), nullptr);
  transport.radio.reset(
      dynamic_cast<rtps::ChainingTransport*>(transport.descriptor->create_transport()));
  return transport;
}

TEST(SameRadio, ThePluginDoesWithEveryPacketWhatTheSimulatorDoes) {
  const RadioParams params{1500.0, 5000.0, milliseconds{30}, milliseconds{20}, 0.05};
  const Node self{kSelf, Vec2{0.0, 1000.0}};
  const std::vector<Node> senders{{VehicleId{1}, Vec2{500.0, 1000.0}},
                                  {VehicleId{3}, Vec2{0.0, 2600.0}},  // too far away
                                  {VehicleId{4}, std::nullopt},
                                  {kGroundStation, std::nullopt}};
  auto table = LinkTable::create();
  ASSERT_TRUE(table) << table.error().message;
  const Transport plugin = open_plugin(*table);
  ASSERT_NE(plugin.radio, nullptr);
  SimulatedRadio simulated{params, kSeed + kSelf.value};
  Receiver receiver;

  std::size_t lost = 0;
  std::size_t doubled = 0;
  std::uint32_t number = 0;
  for (const Interference& interference : situations()) {
    simulated.interfere(interference);
    table->set(link_when_up(params, interference));
    for (const Node& sender : senders) {
      table->set_hops(sender.id, kSelf, is_up(params, interference, sender, self) ? 1 : 0);
    }
    std::vector<Arrivals> expected;
    std::vector<steady_clock::time_point> sent;
    std::size_t coming = 0;
    const std::uint32_t first = number;
    for (std::size_t i = 0; i < kPackets * senders.size(); ++i, ++number) {
      const Node& sender = senders[i % senders.size()];
      expected.push_back(simulated.carry(sender, self));
      coming += expected.back().size();
      const auto bytes = packet(sender.id, number);
      sent.push_back(steady_clock::now());
      plugin.radio->receive(&receiver, bytes.data(), static_cast<std::uint32_t>(bytes.size()), {},
                            {});
    }
    std::vector<std::vector<Duration>> took(expected.size());
    for (const auto& [which, when] : receiver.take(coming)) {
      took.at(which - first).push_back(when - sent[which - first]);
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(took[i].size(), expected[i].size()) << "packet " << first + i;
      std::sort(expected[i].begin(), expected[i].end());
      for (std::size_t k = 0; k < took[i].size(); ++k) {
        EXPECT_GE(took[i][k], expected[i][k]) << "packet " << first + i;
        EXPECT_LT(took[i][k], expected[i][k] + seconds{20}) << "generous: it may be busy";
      }
      lost += expected[i].empty() ? 1 : 0;
      doubled += expected[i].size() == 2 ? 1 : 0;
    }
  }
  EXPECT_GT(lost, kPackets);
  EXPECT_GT(doubled, kPackets / 4);
}

}  // namespace
}  // namespace skein::hil::radio
