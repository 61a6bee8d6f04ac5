// SPDX-License-Identifier: Apache-2.0
#include "dds_carrier.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <span>
#include <string>
#include <utility>

#include "byte_sample.hpp"
#include "carrier_check.hpp"
#include "dds_settings.hpp"
#include "rtps_datagram.hpp"
#include "signatures.hpp"
#include "skein/base/assert.hpp"
#include "skein/codec/codec.hpp"

namespace skein::network {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using codec::kTopicCount;
using codec::kTopics;
using codec::Role;
using codec::Topic;
using codec::TopicInfo;
using eprosima::fastrtps::types::ReturnCode_t;

std::uint32_t shared_endpoints(Role self, Role peer) {
  std::uint32_t count = 0;
  for (const TopicInfo& t : kTopics) {
    if (t.writers.has(self) && t.readers.has(peer)) ++count;
    if (t.readers.has(self) && t.writers.has(peer)) ++count;
  }
  return count;
}

sockaddr_in socket_address(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr);
  return address;
}

}  // namespace

DdsCarrier::DdsCarrier(CarrierConfig config, CarrierSink& sink)
    : config_{std::move(config)},
      sink_{sink},
      prefix_{guid_prefix(config_.self, config_.instance, config_.run)} {
  if (config_.seal) {
    const auto& seal = *config_.seal;
    seals_ = std::make_shared<Seals>(seal.start, seal.key, seal.counters, places_of(config_));
  }
  for (std::size_t i = 0; i < kTopicCount; ++i) {
    listeners_.at(i).carrier = this;
    listeners_.at(i).topic = static_cast<Topic>(i);
  }
}

DdsCarrier::~DdsCarrier() {
  if (burial_ >= 0) close(burial_);
  if (participant_ == nullptr) return;
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

Result<void> DdsCarrier::prepare() {
  if (auto r = check(config_); !r) return r;
  if (auto r = check_ports(config_); !r) return r;
  auto qos = participant_qos(config_, seals_);
  if (!qos) return qos.error();
  qos_ = std::move(*qos);
  if (config_.run != 0) burial_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  return {};
}

Result<void> DdsCarrier::join() {
  SKEIN_ASSERT(qos_);
  const std::string who = "node " + std::to_string(config_.self.value);
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
      config_.domain, *qos_, this, dds::StatusMask::none());
  qos_.reset();
  if (participant_ == nullptr) {
    return Error{who + ": Fast DDS cannot start on " + to_text(config_.endpoint) +
                 ": does another node of this process have the same vehicle and instance id?"};
  }
  dds::Publisher* publisher = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  dds::Subscriber* subscriber = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (publisher == nullptr || subscriber == nullptr) {
    return Error{who + ": Fast DDS has no room for a publisher and a subscriber"};
  }
  for (std::size_t index = 0; index < kTopicCount; ++index) {
    const TopicInfo& t = kTopics.at(index);
    if (!t.writers.has(config_.role) && !t.readers.has(config_.role)) continue;
    if (auto r = make_topic(static_cast<Topic>(index), *publisher, *subscriber); !r) return r;
  }
  return {};
}

Result<void> DdsCarrier::make_topic(Topic kind, dds::Publisher& publisher,
                                    dds::Subscriber& subscriber) {
  const auto index = static_cast<std::size_t>(kind);
  const TopicInfo& t = kTopics.at(index);
  const std::string type_name{t.type};
  const std::size_t size_max =
      codec::encoded_size_max(kind) + (config_.certificate.empty() ? 0 : kSignatureBytes);
  const dds::TypeSupport type{new ByteSampleType{type_name, size_max}};
  dds::Topic* topic = nullptr;
  if (type.register_type(participant_) == ReturnCode_t::RETCODE_OK) {
    topic = participant_->create_topic(std::string{t.name}, type_name, dds::TOPIC_QOS_DEFAULT);
  }
  TopicListener& listener = listeners_.at(index);
  bool made = topic != nullptr;
  if (made && t.writers.has(config_.role)) {
    writers_.at(index) =
        publisher.create_datawriter(topic, writer_qos(t), &listener, dds::StatusMask::all());
    made = writers_.at(index) != nullptr;
  }
  if (made && t.readers.has(config_.role)) {
    readers_.at(index) =
        subscriber.create_datareader(topic, reader_qos(t), &listener, dds::StatusMask::all());
    made = readers_.at(index) != nullptr;
  }
  if (made) return {};
  return Error{"node " + std::to_string(config_.self.value) + ": Fast DDS refuses the topic " +
               std::string{t.name}};
}

Written DdsCarrier::write(Topic topic, std::vector<std::uint8_t> bytes) {
  dds::DataWriter* writer = writers_.at(static_cast<std::size_t>(topic));
  SKEIN_ASSERT(writer != nullptr);
  ByteSample sample{std::move(bytes)};
  if (!writer->write(&sample)) return Written::no_room;
  const auto& readers = listeners_.at(static_cast<std::size_t>(topic)).readers;
  if (seals_ && readers.load(std::memory_order_relaxed) > 0) seals_->progress.written(steady_now());
  return Written::yes;
}

void DdsCarrier::TopicListener::on_data_available(dds::DataReader* reader) {
  carrier->receive(topic, *reader);
}

void DdsCarrier::TopicListener::on_subscription_matched(
    dds::DataReader*, const dds::SubscriptionMatchedStatus& status) {
  carrier->matched(status.last_publication_handle, status.current_count_change);
}

void DdsCarrier::TopicListener::on_publication_matched(
    dds::DataWriter*, const dds::PublicationMatchedStatus& status) {
  const auto& reader = status.last_subscription_handle;
  // To its own reader nothing goes out.
  if (rtps::iHandle2GUID(reader).guidPrefix != carrier->prefix_) {
    readers.fetch_add(status.current_count_change, std::memory_order_relaxed);
  }
  carrier->matched(reader, status.current_count_change);
}

void DdsCarrier::receive(Topic topic, dds::DataReader& reader) {
  ByteSample sample;
  dds::SampleInfo sample_info;
  while (reader.take_next_sample(&sample, &sample_info) == ReturnCode_t::RETCODE_OK) {
    if (!sample_info.valid_data) continue;
    const rtps::GUID_t writer = rtps::iHandle2GUID(sample_info.publication_handle);
    if (writer.guidPrefix == prefix_) continue;
    if (const auto sender = vehicle_of(writer.guidPrefix)) {
      // A writer counts what it writes; of what is sent again no gap tells of the air.
      if (!kTopics.at(static_cast<std::size_t>(topic)).reliable) {
        receptions_.came(
            {*sender, instance_of(writer.guidPrefix), static_cast<std::uint8_t>(topic)},
            sample_info.sample_identity.sequence_number().to64long(), sample.bytes.size(),
            steady_now());
      }
      sink_.on_sample(topic, *sender, instance_of(writer.guidPrefix), sample.bytes);
    } else {
      unknown_senders_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

void DdsCarrier::on_participant_discovery(dds::DomainParticipant*,
                                          rtps::ParticipantDiscoveryInfo&& discovered) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const std::lock_guard lock{peers_mutex_};
  const rtps::GuidPrefix_t& prefix = discovered.info.m_guid.guidPrefix;
  if (discovered.status == Info::REMOVED_PARTICIPANT ||
      discovered.status == Info::DROPPED_PARTICIPANT) {
    peers_.erase(prefix);
  } else if (const auto peer = read_peer(discovered.info)) {
    peers_[prefix].peer = peer;
    const auto& data = discovered.info.m_userData.data_vec();
    if (data.size() > kUserDataBytes) {
      sink_.on_certificate(std::span{data}.subspan(kUserDataBytes));
    }
  }
}

void DdsCarrier::matched(const rtps::InstanceHandle_t& handle, std::int32_t change) {
  const rtps::GuidPrefix_t prefix = rtps::iHandle2GUID(handle).guidPrefix;
  if (prefix == prefix_) return;
  const std::lock_guard lock{peers_mutex_};
  const auto found = peers_.find(prefix);
  if (found != peers_.end()) {
    found->second.matched += change;
  } else if (change > 0) {
    peers_[prefix].matched = change;
  }
}

std::vector<Peer> DdsCarrier::peers() const {
  std::vector<Peer> all;
  const std::lock_guard lock{peers_mutex_};
  for (const auto& [prefix, state] : peers_) {
    if (!state.peer || state.matched < shared_endpoints(config_.role, state.peer->role)) continue;
    // Of a node whose carrier was started again, the one before may still be known.
    const bool known = std::ranges::any_of(all, [&peer = *state.peer](const Peer& other) {
      return other.id == peer.id && other.instance == peer.instance;
    });
    if (!known) all.push_back(*state.peer);
  }
  return all;
}

std::vector<Reception> DdsCarrier::receptions() const { return receptions_.all(steady_now()); }

void DdsCarrier::change_key(const seal::EpochKey& key, Duration old_for) {
  SKEIN_ASSERT(seals_ != nullptr);
  seals_->change_key(key, old_for);
}

void DdsCarrier::tell(const std::vector<KeyNews>& news) {
  if (seals_) seals_->news.tell(news);
}

std::optional<std::vector<std::uint8_t>> DdsCarrier::take_key_news() {
  return seals_ ? seals_->news.take() : std::nullopt;
}

CarrierCounts DdsCarrier::counts() const {
  CarrierCounts counts{};
  const auto set = [&counts](CarrierCount count, std::uint64_t value) {
    counts.at(static_cast<std::size_t>(count)) = value;
  };
  set(CarrierCount::unknown_sender, unknown_senders_.load(std::memory_order_relaxed));
  if (seals_) {
    set(CarrierCount::misformed, seals_->misformed.load(std::memory_order_relaxed));
    const auto opened = seals_->opener.counts();
    std::ranges::copy(opened, counts.begin() + static_cast<std::ptrdiff_t>(CarrierCount::opened));
  }
  return counts;
}

bool DdsCarrier::gets_on(Duration within) const {
  if (seals_ && seals_->progress.longest(steady_now()) > within) return false;
  // Each takes the lock that its threads work under, and waits for nothing else.
  for (dds::DataReader* reader : readers_) {
    dds::SampleInfo none;
    if (reader != nullptr) (void)reader->get_first_untaken_info(&none);
  }
  for (dds::DataWriter* writer : writers_) {
    if (writer != nullptr) (void)writer->wait_for_acknowledgments({0, 0});
  }
  return true;
}

void DdsCarrier::bury_predecessor() const {
  if (burial_ < 0) return;
  const auto before = static_cast<std::uint8_t>(config_.run - 1);
  const rtps::GuidPrefix_t its = guid_prefix(config_.self, config_.instance, before);
  std::vector<std::uint8_t> datagram = participant_gone(its.value);
  if (seals_) {
    std::vector<std::uint8_t> sealed_one;
    do {
      if (!seals_->sealer.seal(datagram, sealed_one)) return;
    } while (looks_like_statistics(sealed_one));
    datagram = std::move(sealed_one);
  }
  for (const PeerConfig& peer : config_.peers) {
    const sockaddr_in to = socket_address(peer.endpoint);
    (void)sendto(burial_, datagram.data(), datagram.size(), 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
}

void DdsCarrier::extend_counters(std::uint64_t end) {
  if (seals_) seals_->sealer.extend(end);
}

std::uint64_t DdsCarrier::next_counter() const { return seals_ ? seals_->sealer.next() : 0; }

CarrierConfig carrier_config(const NodeConfig& config) {
  CarrierConfig carrier;
  carrier.domain = config.domain;
  carrier.self = config.self;
  carrier.instance = config.instance;
  carrier.role = config.role;
  carrier.endpoint = config.endpoint;
  carrier.peers = config.peers;
  carrier.air = config.air;
  if (config.seal) carrier.seal = CarrierConfig::Seal{config.seal->start, config.seal->key, {}};
  carrier.overhears = config.overhears;
  if (config.sign) carrier.certificate = identity::to_bytes(config.sign->own);
  carrier.transport_plugin = config.transport_plugin;
  return carrier;
}

Result<std::unique_ptr<Carrier>> open_dds_carrier(CarrierConfig config, CarrierSink& sink) {
  auto carrier = std::make_unique<DdsCarrier>(std::move(config), sink);
  if (auto r = carrier->prepare(); !r) return r.error();
  if (auto r = carrier->join(); !r) return r.error();
  return std::unique_ptr<Carrier>{std::move(carrier)};
}

}  // namespace skein::network

// Faults of Debian's Fast DDS 2.9.1 that are not ours to mend, and would end every sanitized
// process that has a node: it deletes objects under another size than it made them with, and GCC's
// ThreadSanitizer does not see its timed locks.
#if defined(__SANITIZE_ADDRESS__)
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }
#elif defined(__SANITIZE_THREAD__)
extern "C" const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libfastrtps.so\ndeadlock:libfastrtps.so\n";
}
#endif
