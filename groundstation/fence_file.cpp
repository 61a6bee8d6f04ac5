// SPDX-License-Identifier: Apache-2.0
#include "fence_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <utility>

#include "skein/codec/json.hpp"
#include "skein/groundstation/orders.hpp"

namespace skein::groundstation {
namespace {

using codec::ParsedJson;

constexpr std::size_t kFileMax = 1'000'000;
constexpr std::size_t kPolygonsMax = 100;

const ParsedJson* member(const ParsedJson& of, const char* name) {
  const auto found = of.is_object() ? of.find(name) : of.end();
  return of.is_object() && found != of.end() ? &*found : nullptr;
}

bool has_word(const ParsedJson* of, std::string_view word) {
  return of != nullptr && of->is_string() && of->get<std::string>() == word;
}

/// Those of a geometry, a feature or a collection of features.
void collect(const ParsedJson& of, std::vector<const ParsedJson*>& polygons) {
  const ParsedJson* type = member(of, "type");
  if (polygons.size() > kPolygonsMax) return;
  if (has_word(type, "Polygon")) {
    if (const auto* rings = member(of, "coordinates")) polygons.push_back(rings);
  } else if (has_word(type, "Feature")) {
    const auto* geometry = member(of, "geometry");
    if (geometry != nullptr && !has_word(member(*geometry, "type"), "Feature")) {
      collect(*geometry, polygons);
    }
  } else if (has_word(type, "FeatureCollection")) {
    const auto* features = member(of, "features");
    if (features == nullptr || !features->is_array()) return;
    for (const auto& feature : *features) {
      if (has_word(member(feature, "type"), "Feature")) collect(feature, polygons);
    }
  }
}

Result<Vec2> place_of(const ParsedJson& pair, bool latitude_first, const MissionOrigin& origin) {
  const bool is_pair =
      pair.is_array() && pair.size() >= 2 && pair[0].is_number() && pair[1].is_number();
  if (!is_pair) return Error{"a corner is to be two numbers"};
  Wgs84 place;
  place.latitude_deg = pair[latitude_first ? 0 : 1].get<double>();
  place.longitude_deg = pair[latitude_first ? 1 : 0].get<double>();
  if (!kLatitude_deg.has(place.latitude_deg) || !kLongitude_deg.has(place.longitude_deg)) {
    return Error{fmt::format("{} N {} E is no place", place.latitude_deg, place.longitude_deg)};
  }
  place.height_m = origin.origin().height_m;
  const Vec3 at = origin.to_enu(place).metres();
  const Vec2 corner{at.x(), at.y()};
  if (!kCoordinate_m.has(corner.x()) || !kCoordinate_m.has(corner.y())) {
    return Error{"a corner is more than 100 km from the origin of the mission"};
  }
  return corner;
}

Result<std::vector<Vec2>> corners_of(const ParsedJson& ring, bool latitude_first,
                                     const MissionOrigin& origin) {
  if (!ring.is_array()) return Error{"its corners are to be a list"};
  // A ring of GeoJSON ends where it begins.
  const bool closed = ring.size() > 1 && ring.front() == ring.back();
  const std::size_t count = ring.size() - (closed ? 1 : 0);
  if (count > Fence::kCornersMax) {
    return Error{
        fmt::format("it has {} corners; a fence has at most {}", count, Fence::kCornersMax)};
  }
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < count; ++i) {
    const auto corner = place_of(ring[i], latitude_first, origin);
    if (!corner) return corner.error();
    corners.push_back(*corner);
  }
  return corners;
}

Result<std::vector<Vec2>> of_plan(const ParsedJson& fence, const MissionOrigin& origin) {
  const auto* polygons = member(fence, "polygons");
  if (polygons == nullptr || !polygons->is_array() || polygons->size() != 1) {
    return Error{"the plan's geoFence is to have one polygon"};
  }
  const ParsedJson& one = polygons->front();
  const auto* inclusion = member(one, "inclusion");
  if (inclusion != nullptr && inclusion->is_boolean() && !inclusion->get<bool>()) {
    return Error{"the plan's polygon is to be kept out of; a fence is to be stayed in"};
  }
  const auto* corners = member(one, "polygon");
  if (corners == nullptr) return Error{"the plan's polygon has no corners"};
  return corners_of(*corners, true, origin);
}

}  // namespace

Result<std::vector<Vec2>> fence_in(std::string_view text, const MissionOrigin& origin) {
  const ParsedJson json = codec::parse_json(text);
  if (const auto* plan = member(json, "geoFence")) return of_plan(*plan, origin);
  std::vector<const ParsedJson*> polygons;
  collect(json, polygons);
  if (polygons.size() != 1) {
    return Error{
        fmt::format("there are {} polygons of GeoJSON in it; a fence is one", polygons.size())};
  }
  const ParsedJson& rings = *polygons.front();
  if (!rings.is_array() || rings.size() != 1) return Error{"its polygon has holes, or no edge"};
  return corners_of(rings.front(), false, origin);
}

Result<std::vector<Vec2>> load_fence(const std::string& file, const MissionOrigin& origin) {
  std::ifstream in{file, std::ios::binary};
  if (!in) return Error{file + ": cannot be read"};
  std::string text(kFileMax + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kFileMax) return Error{file + ": is larger than 1 MB"};
  auto corners = fence_in(text, origin);
  if (!corners) return Error{file + ": " + corners.error().message};
  return corners;
}

}  // namespace skein::groundstation
