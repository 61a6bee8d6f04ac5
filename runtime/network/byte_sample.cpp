// SPDX-License-Identifier: Apache-2.0
#include "byte_sample.hpp"

#include <algorithm>

namespace skein::network {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

ByteSampleType::ByteSampleType(const std::string& type_name, std::size_t size_max) {
  setName(type_name.c_str());
  m_typeSize = static_cast<std::uint32_t>(size_max);
  auto_fill_type_object(false);  // spares a type description in every announcement
  auto_fill_type_information(false);
}

bool ByteSampleType::serialize(void* data, SerializedPayload_t* payload) {
  const auto& bytes = static_cast<const ByteSample*>(data)->bytes;
  if (bytes.size() > payload->max_size) return false;
  std::copy(bytes.begin(), bytes.end(), payload->data);
  payload->length = static_cast<std::uint32_t>(bytes.size());
  payload->encapsulation = CDR_LE;
  return true;
}

bool ByteSampleType::deserialize(SerializedPayload_t* payload, void* data) {
  static_cast<ByteSample*>(data)->bytes.assign(payload->data, payload->data + payload->length);
  return true;
}

std::function<std::uint32_t()> ByteSampleType::getSerializedSizeProvider(void* data) {
  return [data] {
    return static_cast<std::uint32_t>(static_cast<const ByteSample*>(data)->bytes.size());
  };
}

void* ByteSampleType::createData() { return new ByteSample; }
void ByteSampleType::deleteData(void* data) { delete static_cast<ByteSample*>(data); }
bool ByteSampleType::getKey(void*, InstanceHandle_t*, bool) { return false; }

}  // namespace skein::network
