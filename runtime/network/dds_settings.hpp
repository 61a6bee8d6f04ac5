// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>

#include <cstddef>
#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "carrier.hpp"
#include "sealed_transport.hpp"

/// What of a carrier becomes names, numbers and settings of Fast DDS, and back.
namespace skein::network {

/// Before a certificate: role and instance.
inline constexpr std::size_t kUserDataBytes = 9;

[[nodiscard]] eprosima::fastrtps::rtps::GuidPrefix_t guid_prefix(VehicleId self,
                                                                 InstanceId instance,
                                                                 std::uint8_t run);
/// None: not a node of ours.
[[nodiscard]] std::optional<VehicleId> vehicle_of(
    const eprosima::fastrtps::rtps::GuidPrefix_t& prefix);
/// As far as the prefix has it: all of one that has keys.
[[nodiscard]] InstanceId instance_of(const eprosima::fastrtps::rtps::GuidPrefix_t& prefix);
/// As it was announced; none: not by a node of ours.
[[nodiscard]] std::optional<Peer> read_peer(
    const eprosima::fastrtps::rtps::ParticipantProxyData& proxy);

/// Both ports of each peer.
[[nodiscard]] std::map<Seals::Place, VehicleId> places_of(const CarrierConfig& config);

/// Loads the transport plugin.
[[nodiscard]] Result<eprosima::fastdds::dds::DomainParticipantQos> participant_qos(
    const CarrierConfig& config, const std::shared_ptr<Seals>& seals);
[[nodiscard]] eprosima::fastdds::dds::DataWriterQos writer_qos(const codec::TopicInfo& topic);
[[nodiscard]] eprosima::fastdds::dds::DataReaderQos reader_qos(const codec::TopicInfo& topic);

}  // namespace skein::network
