// SPDX-License-Identifier: Apache-2.0
//
// libskein_radio.so: a radio between a process and its sockets. The bench names it in the network
// configuration of every process; nothing else knows of it. What a process receives from another is
// lost, delayed, doubled or let through as the radio model does it with the pair's link of that
// moment in the bench's table. Own traffic passes, and so does that of senders that are not in the
// table (the bench itself).
//
// Environment: SKEIN_RADIO_TABLE, name of the link table; without it, as on machines that are not
// the bench's, the bench is listened to (link_feed.hpp). SKEIN_RADIO_SEED, number.

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/base/stations.hpp"
#include "skein/hil/radio/link_feed.hpp"
#include "skein/hil/radio/link_table.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/network/air_radio.hpp"
#include "skein/network/key_news.hpp"
#include "skein/network/rtps_guid.hpp"
#include "skein/network/transport_plugin.hpp"
#include "skein/seal/header.hpp"

namespace skein::hil::radio {
namespace {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::octet;
using SteadyTime = std::chrono::steady_clock::time_point;

constexpr std::size_t kWaitingMax = 8192;  ///< packets on their way; more are lost, as on the air

Instant steady_now() {
  return Instant{
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

/// Who sends this, sealed or in clear, where it is a node of ours.
std::optional<VehicleId> sender_of(std::span<const octet> datagram) {
  if (const auto header = seal::read_header(datagram)) return header->from.sender;
  if (const auto sender = network::key_news_sender(datagram)) return sender;
  return network::rtps_sender(datagram);
}

/// All ground stations are in one place.
VehicleId place_of(VehicleId node) { return is_station(node) ? kGroundStation : node; }

/// Perfect from itself, and from the bench, which stands for sensors on board.
Link link_from(const LinkTable& table, VehicleId sender, VehicleId self) {
  const VehicleId from = place_of(sender);
  const VehicleId to = place_of(self);
  return from == to || sender == mission::kSensors ? Link{} : table.get(from, to);
}

class RadioTransport : public rtps::ChainingTransport {
 public:
  RadioTransport(const rtps::ChainingTransportDescriptor& descriptor, VehicleId self,
                 std::shared_ptr<const LinkTable> table, std::uint64_t seed)
      : ChainingTransport{descriptor},
        descriptor_{descriptor},
        self_{self},
        table_{std::move(table)},
        random_{seed + self.value},
        air_{[this] { carry(); }} {}

  RadioTransport(const RadioTransport&) = delete;
  RadioTransport& operator=(const RadioTransport&) = delete;
  ~RadioTransport() override {
    {
      const std::lock_guard lock{mutex_};
      stopping_ = true;
    }
    changed_.notify_one();
    air_.join();
  }

  rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(eprosima::fastrtps::rtps::SenderResource* sender, const octet* buffer,
            std::uint32_t size, eprosima::fastrtps::rtps::LocatorsIterator* begin,
            eprosima::fastrtps::rtps::LocatorsIterator* end, const SteadyTime& timeout) override {
    return sender->send(buffer, size, begin, end, timeout);
  }

  void receive(rtps::TransportReceiverInterface* next, const octet* buffer, std::uint32_t size,
               const Locator_t& local, const Locator_t& remote) override {
    const auto sender = sender_of({buffer, size});
    const Link link = sender ? link_from(*table_, *sender, self_) : Link{};
    if (!link.up) return;
    bool now = false;
    {
      const std::lock_guard lock{mutex_};
      const auto arrivals =
          channel_.carry(link, sender.value_or(self_), size, steady_now(), random_);
      // Without any delay it goes on at once, on the channel's own thread, as without us.
      now = !arrivals.empty() && link.delay + link.jitter == Duration{} && !link.disorder &&
            !link.bytes_per_s;
      for (const Duration delay : arrivals) {
        if (now || waiting_.size() >= kWaitingMax) break;
        waiting_.push({std::chrono::steady_clock::now() + delay, order_++, next,
                       std::vector<octet>(buffer, buffer + size), local, remote});
      }
    }
    if (now) {
      next->OnDataReceived(buffer, size, local, remote);
    } else {
      changed_.notify_one();
    }
  }

  bool OpenInputChannel(const Locator_t& locator, rtps::TransportReceiverInterface* receiver,
                        std::uint32_t max_size) override {
    {
      const std::lock_guard lock{mutex_};
      closed_.erase(locator.port);
    }
    return ChainingTransport::OpenInputChannel(locator, receiver, max_size);
  }

  bool CloseInputChannel(const Locator_t& locator) override {
    {
      // No later packet reaches this channel's receiver; one that is being handed over is waited
      // for. Packets for other channels are not: their receivers may wait for the closing thread.
      std::unique_lock lock{mutex_};
      closed_.insert(locator.port);
      handed_over_.wait(lock, [&] { return in_hand_ != locator.port; });
    }
    return ChainingTransport::CloseInputChannel(locator);
  }

 private:
  struct Packet {
    SteadyTime due;
    std::uint64_t order;
    rtps::TransportReceiverInterface* next;
    std::vector<octet> bytes;
    Locator_t local;
    Locator_t remote;
    friend bool operator<(const Packet& a, const Packet& b) {  // the earliest is the greatest
      return std::tie(a.due, a.order) > std::tie(b.due, b.order);
    }
  };

  void carry() {
    std::unique_lock lock{mutex_};
    while (!stopping_) {
      if (waiting_.empty()) {
        changed_.wait(lock);
      } else if (const auto due = waiting_.top().due; due > std::chrono::steady_clock::now()) {
        changed_.wait_until(lock, due);
      } else {
        const Packet packet = waiting_.top();
        waiting_.pop();
        if (closed_.contains(packet.local.port)) continue;
        in_hand_ = packet.local.port;
        lock.unlock();
        packet.next->OnDataReceived(packet.bytes.data(),
                                    static_cast<std::uint32_t>(packet.bytes.size()), packet.local,
                                    packet.remote);
        lock.lock();
        in_hand_.reset();
        handed_over_.notify_all();
      }
    }
  }

  struct Configuration : rtps::ChainingTransportDescriptor {
    using ChainingTransportDescriptor::ChainingTransportDescriptor;
    explicit Configuration(const rtps::ChainingTransportDescriptor& d)
        : ChainingTransportDescriptor{d} {}
    rtps::TransportInterface* create_transport() const override { return nullptr; }
  };

  Configuration descriptor_;
  VehicleId self_;
  std::shared_ptr<const LinkTable> table_;
  std::mutex mutex_;  ///< of everything below
  Random random_;
  Channel channel_;
  std::priority_queue<Packet> waiting_;
  std::uint64_t order_ = 0;
  bool stopping_ = false;
  std::condition_variable changed_;
  std::set<std::uint32_t> closed_;        ///< ports
  std::optional<std::uint32_t> in_hand_;  ///< port of the packet that is being handed over
  std::condition_variable handed_over_;
  std::thread air_;  ///< last: it uses all of the above
};

struct RadioDescriptor : rtps::ChainingTransportDescriptor {
  RadioDescriptor(std::shared_ptr<rtps::TransportDescriptorInterface> low, VehicleId id,
                  std::shared_ptr<const LinkTable> links, std::uint64_t number)
      : ChainingTransportDescriptor{std::move(low)},
        self{id},
        table{std::move(links)},
        seed{number} {}
  rtps::TransportInterface* create_transport() const override {
    return new RadioTransport{*this, self, table, seed};  // Fast DDS owns it
  }
  VehicleId self;
  std::shared_ptr<const LinkTable> table;
  std::uint64_t seed;
};

/// The same for a node of the air, which keeps what is on its way itself.
class AirRadio : public network::AirRadio {
 public:
  AirRadio(VehicleId self, std::shared_ptr<const LinkTable> table, std::uint64_t seed)
      : self_{self}, table_{std::move(table)}, random_{seed + self.value} {}

  std::vector<Duration> arrivals(VehicleId sender, std::size_t bytes) override {
    const Link link = link_from(*table_, sender, self_);
    if (!link.up) return {};
    const auto arrivals = channel_.carry(link, sender, bytes, steady_now(), random_);
    return {arrivals.begin(), arrivals.end()};
  }

 private:
  VehicleId self_;
  std::shared_ptr<const LinkTable> table_;
  Random random_;
  Channel channel_;
};

std::uint64_t seed_of_environment() {
  // Nobody changes the environment while a node opens.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* seed = std::getenv("SKEIN_RADIO_SEED");
  return seed != nullptr ? std::strtoull(seed, nullptr, 10) : 1;
}

/// The table of this process's links, whoever keeps it.
Result<std::shared_ptr<const LinkTable>> links_of(VehicleId self) {
  // Nobody changes the environment while a node opens.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* name = std::getenv("SKEIN_RADIO_TABLE");
  if (name == nullptr) {
    auto feed = FeedReceiver::open(self);
    if (!feed) return feed.error();
    return std::shared_ptr<const LinkTable>{*feed, &(*feed)->table()};
  }
  auto table = LinkTable::open(name);
  if (!table) return table.error();
  return std::make_shared<const LinkTable>(std::move(table).value());
}

}  // namespace
}  // namespace skein::hil::radio

extern "C" __attribute__((visibility("default"))) const char* skein_wrap_transport(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>& transport,
    std::uint16_t self) {
  auto links = skein::hil::radio::links_of(skein::VehicleId{self});
  if (!links) {
    static std::string reason;
    reason = links.error().message;
    return reason.c_str();
  }
  transport = std::make_shared<skein::hil::radio::RadioDescriptor>(
      transport, skein::VehicleId{self}, std::move(links).value(),
      skein::hil::radio::seed_of_environment());
  return nullptr;
}
static_assert(std::is_same_v<decltype(&skein_wrap_transport), skein::network::WrapTransport>);

extern "C" __attribute__((visibility("default"))) skein::network::AirRadio* skein_open_air_radio(
    std::uint16_t self, const char** reason) {
  auto links = skein::hil::radio::links_of(skein::VehicleId{self});
  if (!links) {
    static std::string text;
    text = links.error().message;
    *reason = text.c_str();
    return nullptr;
  }
  return new skein::hil::radio::AirRadio{skein::VehicleId{self}, std::move(links).value(),
                                         skein::hil::radio::seed_of_environment()};
}
static_assert(std::is_same_v<decltype(&skein_open_air_radio), skein::network::OpenAirRadio>);
