// SPDX-License-Identifier: Apache-2.0
// The radio between two true nodes of the mission network, on loopback.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "skein/hil/radio/link_feed.hpp"
#include "skein/hil/radio/link_table.hpp"
#include "skein/network/node.hpp"

namespace skein::hil::radio {
namespace {

using network::Node;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr VehicleId kAnna{1};
constexpr VehicleId kBert{2};

bool eventually(const std::function<bool()>& condition) {
  const auto end = steady_clock::now() + seconds{60};
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds{2});
  }
  return true;
}

bool is_free(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool free = ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(fd);
  return free;
}

/// Tells the plugin which table; none where the name is empty. No node is open when it is called.
void name_table(const std::string& name) {
  // NOLINTBEGIN(concurrency-mt-unsafe)
  if (name.empty()) {
    ASSERT_EQ(::unsetenv("SKEIN_RADIO_TABLE"), 0);
  } else {
    ASSERT_EQ(::setenv("SKEIN_RADIO_TABLE", name.c_str(), 1), 0);
    ASSERT_EQ(::setenv("SKEIN_RADIO_SEED", "7", 1), 0);
  }
  // NOLINTEND(concurrency-mt-unsafe)
}

TEST(LinkTableNames, OneThatIsTakenIsPassedOver) {
  const auto numbered = [](const std::string& name, int step) {
    const auto dash = name.rfind('-') + 1;
    return name.substr(0, dash) + std::to_string(std::stoi(name.substr(dash)) + step);
  };
  const auto first = LinkTable::create();
  ASSERT_TRUE(first) << first.error().message;
  const auto taken = numbered(first.value().name(), 1);
  const int left_behind = ::shm_open(taken.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
  ASSERT_GE(left_behind, 0);
  const auto second = LinkTable::create();
  EXPECT_EQ(::shm_unlink(taken.c_str()), 0);
  ::close(left_behind);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second.value().name(), numbered(first.value().name(), 2));
}

/// A radio knows whose datagram it carries in clear and sealed.
enum class Air : std::uint8_t { clear, sealed };

/// Two vehicles that hear each other through the radio only.
class Radio : public testing::TestWithParam<Air> {
 protected:
  void SetUp() override {
    auto made = LinkTable::create();
    ASSERT_TRUE(made) << made.error().message;
    table_ = std::make_unique<LinkTable>(std::move(made).value());
    name_table(table_->name());
    open_both();
  }

  void open_both() {
    std::random_device device;
    std::uniform_int_distribution<int> quarter{2500, 7999};
    int port = 0;
    do {
      port = 4 * quarter(device);
    } while (!is_free(port) || !is_free(port + 1) || !is_free(port + 2) || !is_free(port + 3));
    const network::Endpoint anna{"127.0.0.1", static_cast<std::uint16_t>(port)};
    const network::Endpoint bert{"127.0.0.1", static_cast<std::uint16_t>(port + 2)};
    anna_ = open(kAnna, anna, {kBert, bert}, device(), GetParam());
    bert_ = open(kBert, bert, {kAnna, anna}, device(), GetParam());
  }

  static std::unique_ptr<Node> open(VehicleId self, const network::Endpoint& endpoint,
                                    const network::PeerConfig& peer, std::uint64_t instance,
                                    Air air) {
    network::NodeConfig config;
    config.self = self;
    config.instance = InstanceId{instance};
    config.endpoint = endpoint;
    config.peers = {peer};
    config.transport_plugin = SKEIN_RADIO_PLUGIN;
    if (air == Air::sealed) config.seal = network::SealConfig{.start = {self, 1, 2}, .key = {}};
    auto node = Node::open(config);
    EXPECT_TRUE(node) << node.error().message;
    return std::move(node).value();
  }

  void both_ways(const Link& link) {
    table_->set(link);
    table_->set_hops(kAnna, kBert, link.up ? 1 : 0);
    table_->set_hops(kBert, kAnna, link.up ? 1 : 0);
  }
  [[nodiscard]] bool matched() const {
    return anna_->peers().size() == 1 && bert_->peers().size() == 1;
  }
  /// A reliable message, and a best-effort one.
  bool send_cancel(std::uint32_t number) {
    coalition::Cancel m;
    m.round.number = number;
    return anna_->publish(coalition::Message{m});
  }
  bool send_telemetry(std::uint32_t number) {
    mission::Telemetry m;
    m.vehicle = kAnna;
    m.plan_number = number;
    return anna_->publish(m);
  }

  std::unique_ptr<LinkTable> table_;
  std::unique_ptr<Node> anna_;
  std::unique_ptr<Node> bert_;
};

constexpr auto kNameOfAir = [](const auto& air) {
  return air.param == Air::clear ? "Clear" : "Sealed";
};
INSTANTIATE_TEST_SUITE_P(All, Radio, testing::Values(Air::clear, Air::sealed), kNameOfAir);

TEST_P(Radio, NothingPassesALinkThatIsDownAndWhatIsReliableIsRepaired) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  both_ways({false, 0.0, Duration{}, Duration{}});
  for (std::uint32_t i = 0; i < 5; ++i) ASSERT_TRUE(send_cancel(i));
  // Not an event to wait for but its absence: some heartbeats long, so that repair is tried.
  std::this_thread::sleep_for(milliseconds{400});
  EXPECT_FALSE(bert_->poll());
  EXPECT_TRUE(matched()) << "an outage does not end the match";

  both_ways({});
  std::vector<std::uint32_t> numbers;
  EXPECT_TRUE(eventually([&] {
    while (const auto received = bert_->poll()) {
      const auto& m = std::get<coalition::Message>(received->message);
      numbers.push_back(std::get<coalition::Cancel>(m).round.number);
    }
    return numbers.size() >= 5;
  }));
  EXPECT_EQ(numbers, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

TEST_P(Radio, TheDelayIsThatOfTheLink) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  both_ways({true, 0.0, milliseconds{150}, milliseconds{50}});
  for (std::uint32_t i = 0; i < 5; ++i) {
    const auto sent = steady_clock::now();
    ASSERT_TRUE(send_telemetry(i));
    ASSERT_TRUE(eventually([&] { return bert_->poll().has_value(); }));
    const auto took = steady_clock::now() - sent;
    EXPECT_GE(took, milliseconds{99});
    EXPECT_LT(took, seconds{20}) << "generous: the machine may be busy";
  }
}

TEST_P(Radio, BestEffortMessagesAreLostInTheGivenShare) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  table_->set({true, 0.5, Duration{}, Duration{}});
  int received = 0;
  constexpr int kSent = 300;
  for (std::uint32_t i = 0; i < kSent; ++i) {
    ASSERT_TRUE(send_telemetry(i));
    std::this_thread::sleep_for(milliseconds{2});  // the writer keeps the last one only
    while (bert_->poll()) ++received;
  }
  EXPECT_GT(received, 0);
  EXPECT_LT(received, kSent * 7 / 10);
}

TEST_P(Radio, WhatIsReliableGetsThroughLoss) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  both_ways({true, 0.3, milliseconds{5}, milliseconds{5}});
  for (std::uint32_t i = 0; i < 40; ++i) ASSERT_TRUE(send_cancel(i));
  std::uint32_t next = 0;
  EXPECT_TRUE(eventually([&] {
    while (const auto received = bert_->poll()) {
      const auto& m = std::get<coalition::Message>(received->message);
      EXPECT_EQ(std::get<coalition::Cancel>(m).round.number, next++);
    }
    return next == 40;
  }));
}

TEST_P(Radio, ClosesWithPacketsOnTheirWay) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  both_ways({true, 0.0, milliseconds{300}, Duration{}});
  for (std::uint32_t i = 0; i < 50; ++i) ASSERT_TRUE(send_cancel(i));
  bert_.reset();
  anna_.reset();
}

/// As on machines that do not share the bench's memory.
class ToldRadio : public Radio {
 protected:
  void SetUp() override {
    name_table("");
    open_both();
  }
  /// Bert hears everybody, or nobody.
  void tell(bool hears) {
    Hearing hearing{kBert, {}, {}};
    if (hears) hearing.hops.fill(1);
    feed_->send(hearing, "127.0.0.1");
  }
  /// Anna speaks and the bench tells, until so many of her words in a row were (not) heard.
  bool until(bool heard, std::uint32_t in_a_row) {
    std::uint32_t count = 0;
    return eventually([&] {
      tell(heard);
      EXPECT_TRUE(send_telemetry(++number_));
      std::this_thread::sleep_for(milliseconds{5});
      bool any = false;
      while (bert_->poll()) any = true;
      count = any == heard ? count + 1 : 0;
      return count >= in_a_row;
    });
  }

 private:
  Result<FeedSender> feed_ = FeedSender::open();
  std::uint32_t number_ = 0;
};

INSTANTIATE_TEST_SUITE_P(All, ToldRadio, testing::Values(Air::clear, Air::sealed), kNameOfAir);

TEST_P(ToldRadio, WhatTheBenchTellsHoldsOnAnotherMachine) {
  ASSERT_TRUE(eventually([&] { return matched(); }));
  EXPECT_TRUE(until(true, 5));
  EXPECT_TRUE(until(false, 50));
  EXPECT_TRUE(until(true, 5));
}

TEST(RadioPlugin, RefusesWithoutItsTableAndWithoutABenchToHear) {
  network::NodeConfig config;
  config.self = kAnna;
  config.instance = InstanceId{1};
  config.transport_plugin = SKEIN_RADIO_PLUGIN;
  std::random_device device;
  std::uniform_int_distribution<int> half{5000, 15999};
  int port = 0;
  do {
    port = 2 * half(device);
  } while (!is_free(port) || !is_free(port + 1));
  config.endpoint = {"127.0.0.1", static_cast<std::uint16_t>(port)};
  name_table("");
  {
    const auto taken = FeedReceiver::open(kAnna);
    ASSERT_TRUE(taken) << taken.error().message;
    const auto deaf = Node::open(config);
    ASSERT_FALSE(deaf);
    EXPECT_NE(deaf.error().message.find(std::to_string(feed_port(kAnna))), std::string::npos);
  }
  name_table("/skein-radio-of-nobody");
  const auto missing = Node::open(config);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("/skein-radio-of-nobody"), std::string::npos);
}

}  // namespace
}  // namespace skein::hil::radio
