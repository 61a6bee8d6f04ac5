// SPDX-License-Identifier: Apache-2.0
#include "dds_settings.hpp"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <netinet/in.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "skein/network/rtps_guid.hpp"
#include "skein/network/transport_plugin.hpp"

namespace skein::network {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using codec::TopicInfo;
using eprosima::fastdds::rtps::TransportDescriptorInterface;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::Duration_t;

// A vehicle out of radio range is still a member of the fleet: its match is kept, and repaired when
// it comes back. Who is lost is for the failure detector of the coalition to say.
constexpr Duration kParticipantLease = std::chrono::seconds{300};
constexpr Duration kAnnouncementPeriod = std::chrono::seconds{2};
constexpr std::uint32_t kFirstAnnouncements = 10;
constexpr Duration kFirstAnnouncementPeriod = std::chrono::milliseconds{200};
constexpr Duration kWriteWaitMax =
    std::chrono::milliseconds{5};  // for a lock inside DDS, never for a reader
constexpr std::uint32_t kSocketBufferBytes = 1U << 20U;

Duration_t dds_duration(Duration d) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(d);
  return {static_cast<std::int32_t>(seconds.count()),
          static_cast<std::uint32_t>((d - seconds).count())};
}

/// Role and instance, as told to others with the announcement of the participant, and the
/// certificate of one that signs.
std::vector<rtps::octet> user_data(const CarrierConfig& config) {
  std::vector<rtps::octet> data{static_cast<rtps::octet>(config.role)};
  for (unsigned i = 0; i < 8; ++i) {
    data.push_back(static_cast<rtps::octet>((config.instance.value >> (8U * i)) & 0xFFU));
  }
  data.insert(data.end(), config.certificate.begin(), config.certificate.end());
  return data;
}

rtps::Locator_t locator(const Endpoint& e, int offset) {
  rtps::Locator_t to;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, e.address,
                                 static_cast<std::uint32_t>(e.port + offset), to);
  return to;
}

Result<void> wrap(const CarrierConfig& config,
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

}  // namespace

rtps::GuidPrefix_t guid_prefix(VehicleId self, InstanceId instance, std::uint8_t run) {
  rtps::GuidPrefix_t prefix;
  std::copy(kGuidMark.begin(), kGuidMark.end(), std::begin(prefix.value));
  prefix.value[4] = static_cast<rtps::octet>(self.value >> 8U);
  prefix.value[5] = static_cast<rtps::octet>(self.value & 0xFFU);
  for (unsigned i = 0; i < kGuidInstanceBytes; ++i) {
    prefix.value[6 + i] = static_cast<rtps::octet>((instance.value >> (8U * i)) & 0xFFU);
  }
  prefix.value[6 + kGuidInstanceBytes] = run;
  return prefix;
}

std::optional<VehicleId> vehicle_of(const rtps::GuidPrefix_t& prefix) {
  if (!std::equal(kGuidMark.begin(), kGuidMark.end(), std::begin(prefix.value))) {
    return std::nullopt;
  }
  return VehicleId{static_cast<std::uint16_t>((prefix.value[4] << 8U) | prefix.value[5])};
}

InstanceId instance_of(const rtps::GuidPrefix_t& prefix) {
  InstanceId instance;
  for (unsigned i = 0; i < kGuidInstanceBytes; ++i) {
    instance.value |= std::uint64_t{prefix.value[6 + i]} << (8U * i);
  }
  return instance;
}

std::optional<Peer> read_peer(const rtps::ParticipantProxyData& proxy) {
  const auto id = vehicle_of(proxy.m_guid.guidPrefix);
  const std::vector<rtps::octet>& data = proxy.m_userData.data_vec();
  if (!id || data.size() < kUserDataBytes || data[0] < 1 || data[0] > 2) return std::nullopt;
  std::uint64_t instance = 0;
  for (unsigned i = 0; i < 8; ++i) instance |= std::uint64_t{data[1 + i]} << (8U * i);
  return Peer{*id, InstanceId{instance}, static_cast<codec::Role>(data[0])};
}

std::map<Seals::Place, VehicleId> places_of(const CarrierConfig& config) {
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

Result<dds::DomainParticipantQos> participant_qos(const CarrierConfig& config,
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
  wire.prefix = guid_prefix(config.self, config.instance, config.run);
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

}  // namespace skein::network
