// SPDX-License-Identifier: Apache-2.0
#include "sealed_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "rtps_datagram.hpp"
#include "skein/network/rtps_guid.hpp"

namespace skein::network {
namespace {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::LocatorList_t;
using eprosima::fastrtps::rtps::Locators;
using eprosima::fastrtps::rtps::LocatorsIterator;
using eprosima::fastrtps::rtps::octet;
using eprosima::fastrtps::rtps::SenderResource;
using SteadyTime = std::chrono::steady_clock::time_point;

Seals::Place place_of(const Locator_t& locator) {
  std::uint32_t address = 0;
  for (std::size_t i = 12; i < 16; ++i) address = address << 8U | locator.address[i];
  return {address, static_cast<std::uint16_t>(locator.port)};
}

struct SealedDescriptor : rtps::ChainingTransportDescriptor {
  SealedDescriptor(std::shared_ptr<rtps::TransportDescriptorInterface> low,
                   std::shared_ptr<Seals> keys)
      : ChainingTransportDescriptor{std::move(low)}, seals{std::move(keys)} {
    maxMessageSize -= seal::kOverheadBytes;
  }
  rtps::TransportInterface* create_transport() const override;
  std::uint32_t max_message_size() const override { return maxMessageSize; }
  std::shared_ptr<Seals> seals;
};

class SealedTransport : public rtps::ChainingTransport {
 public:
  explicit SealedTransport(const SealedDescriptor& descriptor)
      : ChainingTransport{descriptor}, descriptor_{descriptor} {}

  rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool OpenInputChannel(const Locator_t& locator, rtps::TransportReceiverInterface* receiver,
                        std::uint32_t max_size) override {
    // Sealed, the longest message of Fast DDS is longer.
    return ChainingTransport::OpenInputChannel(locator, receiver, max_size + seal::kOverheadBytes);
  }

  bool send(SenderResource* sender, const octet* buffer, std::uint32_t size,
            LocatorsIterator* begin, LocatorsIterator* end, const SteadyTime& timeout) override {
    const auto plain = without_statistics({buffer, size});
    if (!plain) return false;
    thread_local std::vector<std::uint8_t> datagram;
    do {  // one of 256 has to be sealed again, under the next counter
      if (!descriptor_.seals->sealer.seal(*plain, datagram)) return false;
    } while (looks_like_statistics(datagram));
    bool sent = false;
    if (!descriptor_.seals->news.has_any()) {
      sent = sender->send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), begin, end,
                          timeout);
    } else {
      LocatorList_t all;  // what is given can be gone through once
      for (; *begin != *end; ++*begin) all.push_back(**begin);
      for (const Locator_t& to : all) tell_news(*sender, to, timeout);
      sent = send_to(*sender, datagram, all, timeout);
    }
    descriptor_.seals->progress.sent();
    return sent;
  }

  void receive(rtps::TransportReceiverInterface* next, const octet* buffer, std::uint32_t size,
               const Locator_t& local, const Locator_t& remote) override {
    if (is_key_news({buffer, size})) return descriptor_.seals->news.hear({buffer, size});
    thread_local std::vector<std::uint8_t> plain;
    const Instant now = steady_now();
    const auto outcome = descriptor_.seals->opener.open({buffer, size}, plain, now);
    if (outcome.opened != seal::Opened::good) return;
    const auto message = without_statistics(plain);
    if (!message || message->size() != plain.size() || rtps_sender(plain) != outcome.from.sender) {
      descriptor_.seals->misformed.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    const Progress::Receiving receiving{descriptor_.seals->progress, now};
    next->OnDataReceived(plain.data(), static_cast<std::uint32_t>(plain.size()), local, remote);
  }

 private:
  static bool send_to(SenderResource& sender, const std::vector<std::uint8_t>& datagram,
                      const LocatorList_t& locators, const SteadyTime& timeout) {
    Locators begin{locators.begin()};
    Locators end{locators.end()};
    return sender.send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), &begin, &end,
                       timeout);
  }

  /// Who is sent anything, and has not been heard under the present key, learns of it first.
  void tell_news(SenderResource& sender, const Locator_t& to, const SteadyTime& timeout) {
    Seals& seals = *descriptor_.seals;
    const auto peer = seals.peers.find(place_of(to));
    if (peer == seals.peers.end()) return;
    const auto epoch = seals.opener.newest_epoch_of(peer->second);
    const auto datagram = seals.news.due(peer->second, epoch, steady_now());
    if (!datagram) return;
    LocatorList_t only;
    only.push_back(to);
    (void)send_to(sender, *datagram, only, timeout);
  }

  SealedDescriptor descriptor_;
};

rtps::TransportInterface* SealedDescriptor::create_transport() const {
  return new SealedTransport{*this};  // Fast DDS owns it
}

}  // namespace

std::shared_ptr<rtps::TransportDescriptorInterface> sealed(
    std::shared_ptr<rtps::TransportDescriptorInterface> transport, std::shared_ptr<Seals> seals) {
  return std::make_shared<SealedDescriptor>(std::move(transport), std::move(seals));
}

}  // namespace skein::network
