// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "air_socket.hpp"
#include "carrier.hpp"
#include "reception_book.hpp"
#include "seals.hpp"
#include "skein/air/link.hpp"
#include "skein/network/air_radio.hpp"
#include "skein/seal/replay_window.hpp"
#include "skein/system/descriptor.hpp"

namespace skein::network {

/// Which datagrams in clear were heard, of at most air::Link::kAuthorsMax authors: who was silent
/// longest gives way.
class HeardClear {
 public:
  /// Whether that datagram was not heard yet; now it is.
  bool is_first(const air::Author& author, std::uint64_t counter);

 private:
  struct Heard {
    seal::ReplayWindow window;
    std::uint64_t at = 0;  ///< by how many calls there were
  };
  std::map<air::Author, Heard> authors_;
  std::uint64_t calls_ = 0;
};

/// An air::Link on a socket, with a thread of its own that listens and speaks.
class AirCarrier final : public Carrier, private air::LinkSink {
 public:
  AirCarrier(CarrierConfig config, CarrierSink& sink, AirSocket socket, system::Descriptor wake,
             std::unique_ptr<AirRadio> radio);
  AirCarrier(const AirCarrier&) = delete;
  AirCarrier& operator=(const AirCarrier&) = delete;
  ~AirCarrier() override;

  [[nodiscard]] Written write(codec::Topic topic, std::vector<std::uint8_t> bytes) override;
  [[nodiscard]] std::vector<Peer> peers() const override;
  [[nodiscard]] std::vector<Reception> receptions() const override;
  void change_key(const seal::EpochKey& key, Duration old_for) override;
  void tell(const std::vector<KeyNews>& news) override;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take_key_news() override;
  [[nodiscard]] CarrierCounts counts() const override;

 private:
  /// What a link has heard, until its lock is open again.
  struct Heard {
    std::optional<codec::Topic> topic;  ///< none: a certificate
    air::Author author;
    std::vector<std::uint8_t> bytes;
  };

  std::optional<air::Opened> open(std::span<const std::uint8_t> datagram) override;
  void on_sample(std::uint8_t channel, const air::Author& author,
                 std::span<const std::uint8_t> bytes) override;
  void on_certificate(const air::Author& author, std::span<const std::uint8_t> bytes) override;

  void run();
  void wait();
  void receive(std::span<const std::uint8_t> datagram);
  void arrive(std::span<const std::uint8_t> datagram);
  void count_reception(std::span<const std::uint8_t> datagram,
                       const std::optional<air::Opened>& opened);
  [[nodiscard]] std::optional<air::Opened> unseal(std::span<const std::uint8_t> datagram,
                                                  std::vector<std::uint8_t>& plain);
  [[nodiscard]] std::optional<air::Opened> read_clear(std::span<const std::uint8_t> datagram);
  void note_sent(const air::Opened& passed_on);
  [[nodiscard]] bool is_own_voice(const seal::Header& header) const;
  void tell_news(const seal::Header& header);
  void speak();

  const CarrierConfig config_;
  CarrierSink& sink_;
  AirSocket socket_;
  const system::Descriptor wake_;
  const std::unique_ptr<AirRadio> radio_;  ///< none: what is received is there
  std::unique_ptr<Seals> seals_;           ///< none: in clear
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> misformed_{0};
  ReceptionBook receptions_;

  mutable std::mutex mutex_;  ///< of the two below
  air::Link link_;
  Instant sleeps_until_{};

  // Of the thread alone.
  static constexpr Duration kGather = std::chrono::milliseconds{5};
  Duration gather_ = kGather;
  std::multimap<Instant, std::vector<std::uint8_t>> on_their_way_;  ///< through the radio
  std::vector<Heard> heard_;
  std::vector<std::uint8_t> plain_;
  std::vector<std::uint8_t> inner_;  ///< of a datagram that was passed on
  HeardClear heard_clear_;
  std::uint64_t said_clear_ = 0;
  std::vector<std::uint8_t> out_;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace skein::network
