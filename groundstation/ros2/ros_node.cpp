// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/ros_node.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <array>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <map>
#include <utility>

#include "skein/ros2/cdr.hpp"
#include "skein/ros2/proposals.hpp"

namespace skein::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kNodeName = "skein_bridge";
constexpr const char* kGraphTopic = "ros_discovery_info";
constexpr std::uint32_t kFirstSize = 512;              // of a sample's memory, which grows
constexpr int kProposalsKept = 100;                    // between two looks; of more the newest
constexpr std::uint32_t kParticipantsOfHost = 32;      // that are looked for without multicast
constexpr std::uint32_t kWriteWaitMax_ns = 5'000'000;  // for a lock inside DDS, never for a reader

/// Bytes that were made elsewhere, under the name of a type.
class BytesType final : public dds::TopicDataType {
 public:
  BytesType(std::string_view name, std::uint32_t size) {
    setName(std::string{name}.c_str());
    m_typeSize = size;
    auto_fill_type_object(false);  // ROS 2 has its hash instead
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::ranges::copy(bytes, payload->data);
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

dds::UserDataQosPolicy user_data(std::string_view text) {
  dds::UserDataQosPolicy data;
  data.data_vec({text.begin(), text.end()});
  return data;
}

rtps::Locator_t locator(const std::string& address) {
  rtps::Locator_t to;  // without a port: of the first kParticipantsOfHost participants there
  rtps::IPLocator::setIPv4(to, address);
  return to;
}

dds::DomainParticipantQos participant_qos(const RosNodeConfig& config) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(config.address);
  udp->maxInitialPeersRange = kParticipantsOfHost;
  udp->non_blocking_send = true;
  dds::DomainParticipantQos qos;
  qos.name(kNodeName);
  qos.user_data() = user_data("enclave=/;");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  auto& builtin = qos.wire_protocol().builtin;
  rtps::Locator_t everybody;
  rtps::IPLocator::setIPv4(everybody, 239, 255, 0, 1);
  builtin.initialPeersList.push_back(everybody);
  builtin.initialPeersList.push_back(locator(config.address));
  for (const std::string& peer : config.peers) builtin.initialPeersList.push_back(locator(peer));
  builtin.readerHistoryMemoryPolicy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  builtin.writerHistoryMemoryPolicy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}

dds::DataWriterQos writer_qos(const TypeInfo& type, Quality quality) {
  constexpr int kSensorDepth = 5;
  const bool kept = quality != Quality::sensor;
  dds::DataWriterQos qos;
  qos.reliability().kind = kept ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = {0, kWriteWaitMax_ns};
  qos.durability().kind = kept ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = quality == Quality::history ? kHistoryDepth : kept ? 1 : kSensorDepth;
  // What does not fit into a datagram is sent in parts, which only this mode does.
  qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  qos.user_data() = user_data("typehash=" + std::string{type.hash} + ";");
  return qos;
}

dds::DataReaderQos reader_qos(const TypeInfo& type) {
  dds::DataReaderQos qos;
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = kProposalsKept;
  qos.resource_limits().max_samples = kProposalsKept;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = kProposalsKept;
  qos.resource_limits().allocated_samples = kProposalsKept;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().off();
  qos.user_data() = user_data("typehash=" + std::string{type.hash} + ";");
  return qos;
}

Bytes gid_of(const rtps::GUID_t& guid) {
  Bytes gid(guid.guidPrefix.value, guid.guidPrefix.value + rtps::GuidPrefix_t::size);
  gid.insert(gid.end(), guid.entityId.value, guid.entityId.value + rtps::EntityId_t::size);
  return gid;
}

class DdsNode final : public RosNode {
 public:
  explicit DdsNode(const RosNodeConfig& config) : config_{config} {}
  ~DdsNode() override {
    if (participant_ == nullptr) return;
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  DdsNode(const DdsNode&) = delete;
  DdsNode& operator=(const DdsNode&) = delete;

  [[nodiscard]] Result<void> start() {
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        config_.domain, participant_qos(config_));
    if (participant_ == nullptr) {
      return Error{"Fast DDS cannot start in domain " + std::to_string(config_.domain) + " on " +
                   config_.address};
    }
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    const TypeInfo& proposal = skein_msgs::SiteProposal::kType;
    if (publisher_ != nullptr && subscriber_ != nullptr) {
      graph_ =
          make_writer(kGraphTopic, rmw_dds_common::ParticipantEntitiesInfo::kType, Quality::state);
      if (auto* topic = make_topic(ros_topic(kProposalTopic), proposal, kProposalBytesMax)) {
        proposals_ = subscriber_->create_datareader(topic, reader_qos(proposal));
      }
    }
    if (graph_ == nullptr || proposals_ == nullptr) {
      return Error{"Fast DDS has no room for the topics of the bridge"};
    }
    tell_of_topics();
    return {};
  }

  bool publish(const Publication& publication) override {
    auto found = writers_.find(publication.topic);
    if (found == writers_.end()) {
      if (writers_.size() >= kTopicsMax) return false;
      auto* made = make_writer(ros_topic(publication.topic), publication.type, publication.quality);
      if (made == nullptr) return false;
      found = writers_.emplace(publication.topic, made).first;
      graph_changed_ = true;
    }
    Bytes bytes = publication.bytes;
    return found->second->write(&bytes);
  }

  void tell_of_topics() override {
    if (!std::exchange(graph_changed_, false)) return;
    Bytes bytes = graph_cdr();
    graph_->write(&bytes);
  }

  std::optional<Bytes> next_proposal() override {
    Bytes bytes;
    dds::SampleInfo info;
    while (proposals_->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) return bytes;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::string ros_topic(std::string_view name) const {
    return "rt/" + config_.name_space + "/" + std::string{name};
  }

  dds::Topic* make_topic(const std::string& name, const TypeInfo& info, std::uint32_t size) {
    const dds::TypeSupport type{new BytesType{info.dds_name, size}};
    // The one that many topics share is registered once.
    const std::string type_name{info.dds_name};
    if (participant_->find_type(type_name).empty() &&
        type.register_type(participant_) != ReturnCode_t::RETCODE_OK) {
      return nullptr;
    }
    return participant_->create_topic(name, type_name, dds::TOPIC_QOS_DEFAULT);
  }

  dds::DataWriter* make_writer(const std::string& name, const TypeInfo& info, Quality quality) {
    dds::Topic* topic = make_topic(name, info, kFirstSize);
    return topic == nullptr ? nullptr
                            : publisher_->create_datawriter(topic, writer_qos(info, quality));
  }

  /// Which nodes this participant has, and their readers and writers. Not as the generated struct:
  /// the size of identifiers is another one in ROS 2 Humble.
  [[nodiscard]] Bytes graph_cdr() const {
    CdrWriter cdr;
    const auto put_gid = [&](const rtps::GUID_t& guid) {
      Bytes gid = gid_of(guid);
      gid.resize(config_.gid_bytes);
      for (const std::uint8_t byte : gid) cdr.put(byte);
    };
    put_gid(participant_->guid());
    cdr.put(std::uint32_t{1});
    cdr.put("/" + config_.name_space);
    cdr.put(std::string{kNodeName});
    cdr.put(std::uint32_t{1});
    put_gid(proposals_->guid());
    cdr.put(static_cast<std::uint32_t>(writers_.size()));
    for (const auto& [topic, writer] : writers_) put_gid(writer->guid());
    return std::move(cdr).take();
  }

  RosNodeConfig config_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataWriter* graph_ = nullptr;
  dds::DataReader* proposals_ = nullptr;
  std::map<std::string, dds::DataWriter*, std::less<>> writers_;
  bool graph_changed_ = true;
};

}  // namespace

Result<std::unique_ptr<RosNode>> RosNode::open(const RosNodeConfig& config) {
  auto node = std::make_unique<DdsNode>(config);
  if (auto started = node->start(); !started) return started.error();
  return std::unique_ptr<RosNode>{std::move(node)};
}

}  // namespace skein::ros2
