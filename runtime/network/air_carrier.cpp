// SPDX-License-Identifier: Apache-2.0
#include "air_carrier.hpp"

#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "air_channels.hpp"
#include "signatures.hpp"
#include "skein/identity/identity.hpp"
#include "skein/seal/header.hpp"

namespace skein::network {
namespace {

using codec::Topic;

/// Of a datagram in clear: a mark, the domain (4 bytes), the node (2), the instance (8), the
/// counter (5), big endian.
constexpr std::uint8_t kClearMark = 0xA0;
constexpr std::size_t kClearBytes = 20;
constexpr std::size_t kIpUdpBytes = 28;
/// The thread wakes up at multiples of this, since to wake up costs more than to read: the longer
/// where many speak.
constexpr Duration kGatherOfMany = std::chrono::milliseconds{20};
constexpr std::size_t kOnTheirWayMax = 8192;  ///< more are lost, as on the air

void put(std::vector<std::uint8_t>& out, std::uint64_t number, unsigned bytes) {
  while (bytes-- > 0) out.push_back(static_cast<std::uint8_t>(number >> (8U * bytes)));
}

std::uint64_t number_in(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes) number = number << 8U | byte;
  return number;
}

bool is_clear(std::span<const std::uint8_t> datagram) {
  return datagram.size() >= kClearBytes && datagram[0] == kClearMark;
}

/// Who sends it, as it says.
std::optional<VehicleId> sender_of(std::span<const std::uint8_t> datagram) {
  if (const auto header = seal::read_header(datagram)) return header->from.sender;
  if (const auto sender = key_news_sender(datagram)) return sender;
  if (!is_clear(datagram)) return std::nullopt;
  return VehicleId{static_cast<std::uint16_t>(number_in(datagram.subspan(5, 2)))};
}

air::Author author_of(const seal::SenderStart& start) {
  return {start.sender, identity::instance_of(start)};
}

/// All that has come is read when the thread wakes, or whoever floods takes the room of the others;
/// but for this, so that it also speaks.
constexpr int kBatchesMax = 64;

bool wait_for(std::span<pollfd> any, Duration at_most) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  const timespec timeout{seconds.count(), (at_most - seconds).count()};
  return ppoll(any.data(), any.size(), &timeout, nullptr) > 0;
}

/// Whatever is said can be carried.
static_assert(std::ranges::all_of(codec::kTopics, [](const codec::TopicInfo& topic) {
  return topic.size_max + kSignatureBytes <= air::Link::kSampleMax;
}));

air::LinkConfig link_config(const CarrierConfig& config) {
  air::LinkConfig link;
  link.self = {config.self,
               config.seal ? identity::instance_of(config.seal->start) : config.instance};
  link.role = static_cast<std::uint8_t>(config.role);
  link.channels = air_channels();
  link.certificate = config.certificate;
  link.overhead_bytes = kIpUdpBytes + (config.seal ? seal::kOverheadBytes : kClearBytes);
  link.bytes_per_s = config.air->bytes_per_s;
  link.hops_max = config.air->hops_max;
  link.seed = config.instance.value;
  return link;
}

Result<std::unique_ptr<AirRadio>> open_radio(const CarrierConfig& config) {
  if (config.transport_plugin.empty()) return std::unique_ptr<AirRadio>{};
  // Never closed: what it has made may outlive the node.
  void* library = dlopen(config.transport_plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    // glibc keeps it per thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
    return Error{std::string{"cannot load the transport: "} + dlerror()};
  }
  const auto open = reinterpret_cast<OpenAirRadio>(dlsym(library, kOpenAirRadioSymbol));
  if (open == nullptr) {
    return Error{"the transport " + config.transport_plugin + " does not export " +
                 kOpenAirRadioSymbol};
  }
  const char* reason = nullptr;
  std::unique_ptr<AirRadio> radio{open(config.self.value, &reason)};
  if (!radio) return Error{"the transport " + config.transport_plugin + " refuses: " + reason};
  return radio;
}

}  // namespace

bool HeardClear::is_first(const air::Author& author, std::uint64_t counter) {
  if (authors_.size() >= air::Link::kAuthorsMax && !authors_.contains(author)) {
    authors_.erase(
        std::ranges::min_element(authors_, {}, [](const auto& entry) { return entry.second.at; }));
  }
  Heard& heard = authors_[author];
  heard.at = ++calls_;
  if (!heard.window.is_new(counter)) return false;
  heard.window.note(counter);
  return true;
}

AirCarrier::AirCarrier(CarrierConfig config, CarrierSink& sink, AirSocket socket,
                       system::Descriptor wake, std::unique_ptr<AirRadio> radio)
    : config_{std::move(config)},
      sink_{sink},
      socket_{std::move(socket)},
      wake_{std::move(wake)},
      radio_{std::move(radio)},
      link_{link_config(config_), *this, steady_now()} {
  if (config_.seal) {
    const auto& seal = *config_.seal;
    seals_ = std::make_unique<Seals>(seal.start, seal.key, seal.counters,
                                     std::map<Seals::Place, VehicleId>{});
  }
  thread_ = std::thread{[this] { run(); }};
}

AirCarrier::~AirCarrier() {
  stopping_ = true;
  (void)eventfd_write(wake_.get(), 1);
  thread_.join();
}

// --- for the node --------------------------------------------------------------------------------

Written AirCarrier::write(Topic topic, std::vector<std::uint8_t> bytes) {
  bool wake = false;
  {
    const std::lock_guard lock{mutex_};
    const Instant now = steady_now();
    if (!link_.send(static_cast<std::uint8_t>(topic), std::move(bytes), now)) {
      return Written::no_room;
    }
    wake = link_.due() < sleeps_until_;
    if (wake) sleeps_until_ = Instant{};  // it knows
  }
  if (wake) (void)eventfd_write(wake_.get(), 1);
  return Written::yes;
}

std::vector<Peer> AirCarrier::peers() const {
  std::vector<Peer> peers;
  const std::lock_guard lock{mutex_};
  for (const air::LinkPeer& peer : link_.peers(steady_now())) {
    const auto role = static_cast<codec::Role>(peer.role);
    if (role != codec::Role::vehicle && role != codec::Role::ground) continue;
    peers.push_back({peer.author.node, peer.author.instance, role});
  }
  return peers;
}

std::vector<Reception> AirCarrier::receptions() const { return receptions_.all(steady_now()); }

void AirCarrier::change_key(const seal::EpochKey& key, Duration old_for) {
  seals_->change_key(key, old_for);
}

void AirCarrier::tell(const std::vector<KeyNews>& news) { seals_->news.tell(news); }

std::optional<std::vector<std::uint8_t>> AirCarrier::take_key_news() { return seals_->news.take(); }

CarrierCounts AirCarrier::counts() const {
  CarrierCounts counts{};
  const auto set = [&counts](CarrierCount of, std::uint64_t value, std::size_t offset = 0) {
    counts.at(static_cast<std::size_t>(of) + offset) = value;
  };
  {
    const std::lock_guard lock{mutex_};
    const air::LinkCounts link = link_.counts();
    set(CarrierCount::unknown_sender, link.too_many);
    set(CarrierCount::misformed, misformed_ + link.malformed);
    set(CarrierCount::air_passed_on, link.passed_on);
    set(CarrierCount::air_repairs, link.repairs);
    set(CarrierCount::air_gave_way, link.gave_way);
    set(CarrierCount::air_lost, link.lost);
  }
  if (seals_) {
    const auto opened = seals_->opener.counts();
    for (std::size_t i = 0; i < opened.size(); ++i) set(CarrierCount::opened, opened.at(i), i);
  }
  return counts;
}

// --- its thread ----------------------------------------------------------------------------------

void AirCarrier::run() {
  (void)pthread_setname_np(pthread_self(), "carrier");
  while (!stopping_) {
    wait();
    unsigned received = 0;
    bool more = true;
    for (int i = 0; more && i < kBatchesMax; ++i) {
      more = socket_.receive([&](auto datagram) {
        ++received;
        receive(datagram);
      });
    }
    gather_ = received > 1 ? kGatherOfMany : kGather;
    while (!on_their_way_.empty() && on_their_way_.begin()->first <= steady_now()) {
      arrive(on_their_way_.begin()->second);
      on_their_way_.erase(on_their_way_.begin());
    }
    for (const Heard& heard : std::exchange(heard_, {})) {
      if (!heard.topic) {
        sink_.on_certificate(heard.bytes);
      } else if (config_.overhears || codec::info(*heard.topic).readers.has(config_.role)) {
        sink_.on_sample(*heard.topic, heard.author.node, heard.author.instance, heard.bytes);
      }
    }
    speak();
  }
}

/// Until the next multiple of gather_ at least, but for what this node itself says; from then on
/// for what is due or comes.
void AirCarrier::wait() {
  const Instant now = steady_now();
  const Instant tick{(now.time_since_epoch() / gather_ + 1) * gather_};
  Duration more{};
  {
    const std::lock_guard lock{mutex_};
    Instant due = link_.due();
    if (!on_their_way_.empty()) due = std::min(due, on_their_way_.begin()->first);
    sleeps_until_ = std::max(due, tick);
    more = sleeps_until_ - tick;
  }
  std::array<pollfd, 2> ready{pollfd{wake_.get(), POLLIN, 0}, {socket_.descriptor(), POLLIN, 0}};
  const std::span all{ready};
  if (!wait_for(all.first(1), tick - now) && more > Duration{}) (void)wait_for(all, more);
  eventfd_t ignored = 0;
  if ((ready[0].revents & POLLIN) != 0) (void)eventfd_read(wake_.get(), &ignored);
}

void AirCarrier::receive(std::span<const std::uint8_t> datagram) {
  const auto sender = radio_ ? sender_of(datagram) : std::nullopt;
  if (!sender) return arrive(datagram);
  const Instant now = steady_now();
  for (const Duration delay : radio_->arrivals(*sender, datagram.size())) {
    if (delay == Duration{}) {
      arrive(datagram);
    } else if (on_their_way_.size() < kOnTheirWayMax) {
      // At the nearest moment when the thread is awake.
      const auto multiples = (now + delay + gather_ / 2).time_since_epoch() / gather_;
      on_their_way_.emplace(Instant{multiples * gather_},
                            std::vector<std::uint8_t>{datagram.begin(), datagram.end()});
    }
  }
}

void AirCarrier::arrive(std::span<const std::uint8_t> datagram) {
  if (seals_) {
    if (is_key_news(datagram)) return seals_->news.hear(datagram);
    const auto header = seal::read_header(datagram);
    if (header && is_own_voice(*header)) return;
    if (header && seals_->news.has_any()) tell_news(*header);
  }
  const auto opened = seals_ ? unseal(datagram, plain_) : read_clear(datagram);
  count_reception(datagram, opened);
  if (!opened || !opened->content) return;
  const std::lock_guard lock{mutex_};
  link_.hear(*opened, datagram, steady_now());
}

/// Also where others have passed it on before: that its sender itself is heard is what counts.
void AirCarrier::count_reception(std::span<const std::uint8_t> datagram,
                                 const std::optional<air::Opened>& opened) {
  std::optional<air::Opened> from = opened;
  if (!from) {
    const auto header = seals_ ? seal::read_header(datagram) : std::nullopt;
    if (!header || !seals_->opener.has_opened(*header)) return;
    from = air::Opened{author_of(header->from), header->counter, std::nullopt};
  }
  receptions_.came({from->author.node, from->author.instance}, from->counter,
                   datagram.size() + kIpUdpBytes, steady_now());
}

/// Copies over several nodes are no replays, and not counted as such.
std::optional<air::Opened> AirCarrier::open(std::span<const std::uint8_t> datagram) {
  if (!seals_) {
    const auto opened = read_clear(datagram);
    if (opened) note_sent(*opened);
    return opened;
  }
  const auto header = seal::read_header(datagram);
  if (header && is_own_voice(*header)) return std::nullopt;
  if (header && seals_->opener.has_opened(*header)) {
    return air::Opened{author_of(header->from), header->counter, std::nullopt};
  }
  const auto opened = unseal(datagram, inner_);
  if (opened) note_sent(*opened);
  return opened;
}

void AirCarrier::note_sent(const air::Opened& passed_on) {
  receptions_.was_sent({passed_on.author.node, passed_on.author.instance}, passed_on.counter,
                       steady_now());
}

std::optional<air::Opened> AirCarrier::unseal(std::span<const std::uint8_t> datagram,
                                              std::vector<std::uint8_t>& plain) {
  const auto outcome = seals_->opener.open(datagram, plain, steady_now());
  if (outcome.opened != seal::Opened::good) return std::nullopt;
  return air::Opened{author_of(outcome.from), seal::read_header(datagram)->counter, plain};
}

std::optional<air::Opened> AirCarrier::read_clear(std::span<const std::uint8_t> datagram) {
  if (!is_clear(datagram)) {
    ++misformed_;
    return std::nullopt;
  }
  if (number_in(datagram.subspan(1, 4)) != config_.domain) return std::nullopt;
  const air::Author author{VehicleId{static_cast<std::uint16_t>(number_in(datagram.subspan(5, 2)))},
                           InstanceId{number_in(datagram.subspan(7, 8))}};
  const std::uint64_t counter = number_in(datagram.subspan(15, 5));
  if (!heard_clear_.is_first(author, counter)) return air::Opened{author, counter, std::nullopt};
  return air::Opened{author, counter, datagram.subspan(kClearBytes)};
}

void AirCarrier::on_sample(std::uint8_t channel, const air::Author& author,
                           std::span<const std::uint8_t> bytes) {
  heard_.push_back({static_cast<Topic>(channel), author, {bytes.begin(), bytes.end()}});
}

void AirCarrier::on_certificate(const air::Author& author, std::span<const std::uint8_t> bytes) {
  heard_.push_back({std::nullopt, author, {bytes.begin(), bytes.end()}});
}

/// Of this start, or of one before it: who recorded that and says it again is no twin of ours.
bool AirCarrier::is_own_voice(const seal::Header& header) const {
  const seal::SenderStart& own = config_.seal->start;
  return header.from == own ||
         (header.from.sender == own.sender && header.from.number < own.number);
}

/// Who speaks under an older key is told of the newer.
void AirCarrier::tell_news(const seal::Header& header) {
  const auto known = seals_->opener.newest_epoch_of(header.from.sender);
  const auto news =
      seals_->news.due(header.from.sender, std::max(header.epoch, known), steady_now());
  if (news) (void)socket_.send(*news);
}

void AirCarrier::speak() {
  for (;;) {
    std::optional<std::vector<std::uint8_t>> content;
    {
      const std::lock_guard lock{mutex_};
      content = link_.poll(steady_now());
    }
    if (!content) return;
    if (seals_) {
      if (!seals_->sealer.seal(*content, out_)) return;
    } else {
      out_.clear();
      put(out_, kClearMark, 1);
      put(out_, config_.domain, 4);
      put(out_, config_.self.value, 2);
      put(out_, config_.instance.value, 8);
      put(out_, said_clear_++, 5);
      out_.insert(out_.end(), content->begin(), content->end());
    }
    (void)socket_.send(out_);
  }
}

Result<std::unique_ptr<Carrier>> open_air_carrier(CarrierConfig config, CarrierSink& sink) {
  auto radio = open_radio(config);
  if (!radio) return radio.error();
  auto socket = AirSocket::open(config.air->group, config.endpoint.address);
  if (!socket) return socket.error();
  system::Descriptor wake{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  if (wake.get() < 0) return Error{"there is no event to wake the network's thread with"};
  return std::unique_ptr<Carrier>{
      std::make_unique<AirCarrier>(std::move(config), sink, std::move(socket).value(),
                                   std::move(wake), std::move(radio).value())};
}

}  // namespace skein::network
