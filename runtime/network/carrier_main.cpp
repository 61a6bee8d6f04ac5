// SPDX-License-Identifier: Apache-2.0
//
// The process that carries a node's network: Fast DDS, and a socket to its node.
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "carrier_messages.hpp"
#include "carrier_start.hpp"
#include "confinement.hpp"
#include "dds_carrier.hpp"
#include "processor_wait.hpp"
#include "skein/network/carrier_process.hpp"

namespace skein::network {
namespace {

using Clock = std::chrono::steady_clock;

/// A thread of Fast DDS that is at one datagram for so long hangs; longer where there is no
/// processor for all who are ready, which is seen by how often threads here lost theirs between two
/// pings.
constexpr Duration kGetsOnWithin = std::chrono::milliseconds{400};
constexpr Duration kGetsOnWithinMax = std::chrono::seconds{10};
constexpr long kLostProcessors = 10;

/// So many pings: they are about the last ten seconds.
constexpr std::uint32_t kReceptionsEvery = 5;

/// When the predecessor's end is told again, since the join: datagrams are lost.
constexpr std::array kBuryAgain{std::chrono::milliseconds{300}, std::chrono::milliseconds{1000}};

class CarrierMain : private CarrierSink {
 public:
  explicit CarrierMain(int socket)
      : socket_{socket}, unconfined_{give_up_rights(socket)}, buffer_(kCarrierMessageBytesMax) {}
  CarrierMain(const CarrierMain&) = delete;
  CarrierMain& operator=(const CarrierMain&) = delete;
  virtual ~CarrierMain() = default;

  int run() {
    const auto first = receive(0);
    const auto* config = first ? std::get_if<CarrierConfig>(&*first) : nullptr;
    if (config == nullptr) return 1;
    CarrierSink& sink = *this;
    carrier_ = std::make_unique<DdsCarrier>(*config, sink);
    if (const auto joined = join(); !joined) {
      send(Refused{joined.error().message});
      return 0;
    }
    send(Joined{unconfined_.substr(0, kCarrierTextMax)});
    serve();
    return 0;
  }

 private:
  Result<void> join() {
    if (auto r = carrier_->prepare(); !r) return r;
    const auto note = [&unconfined = unconfined_](const std::string& failed) {
      if (!failed.empty() && unconfined.find(failed) == std::string::npos) {
        unconfined.append(unconfined.empty() ? "" : "; ").append(failed);
      }
    };
    note(keep_only(Calls::opening));
    carrier_->bury_predecessor();
    if (auto r = carrier_->join(); !r) return r;
    note(keep_only(Calls::open));
    return {};
  }

  void serve() {
    const auto joined = Clock::now();
    std::size_t buried = 0;
    while (true) {
      int timeout_ms = -1;
      if (buried < kBuryAgain.size()) {
        const auto left = joined + kBuryAgain.at(buried) - Clock::now();
        timeout_ms = static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count());
        if (timeout_ms <= 0) {
          carrier_->bury_predecessor();
          ++buried;
          continue;
        }
      }
      pollfd item{socket_, POLLIN, 0};
      if (poll(&item, 1, timeout_ms) <= 0) continue;
      while (const auto message = receive(MSG_DONTWAIT)) {
        std::visit([this](const auto& m) { take(m); }, *message);
      }
      if (ended_) return;
    }
  }

  /// Nothing where nothing waits, or the node is gone.
  std::optional<ToCarrier> receive(int flags) {
    const ssize_t size = recv(socket_, buffer_.data(), buffer_.size(), flags);
    if (size == 0) ended_ = true;
    if (size <= 0) return std::nullopt;
    auto message = to_carrier_from({buffer_.data(), static_cast<std::size_t>(size)});
    if (!message) ended_ = true;  // whatever speaks there, it is not our program
    return message;
  }

  void take(const CarrierConfig&) {}
  void take(const WriteSample& sample) {
    const auto written = carrier_->write(sample.topic, {sample.bytes.begin(), sample.bytes.end()});
    if (written != Written::yes) ++lost_;
  }
  void take(const Ping& ping) {
    rusage used{};
    (void)getrusage(RUSAGE_SELF, &used);
    const bool is_busy =
        used.ru_nivcsw - std::exchange(lost_processors_, used.ru_nivcsw) > kLostProcessors ||
        is_machine_overloaded();
    if (!carrier_->gets_on(is_busy ? kGetsOnWithinMax : kGetsOnWithin)) {
      send(Stuck{});
      _exit(1);  // its destructors might wait for that thread
    }
    carrier_->extend_counters(ping.counters_end);
    CarrierCounts counts = carrier_->counts();
    counts.at(static_cast<std::size_t>(CarrierCount::lost)) = lost_.load();
    send(Pong{ping.number, carrier_->next_counter(), counts});
    while (const auto news = carrier_->take_key_news()) send(HeardNews{*news});
    auto peers = carrier_->peers();
    if (peers.size() > kCarrierPeersMax) peers.resize(kCarrierPeersMax);
    if (peers != peers_ && send(PeersNow{peers})) peers_ = std::move(peers);
    if (ping.number % kReceptionsEvery == 0) {
      auto receptions = carrier_->receptions();
      if (receptions.size() > kCarrierPeersMax) receptions.resize(kCarrierPeersMax);
      send(ReceptionsNow{std::move(receptions)});
    }
  }
  void take(const ChangeKey& change) { carrier_->change_key(change.key, change.old_for); }
  void take(const ForgetNews&) {
    news_.clear();
    carrier_->tell(news_);
  }
  void take(const TellNews& tell) {
    news_.push_back(tell.news);
    if (tell.is_last) carrier_->tell(news_);
  }

  void on_sample(codec::Topic topic, VehicleId sender, InstanceId instance,
                 std::span<const std::uint8_t> bytes) override {
    if (!send(HeardSample{topic, sender, instance, bytes})) ++lost_;
  }
  void on_certificate(std::span<const std::uint8_t> certificate) override {
    if (certificate.size() <= kCarrierBlobMax) send(HeardCertificate{certificate});
  }

  /// From any thread. Does not wait: a node that does not read loses what it is told.
  bool send(const FromCarrier& message) const {
    const auto bytes = to_bytes(message);
    return ::send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
  }

  const int socket_;
  std::string unconfined_;  ///< what it could not give up
  long lost_processors_ = 0;
  std::vector<std::uint8_t> buffer_;
  std::atomic<std::uint64_t> lost_{0};
  std::vector<Peer> peers_;  ///< as told
  std::vector<KeyNews> news_;
  bool ended_ = false;
  std::unique_ptr<DdsCarrier> carrier_;  ///< last: its threads use the above
};

}  // namespace

std::optional<int> run_carrier(int argc, char** argv) {
  if (argc < 2 || std::string_view{argv[1]} != kCarrierArgument) return std::nullopt;
  prctl(PR_SET_NAME, "skein-carrier");
  return CarrierMain{kCarrierDescriptor}.run();
}

}  // namespace skein::network
