// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/remote_id_words.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/mavlink/packet.hpp"

namespace skein::mavlink {
namespace {

constexpr std::int64_t kYear2019_unix_s = 1'546'300'800;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::uint8_t kFixed = 2;
constexpr std::uint8_t kEuropeanUnion = 1;

}  // namespace

OpenDroneIdBasicId basic_id_of(const RemoteId& id, RemoteId::UaType by_airframe) {
  OpenDroneIdBasicId message;
  message.id_type = static_cast<std::uint8_t>(id.id_type);
  message.ua_type = static_cast<std::uint8_t>(
      id.ua_type == RemoteId::UaType::by_airframe ? by_airframe : id.ua_type);
  const std::size_t size = std::min(id.uas_id.size(), message.uas_id.size());
  std::transform(id.uas_id.begin(), id.uas_id.begin() + static_cast<std::ptrdiff_t>(size),
                 message.uas_id.begin(), [](char c) { return static_cast<std::uint8_t>(c); });
  return message;
}

OpenDroneIdSelfId self_id_of(const RemoteId& id) {
  OpenDroneIdSelfId message;
  message.description = field_of<23>(id.description);
  return message;
}

OpenDroneIdOperatorId operator_id_of(const RemoteId& id) {
  OpenDroneIdOperatorId message;
  message.operator_id = field_of<20>(id.operator_id);
  return message;
}

OpenDroneIdSystem system_of(const RemoteId& id, const std::optional<Wgs84>& take_off,
                            std::int64_t unix_ns) {
  OpenDroneIdSystem message;
  const std::optional<Wgs84> place = id.operator_at ? id.operator_at : take_off;
  if (id.operator_at) message.operator_location_type = kFixed;
  if (place) {
    message.operator_latitude = static_cast<std::int32_t>(std::lround(place->latitude_deg * 1e7));
    message.operator_longitude = static_cast<std::int32_t>(std::lround(place->longitude_deg * 1e7));
    message.operator_altitude_geo = static_cast<float>(place->height_m);
  }
  message.timestamp = static_cast<std::uint32_t>(
      std::max<std::int64_t>(0, unix_ns / kSecond_ns - kYear2019_unix_s));
  message.area_count = id.group_count;
  message.area_radius = static_cast<std::uint16_t>(
      std::clamp(std::ceil(id.group_radius_m), 0.0,
                 static_cast<double>(std::numeric_limits<std::uint16_t>::max())));
  if (id.category != RemoteId::Category::undeclared || id.class_eu > 0) {
    message.classification_type = kEuropeanUnion;
    message.category_eu = static_cast<std::uint8_t>(id.category);
    message.class_eu = id.class_eu;
  }
  return message;
}

}  // namespace skein::mavlink
