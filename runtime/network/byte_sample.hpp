// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>
#include <vector>

namespace skein::network {

/// A sample as DDS carries it: its bytes, with the encapsulation header.
struct ByteSample {
  std::vector<std::uint8_t> bytes;
};

/// Tells DDS to carry bytes under the name of an IDL type. The bytes are made and judged by the
/// codec, so that what is wrong with a message of another version or maker can be counted by name:
/// a generated type support would make DDS drop it in silence.
class ByteSampleType : public eprosima::fastdds::dds::TopicDataType {
 public:
  ByteSampleType(const std::string& type_name, std::size_t size_max);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle,
              bool force_md5) override;
};

}  // namespace skein::network
