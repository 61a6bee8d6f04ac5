// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "carrier.hpp"
#include "reception_book.hpp"
#include "sealed_transport.hpp"

namespace skein::network {

/// Fast DDS in this process: one participant, all topics of the role.
class DdsCarrier final : public Carrier, private eprosima::fastdds::dds::DomainParticipantListener {
 public:
  DdsCarrier(CarrierConfig config, CarrierSink& sink);
  DdsCarrier(const DdsCarrier&) = delete;
  DdsCarrier& operator=(const DdsCarrier&) = delete;
  ~DdsCarrier() override;

  /// Everything that needs files: the checks, the transport plugin. To be called once, before
  /// join().
  [[nodiscard]] Result<void> prepare();
  /// Needs sockets and threads. No datagram is read before.
  [[nodiscard]] Result<void> join();

  [[nodiscard]] Written write(codec::Topic topic, std::vector<std::uint8_t> bytes) override;
  [[nodiscard]] std::vector<Peer> peers() const override;
  [[nodiscard]] std::vector<Reception> receptions() const override;
  void change_key(const seal::EpochKey& key, Duration old_for) override;
  void tell(const std::vector<KeyNews>& news) override;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take_key_news() override;
  [[nodiscard]] CarrierCounts counts() const override;

  /// Whether each thread of Fast DDS that can be seen has got on within that time. May wait for
  /// its locks.
  [[nodiscard]] bool gets_on(Duration within) const;
  /// Tells the peers that the carrier of this node before this one is gone, or they would keep what
  /// they have for it for minutes. A datagram each; may be lost. Of a first carrier: nothing.
  void bury_predecessor() const;
  /// More counters to seal with, up to that one.
  void extend_counters(std::uint64_t end);
  [[nodiscard]] std::uint64_t next_counter() const;

 private:
  /// One per topic, so that a sample is known by its listener.
  struct TopicListener : eprosima::fastdds::dds::DataReaderListener,
                         eprosima::fastdds::dds::DataWriterListener {
    DdsCarrier* carrier = nullptr;
    codec::Topic topic = codec::Topic::count;
    std::atomic<std::int32_t> readers{0};  ///< of other nodes
    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
    void on_subscription_matched(
        eprosima::fastdds::dds::DataReader* reader,
        const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;
    void on_publication_matched(
        eprosima::fastdds::dds::DataWriter* writer,
        const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;
  };
  struct PeerState {
    std::optional<Peer> peer;  ///< none until its announcement was read
    std::int64_t matched = 0;
  };

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void receive(codec::Topic topic, eprosima::fastdds::dds::DataReader& reader);
  void matched(const eprosima::fastrtps::rtps::InstanceHandle_t& handle, std::int32_t change);
  [[nodiscard]] Result<void> make_topic(codec::Topic topic,
                                        eprosima::fastdds::dds::Publisher& publisher,
                                        eprosima::fastdds::dds::Subscriber& subscriber);

  const CarrierConfig config_;
  CarrierSink& sink_;
  const eprosima::fastrtps::rtps::GuidPrefix_t prefix_;
  std::shared_ptr<Seals> seals_;                                     ///< none: in clear
  std::optional<eprosima::fastdds::dds::DomainParticipantQos> qos_;  ///< from prepare() to join()
  std::atomic<std::uint64_t> unknown_senders_{0};
  ReceptionBook receptions_;
  mutable std::mutex peers_mutex_;
  std::map<eprosima::fastrtps::rtps::GuidPrefix_t, PeerState> peers_;
  std::array<TopicListener, codec::kTopicCount> listeners_;
  std::array<eprosima::fastdds::dds::DataWriter*, codec::kTopicCount> writers_{};
  std::array<eprosima::fastdds::dds::DataReader*, codec::kTopicCount> readers_{};
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  int burial_ = -1;  ///< socket of bury_predecessor()
};

}  // namespace skein::network
