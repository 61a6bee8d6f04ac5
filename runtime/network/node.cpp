// SPDX-License-Identifier: Apache-2.0
#include "skein/network/node.hpp"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <mutex>
#include <set>
#include <span>
#include <system_error>
#include <tuple>
#include <utility>

#include "byte_sample.hpp"
#include "sealed_transport.hpp"
#include "signatures.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/codec/codec.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/network/rtps_guid.hpp"
#include "skein/network/transport_plugin.hpp"

namespace skein::network {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using codec::kTopicCount;
using codec::kTopics;
using codec::Role;
using codec::Topic;
using codec::TopicInfo;
using eprosima::fastdds::rtps::TransportDescriptorInterface;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

// A vehicle out of radio range is still a member of the fleet: its match is kept, and repaired when
// it comes back. Who is lost is for the failure detector of the coalition to say.
constexpr Duration kParticipantLease = std::chrono::seconds{300};
constexpr Duration kAnnouncementPeriod = std::chrono::seconds{2};
constexpr std::uint32_t kFirstAnnouncements = 10;
constexpr Duration kFirstAnnouncementPeriod = std::chrono::milliseconds{200};
constexpr Duration kWriteWaitMax =
    std::chrono::milliseconds{5};  // for a lock inside DDS, never for a reader
constexpr std::uint32_t kSocketBufferBytes = 1U << 20U;
constexpr std::size_t kMisfitsMax = 100;

enum class Counter : std::uint8_t {
  published,
  publish_refused_value,
  publish_refused_role,
  publish_failed,
  received,
  dropped_full,
  malformed,
  bad_version,
  bad_value,
  unknown_kind,
  unknown_sender,
  signature_missing,
  signature_forged,
  signature_replayed,
  count
};
constexpr std::array<const char*, static_cast<std::size_t>(Counter::count)> kCounterNames{
    "published",
    "publish_refused_value",
    "publish_refused_role",
    "publish_failed",
    "received",
    "dropped_full",
    "malformed",
    "bad_version",
    "bad_value",
    "unknown_kind",
    "unknown_sender",
    "signature_missing",
    "signature_forged",
    "signature_replayed"};

Duration_t dds_duration(Duration d) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(d);
  return {static_cast<std::int32_t>(seconds.count()),
          static_cast<std::uint32_t>((d - seconds).count())};
}

std::string to_text(const Endpoint& e) { return e.address + ":" + std::to_string(e.port); }

rtps::GuidPrefix_t guid_prefix(VehicleId self, InstanceId instance) {
  rtps::GuidPrefix_t prefix;
  std::copy(kGuidMark.begin(), kGuidMark.end(), std::begin(prefix.value));
  prefix.value[4] = static_cast<rtps::octet>(self.value >> 8U);
  prefix.value[5] = static_cast<rtps::octet>(self.value & 0xFFU);
  for (unsigned i = 0; i < 6; ++i) {
    prefix.value[6 + i] = static_cast<rtps::octet>((instance.value >> (8U * i)) & 0xFFU);
  }
  return prefix;
}

std::optional<VehicleId> vehicle_of(const rtps::GuidPrefix_t& prefix) {
  if (!std::equal(kGuidMark.begin(), kGuidMark.end(), std::begin(prefix.value))) {
    return std::nullopt;
  }
  return VehicleId{static_cast<std::uint16_t>((prefix.value[4] << 8U) | prefix.value[5])};
}

/// As far as the prefix has it: all of one that has keys.
InstanceId instance_of(const rtps::GuidPrefix_t& prefix) {
  InstanceId instance;
  for (unsigned i = 0; i < 6; ++i) {
    instance.value |= std::uint64_t{prefix.value[6 + i]} << (8U * i);
  }
  return instance;
}

constexpr std::size_t kUserDataBytes = 9;  ///< before a certificate

/// Role and instance, as told to others with the announcement of the participant, and the
/// certificate of one that signs.
std::vector<rtps::octet> user_data(const NodeConfig& config) {
  std::vector<rtps::octet> data{static_cast<rtps::octet>(config.role)};
  for (unsigned i = 0; i < 8; ++i) {
    data.push_back(static_cast<rtps::octet>((config.instance.value >> (8U * i)) & 0xFFU));
  }
  if (config.sign) {
    const auto certificate = identity::to_bytes(config.sign->own);
    data.insert(data.end(), certificate.begin(), certificate.end());
  }
  return data;
}

std::optional<Peer> read_peer(const rtps::ParticipantProxyData& proxy) {
  const auto id = vehicle_of(proxy.m_guid.guidPrefix);
  const std::vector<rtps::octet>& data = proxy.m_userData.data_vec();
  if (!id || data.size() < kUserDataBytes || data[0] < 1 || data[0] > 2) return std::nullopt;
  std::uint64_t instance = 0;
  for (unsigned i = 0; i < 8; ++i) instance |= std::uint64_t{data[1 + i]} << (8U * i);
  return Peer{*id, InstanceId{instance}, static_cast<Role>(data[0])};
}

std::uint32_t shared_endpoints(Role self, Role peer) {
  std::uint32_t count = 0;
  for (const TopicInfo& t : kTopics) {
    if (t.writers.has(self) && t.readers.has(peer)) ++count;
    if (t.readers.has(self) && t.writers.has(peer)) ++count;
  }
  return count;
}

/// Binds and lets go: Fast DDS itself would carry on in silence with a port that it did not get.
Result<void> check_free(const Endpoint& endpoint, std::uint16_t port) {
  const Endpoint wanted{endpoint.address, port};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{std::string{"no UDP socket: "} + std::generic_category().message(errno)};
  const int status = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const int reason = errno;
  close(fd);
  if (status == 0) return {};
  if (reason == EADDRINUSE) {
    return Error{"UDP port " + to_text(wanted) +
                 " is already in use: is another node running with this address and port?"};
  }
  if (reason == EADDRNOTAVAIL) {
    return Error{"no network interface of this machine has the address " + endpoint.address};
  }
  return Error{"cannot listen on " + to_text(wanted) + ": " +
               std::generic_category().message(reason)};
}

Result<void> check_endpoint(const std::string& who, const Endpoint& e) {
  in_addr parsed{};
  if (inet_pton(AF_INET, e.address.c_str(), &parsed) != 1) {
    return Error{who + ": '" + e.address + "' is no IPv4 address (such as 10.0.0.5)"};
  }
  if (e.port < 1024 || e.port > 65534) {
    return Error{who + ": port " + std::to_string(e.port) + " is not within 1024 to 65534"};
  }
  return {};
}

Result<void> check(const NodeConfig& config) {
  const std::string self = "node " + std::to_string(config.self.value);
  if (config.domain > 232) {
    return Error{self + ": domain " + std::to_string(config.domain) + " is not within 0 to 232"};
  }
  if (auto r = check_endpoint(self, config.endpoint); !r) return r;
  std::vector<PeerConfig> seen{{config.self, config.endpoint}};
  for (const PeerConfig& peer : config.peers) {
    const std::string name = self + ": peer " + std::to_string(peer.id.value);
    if (auto r = check_endpoint(name, peer.endpoint); !r) return r;
    for (const PeerConfig& other : seen) {
      if (other.id == peer.id) {
        return Error{name + (peer.id == config.self ? " is this node itself: leave it out"
                                                    : " is listed twice")};
      }
      if (other.endpoint.address == peer.endpoint.address &&
          std::abs(int{other.endpoint.port} - int{peer.endpoint.port}) < 2) {
        return Error{name + " at " + to_text(peer.endpoint) + " shares a port with node " +
                     std::to_string(other.id.value) + " at " + to_text(other.endpoint) +
                     ": each node needs two ports, its own and the next"};
      }
    }
    seen.push_back(peer);
  }
  for (const int offset : {0, 1}) {
    const auto port = static_cast<std::uint16_t>(config.endpoint.port + offset);
    if (auto r = check_free(config.endpoint, port); !r) return r;
  }
  return {};
}

rtps::Locator_t locator(const Endpoint& e, int offset) {
  rtps::Locator_t to;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, e.address,
                                 static_cast<std::uint32_t>(e.port + offset), to);
  return to;
}

Result<void> wrap(const NodeConfig& config,
                  std::shared_ptr<TransportDescriptorInterface>& transport) {
  if (config.transport_plugin.empty()) return {};
  // Never closed: threads of the network may still be in its code when the node goes.
  void* library = dlopen(config.transport_plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    // glibc keeps it per thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
    return Error{std::string{"cannot load the transport: "} + dlerror()};
  }
  const auto factory = reinterpret_cast<WrapTransport>(dlsym(library, kWrapTransportSymbol));
  if (factory == nullptr) {
    return Error{"the transport " + config.transport_plugin + " does not export " +
                 kWrapTransportSymbol};
  }
  if (const char* reason = factory(transport, config.self.value)) {
    return Error{"the transport " + config.transport_plugin + " refuses: " + reason};
  }
  return {};
}

/// Both ports of each peer.
std::map<Seals::Place, VehicleId> places_of(const NodeConfig& config) {
  std::map<Seals::Place, VehicleId> places;
  for (const PeerConfig& peer : config.peers) {
    in_addr address{};
    if (inet_pton(AF_INET, peer.endpoint.address.c_str(), &address) != 1) continue;  // see check()
    for (const int port : {0, 1}) {
      places.emplace(Seals::Place{ntohl(address.s_addr),
                                  static_cast<std::uint16_t>(peer.endpoint.port + port)},
                     peer.id);
    }
  }
  return places;
}

Result<dds::DomainParticipantQos> participant_qos(const NodeConfig& config,
                                                  const std::shared_ptr<Seals>& seals) {
  auto udp = std::make_shared<UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(config.endpoint.address);
  udp->non_blocking_send = true;
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  std::shared_ptr<TransportDescriptorInterface> transport = udp;
  if (auto r = wrap(config, transport); !r) return r.error();
  if (seals) transport = sealed(std::move(transport), seals);  // above a radio, as on the air

  dds::DomainParticipantQos qos;
  qos.name("skein-" + std::to_string(config.self.value));
  qos.user_data().data_vec(user_data(config));
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  auto& wire = qos.wire_protocol();
  wire.prefix = guid_prefix(config.self, config.instance);
  wire.default_unicast_locator_list.push_back(locator(config.endpoint, 1));
  wire.builtin.metatrafficUnicastLocatorList.push_back(locator(config.endpoint, 0));
  for (const PeerConfig& peer : config.peers) {
    wire.builtin.initialPeersList.push_back(locator(peer.endpoint, 0));
  }
  // Without a peer Fast DDS would fall back on multicast: speak to oneself instead.
  if (config.peers.empty()) {
    wire.builtin.initialPeersList.push_back(locator(config.endpoint, 0));
  }
  wire.builtin.use_WriterLivelinessProtocol = false;
  wire.builtin.avoid_builtin_multicast = true;
  auto& discovery = wire.builtin.discovery_config;
  discovery.leaseDuration = dds_duration(kParticipantLease);
  discovery.leaseDuration_announcementperiod = dds_duration(kAnnouncementPeriod);
  discovery.initial_announcements = {kFirstAnnouncements, dds_duration(kFirstAnnouncementPeriod)};
  return qos;
}

dds::DataWriterQos writer_qos(const TopicInfo& t) {
  dds::DataWriterQos qos;
  qos.reliability().kind =
      t.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = dds_duration(kWriteWaitMax);
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = t.writer_history;
  qos.resource_limits().max_samples = t.writer_history;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = t.writer_history;
  qos.resource_limits().allocated_samples = std::min(t.writer_history, 8);
  qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().off();
  if (t.reliable) {
    qos.reliable_writer_qos().times.heartbeatPeriod = dds_duration(codec::kHeartbeatPeriod);
    qos.reliable_writer_qos().times.nackResponseDelay = dds_duration(Duration{});
  }
  return qos;
}

dds::DataReaderQos reader_qos(const TopicInfo& t) {
  dds::DataReaderQos qos;
  qos.reliability().kind =
      t.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = t.reader_history;
  qos.resource_limits().max_samples = t.reader_history;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = t.reader_history;
  qos.resource_limits().allocated_samples = std::min(t.reader_history, 8);
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

}  // namespace

/// The participant, and what its threads share with the caller.
class Node::Impl : public dds::DomainParticipantListener {
 public:
  explicit Impl(const NodeConfig& config)
      : config_{config},
        prefix_{guid_prefix(config.self, config.instance)},
        queue_{config.queue_limit} {
    if (config.seal) {
      seals_ = std::make_shared<Seals>(config.seal->start, config.seal->key, places_of(config));
    }
    if (config.sign) {
      signatures_ = std::make_unique<Signatures>(*config.sign, config.self, config.instance);
    }
    for (std::size_t i = 0; i < kTopicCount; ++i) {
      listeners_.at(i).node = this;
      listeners_.at(i).topic = static_cast<Topic>(i);
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() override;

  Result<void> open();
  bool publish(const mission::Message& message);
  std::optional<Received> poll();
  std::vector<Peer> peers() const;
  std::vector<Misfit> take_misfits();
  std::map<std::string, std::uint64_t> counters() const;
  void change_key(const seal::EpochKey& key, Duration old_for);
  [[nodiscard]] std::optional<std::uint8_t> epoch() const {
    return seals_ ? std::optional{seals_->epoch()} : std::nullopt;
  }
  void learn(const identity::RevocationList& revoked) {
    if (signatures_) signatures_->learn(revoked);
  }
  [[nodiscard]] KeyNewsDesk* news() { return seals_ ? &seals_->news : nullptr; }

 private:
  /// One per topic, so that a sample is known by its listener.
  struct TopicListener : dds::DataReaderListener, dds::DataWriterListener {
    Impl* node = nullptr;
    Topic topic = Topic::count;
    void on_data_available(dds::DataReader* reader) override { node->receive(topic, *reader); }
    void on_subscription_matched(dds::DataReader*,
                                 const dds::SubscriptionMatchedStatus& s) override {
      node->matched(s.last_publication_handle, s.current_count_change);
    }
    void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& s) override {
      node->matched(s.last_subscription_handle, s.current_count_change);
    }
  };
  struct PeerState {
    std::optional<Peer> peer;  ///< none until its announcement was read
    std::int64_t matched = 0;
  };

  void on_participant_discovery(dds::DomainParticipant* participant,
                                rtps::ParticipantDiscoveryInfo&& info) override;
  void receive(Topic topic, dds::DataReader& reader);
  void accept(Topic topic, const ByteSample& sample, const rtps::GuidPrefix_t& from);
  void refuse(Topic topic, const codec::Refusal& refusal, VehicleId sender);
  void refuse(Signatures::Judged judged);
  void matched(const rtps::InstanceHandle_t& handle, std::int32_t change);
  void count(Counter counter) {
    counters_.at(static_cast<std::size_t>(counter)).fetch_add(1, std::memory_order_relaxed);
  }

  NodeConfig config_;
  rtps::GuidPrefix_t prefix_;
  std::shared_ptr<Seals> seals_;            ///< none: in clear
  std::unique_ptr<Signatures> signatures_;  ///< none: decisions are not signed
  std::array<std::atomic<std::uint64_t>, kCounterNames.size()> counters_{};
  mutable std::mutex queue_mutex_;
  BoundedQueue<Received> queue_;
  std::mutex misfits_mutex_;
  std::set<std::tuple<VehicleId, Topic, std::uint16_t>> misfits_seen_;
  std::vector<Misfit> misfits_;
  mutable std::mutex peers_mutex_;
  std::map<rtps::GuidPrefix_t, PeerState> peers_;
  std::array<TopicListener, kTopicCount> listeners_;
  std::array<dds::DataWriter*, kTopicCount> writers_{};
  dds::DomainParticipant* participant_ = nullptr;
};

Result<void> Node::Impl::open() {
  if (auto r = check(config_); !r) return r;
  auto qos = participant_qos(config_, seals_);
  if (!qos) return qos.error();
  const std::string who = "node " + std::to_string(config_.self.value);
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
      config_.domain, *qos, this, dds::StatusMask::none());
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
    const bool writes = t.writers.has(config_.role);
    const bool reads = t.readers.has(config_.role);
    if (!writes && !reads) continue;
    const std::string type_name{t.type};
    const std::size_t size_max =
        codec::encoded_size_max(static_cast<Topic>(index)) + (signatures_ ? kSignatureBytes : 0);
    const dds::TypeSupport type{new ByteSampleType{type_name, size_max}};
    dds::Topic* topic = nullptr;
    if (type.register_type(participant_) == ReturnCode_t::RETCODE_OK) {
      topic = participant_->create_topic(std::string{t.name}, type_name, dds::TOPIC_QOS_DEFAULT);
    }
    TopicListener& listener = listeners_.at(index);
    bool made = topic != nullptr;
    if (made && writes) {
      writers_.at(index) =
          publisher->create_datawriter(topic, writer_qos(t), &listener, dds::StatusMask::all());
      made = writers_.at(index) != nullptr;
    }
    if (made && reads) {
      made = subscriber->create_datareader(topic, reader_qos(t), &listener,
                                           dds::StatusMask::all()) != nullptr;
    }
    if (!made) return Error{who + ": Fast DDS refuses the topic " + std::string{t.name}};
  }
  return {};
}

Node::Impl::~Impl() {
  if (participant_ == nullptr) return;
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

bool Node::Impl::publish(const mission::Message& message) {
  const Topic topic = codec::topic_of(message);
  dds::DataWriter* writer = writers_.at(static_cast<std::size_t>(topic));
  if (writer == nullptr) {
    count(Counter::publish_refused_role);
    return false;
  }
  auto bytes = codec::encode(message);
  if (!bytes) {
    count(Counter::publish_refused_value);
    return false;
  }
  if (signatures_ && mission::is_signed(message)) signatures_->sign(topic, *bytes);
  ByteSample sample{std::move(*bytes)};
  const bool written = writer->write(&sample);
  count(written ? Counter::published : Counter::publish_failed);
  return written;
}

std::optional<Received> Node::Impl::poll() {
  const std::lock_guard lock{queue_mutex_};
  return queue_.pop();
}

void Node::Impl::receive(Topic topic, dds::DataReader& reader) {
  ByteSample sample;
  dds::SampleInfo sample_info;
  while (reader.take_next_sample(&sample, &sample_info) == ReturnCode_t::RETCODE_OK) {
    if (!sample_info.valid_data) continue;
    const rtps::GUID_t writer = rtps::iHandle2GUID(sample_info.publication_handle);
    if (writer.guidPrefix == prefix_) continue;
    accept(topic, sample, writer.guidPrefix);
  }
}

void Node::Impl::accept(Topic topic, const ByteSample& sample, const rtps::GuidPrefix_t& from) {
  const auto sender = vehicle_of(from);
  if (!sender) {
    count(Counter::unknown_sender);
    return;
  }
  std::span<const std::uint8_t> body{sample.bytes};
  const auto signature = signatures_ ? cut_signature(body) : std::nullopt;
  auto decoded = codec::decode(topic, body);
  if (const auto* refusal = std::get_if<codec::Refusal>(&decoded)) {
    return refuse(topic, *refusal, *sender);
  }
  auto& message = *std::get_if<mission::Message>(&decoded);
  if (signatures_ && mission::is_signed(message)) {
    auto judged = signatures_->judge(topic, *sender, instance_of(from), body, signature);
    if (judged == Signatures::Judged::good) judged = signatures_->judge_approval(message);
    if (judged != Signatures::Judged::good) return refuse(judged);
  }
  bool room = false;
  {
    const std::lock_guard lock{queue_mutex_};
    room = queue_.push(Received{std::move(message), *sender});
  }
  count(room ? Counter::received : Counter::dropped_full);
  if (room && config_.on_received) config_.on_received();
}

void Node::Impl::refuse(Signatures::Judged judged) {
  switch (judged) {
    case Signatures::Judged::missing:
      return count(Counter::signature_missing);
    case Signatures::Judged::forged:
      return count(Counter::signature_forged);
    case Signatures::Judged::replayed:
      return count(Counter::signature_replayed);
    case Signatures::Judged::good:
    case Signatures::Judged::count:
      return;
  }
}

void Node::Impl::refuse(Topic topic, const codec::Refusal& refusal, VehicleId sender) {
  switch (refusal.fault) {
    case codec::Fault::malformed:
      return count(Counter::malformed);
    case codec::Fault::bad_value:
      return count(Counter::bad_value);
    case codec::Fault::unknown_kind:
      return count(Counter::unknown_kind);
    case codec::Fault::bad_version:
      break;
  }
  count(Counter::bad_version);
  const std::lock_guard lock{misfits_mutex_};
  if (misfits_seen_.size() >= kMisfitsMax) return;  // or a stranger fills the memory
  if (!misfits_seen_.emplace(sender, topic, refusal.version).second) return;
  misfits_.push_back({sender, codec::text_of(refusal, topic)});
}

std::vector<Misfit> Node::Impl::take_misfits() {
  const std::lock_guard lock{misfits_mutex_};
  return std::exchange(misfits_, {});
}

void Node::Impl::on_participant_discovery(dds::DomainParticipant*,
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
    if (signatures_ && data.size() > kUserDataBytes) {
      signatures_->learn(std::span{data}.subspan(kUserDataBytes));
    }
  }
}

void Node::Impl::matched(const rtps::InstanceHandle_t& handle, std::int32_t change) {
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

void Node::Impl::change_key(const seal::EpochKey& key, Duration old_for) {
  SKEIN_ASSERT(seals_ != nullptr);
  seals_->change_key(key, old_for);
}

std::vector<Peer> Node::Impl::peers() const {
  std::vector<Peer> all;
  const std::lock_guard lock{peers_mutex_};
  for (const auto& [prefix, state] : peers_) {
    if (state.peer && state.matched >= shared_endpoints(config_.role, state.peer->role)) {
      all.push_back(*state.peer);
    }
  }
  return all;
}

std::map<std::string, std::uint64_t> Node::Impl::counters() const {
  std::map<std::string, std::uint64_t> all;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    all.emplace(kCounterNames.at(i), counters_.at(i).load(std::memory_order_relaxed));
  }
  if (seals_) {
    const auto counts = seals_->opener.counts();
    for (std::size_t i = 0; i < counts.size(); ++i) {
      all.emplace(std::string{"seal_"} + seal::to_text(static_cast<seal::Opened>(i)), counts.at(i));
    }
    all.emplace("seal_misformed", seals_->misformed.load(std::memory_order_relaxed));
  }
  return all;
}

Node::Node(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Node::~Node() = default;

Result<std::unique_ptr<Node>> Node::open(const NodeConfig& config) {
  auto impl = std::make_unique<Impl>(config);
  if (auto r = impl->open(); !r) return r.error();
  return std::unique_ptr<Node>{new Node{std::move(impl)}};
}

bool Node::publish(const mission::Message& message) { return impl_->publish(message); }
std::optional<Received> Node::poll() { return impl_->poll(); }
std::vector<Peer> Node::peers() const { return impl_->peers(); }
void Node::change_key(const seal::EpochKey& key, Duration old_for) {
  impl_->change_key(key, old_for);
}
void Node::learn(const identity::RevocationList& revoked) { impl_->learn(revoked); }
std::optional<std::uint8_t> Node::epoch() const { return impl_->epoch(); }
void Node::tell(const std::vector<KeyNews>& news) {
  if (auto* desk = impl_->news()) desk->tell(news);
}
std::optional<std::vector<std::uint8_t>> Node::take_key_news() {
  auto* desk = impl_->news();
  return desk != nullptr ? desk->take() : std::nullopt;
}
std::vector<Misfit> Node::take_misfits() { return impl_->take_misfits(); }
std::map<std::string, std::uint64_t> Node::counters() const { return impl_->counters(); }

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
