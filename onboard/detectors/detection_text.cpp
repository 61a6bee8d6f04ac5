// SPDX-License-Identifier: Apache-2.0
#include "skein/detectors/detection_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "skein/codec/json_text.hpp"

namespace skein::detectors {
namespace {

using codec::ParsedJson;
constexpr std::size_t kNameMax = 100;

std::optional<double> number_in(const ParsedJson& json, const char* name, double low, double high) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return value >= low && value <= high ? std::optional{value} : std::nullopt;
}

std::optional<mission::IncidentKind> kind_in(const ParsedJson& json) {
  const auto found = json.find("kind");
  if (found == json.end() || !found->is_string()) return std::nullopt;
  const auto wanted = found->get<std::string>();
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::IncidentKind::count); ++i) {
    const auto kind = static_cast<mission::IncidentKind>(i);
    if (to_string(kind) == wanted) return kind;
  }
  return std::nullopt;
}

std::string kinds() {
  std::string names;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::IncidentKind::count); ++i) {
    names.append(i == 0 ? "" : ", ").append(to_string(static_cast<mission::IncidentKind>(i)));
  }
  return names;
}

bool has_place_in_metres(const ParsedJson& json) { return json.contains("east_m"); }

Result<Vec2> place_in(const ParsedJson& json, const MissionOrigin& origin) {
  if (has_place_in_metres(json)) {
    const auto east = number_in(json, "east_m", -kPlaceMax_m, kPlaceMax_m);
    const auto north = number_in(json, "north_m", -kPlaceMax_m, kPlaceMax_m);
    if (east && north) return Vec2{*east, *north};
    return Error{"east_m and north_m are to be numbers from -100000 to 100000"};
  }
  const auto latitude = number_in(json, "latitude_deg", -90.0, 90.0);
  const auto longitude = number_in(json, "longitude_deg", -180.0, 180.0);
  if (!latitude || !longitude) {
    return Error{"a place is latitude_deg and longitude_deg, or east_m and north_m"};
  }
  const Vec2 place = origin.to_enu({*latitude, *longitude, origin.origin().height_m}).horizontal();
  const bool near = std::abs(place.x()) <= kPlaceMax_m && std::abs(place.y()) <= kPlaceMax_m;
  if (!near) return Error{"the place is farther than 100 km from the mission's origin"};
  return place;
}

}  // namespace

Result<mission::Detection> read_detection(std::string_view text, const MissionOrigin& origin) {
  if (text.size() > kTextMax) return Error{"a detection has 1024 bytes at most"};
  const ParsedJson json = codec::parse_json(text);
  if (!json.is_object()) return Error{"a detection is a JSON object"};
  const auto kind = kind_in(json);
  if (!kind) return Error{"kind is to be one of " + kinds()};
  const auto place = place_in(json, origin);
  if (!place) return place.error();
  mission::Detection detection;
  detection.kind = *kind;
  detection.position = *place;
  detection.confidence = 1.0;
  if (json.contains("confidence")) {
    const auto confidence = number_in(json, "confidence", 0.0, 1.0);
    if (!confidence) return Error{"confidence is to be a number from 0 to 1"};
    detection.confidence = *confidence;
  }
  if (const auto name = json.find("detector"); name != json.end()) {
    if (!name->is_string()) return Error{"detector is to be a text"};
    detection.detector = name->get<std::string>();
    const bool plain = detection.detector.size() <= kNameMax &&
                       std::ranges::all_of(detection.detector, [](char c) {
                         return c >= ' ' && c <= '~';  // what every codec and terminal takes
                       });
    if (!plain) return Error{"detector is to be a name of 100 ASCII characters at most"};
  }
  return detection;
}

}  // namespace skein::detectors
