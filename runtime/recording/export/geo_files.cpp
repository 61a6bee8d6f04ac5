// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flights.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::recording_export {
namespace {

using codec::Json;

const Error kNoOrigin{
    "the recording does not say where the mission's origin is; CSV needs none: --csv"};

/// Where the vehicle was at the event: at its last point until then, or at its first.
const recording::TrackPoint* point_at(const recording::Recording& flight, Instant time) {
  const auto after = std::upper_bound(
      flight.track.begin(), flight.track.end(), time,
      [](Instant t, const recording::TrackPoint& point) { return t < point.state.time; });
  if (after != flight.track.begin()) return &*std::prev(after);
  return flight.track.empty() ? nullptr : &flight.track.front();
}

double decimals(double value, int count) {
  const double scale = std::pow(10.0, count);
  return std::round(value * scale) / scale;
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

Json geojson_position(const MissionOrigin& origin, const VehicleState& s) {
  const Wgs84 p = origin.to_wgs84(s.position());
  return {decimals(p.longitude_deg, 7), decimals(p.latitude_deg, 7), decimals(p.height_m, 1)};
}

Json feature(const char* type, Json coordinates, Json properties) {
  return {{"type", "Feature"},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}},
          {"properties", std::move(properties)}};
}

std::string kml_position(const MissionOrigin& origin, const VehicleState& s) {
  const Wgs84 p = origin.to_wgs84(s.position());
  return fmt::format("{:.7f},{:.7f},{:.1f}", p.longitude_deg, p.latitude_deg, s.z_m);
}

}  // namespace

Result<std::string> geojson(const Flights& flights) {
  if (!flights.origin) return kNoOrigin;
  Json features = Json::array();
  for (const auto& [vehicle, flight] : flights.by_node) {
    if (flight.track.size() >= 2) {
      Json line = Json::array();
      for (const auto& point : flight.track) {
        line.push_back(geojson_position(*flights.origin, point.state));
      }
      features.push_back(
          feature("LineString", std::move(line),
                  {{"vehicle", vehicle.value},
                   {"from_s", decimals(to_seconds(flight.track.front().state.time), 3)},
                   {"to_s", decimals(to_seconds(flight.track.back().state.time), 3)}}));
    }
    for (const auto& event : flight.events) {
      const auto* at = point_at(flight, event.time);
      if (at == nullptr) continue;
      features.push_back(feature("Point", geojson_position(*flights.origin, at->state),
                                 {{"vehicle", vehicle.value},
                                  {"time_s", decimals(to_seconds(event.time), 3)},
                                  {"event", to_string(event.kind())},
                                  {"site", event.task.site.value},
                                  {"text", wording::news_of(event)}}));
    }
  }
  return codec::json_text({{"type", "FeatureCollection"}, {"features", std::move(features)}}) +
         "\n";
}

Result<std::string> kml(const Flights& flights) {
  if (!flights.origin) return kNoOrigin;
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>\n";
  for (const auto& [vehicle, flight] : flights.by_node) {
    text += fmt::format("<Folder><name>vehicle {}</name>\n", vehicle.value);
    if (flight.track.size() >= 2) {
      text +=
          "<Placemark><name>track</name><LineString>"
          "<altitudeMode>relativeToGround</altitudeMode><coordinates>";
      for (const auto& point : flight.track) {
        text += kml_position(*flights.origin, point.state) + " ";
      }
      text += "</coordinates></LineString></Placemark>\n";
    }
    for (const auto& event : flight.events) {
      const auto* at = point_at(flight, event.time);
      if (at == nullptr) continue;
      text += fmt::format(
          "<Placemark><name>{}</name><description>{:.3f} s: {}</description><Point>"
          "<altitudeMode>relativeToGround</altitudeMode><coordinates>{}</coordinates></Point>"
          "</Placemark>\n",
          to_string(event.kind()), to_seconds(event.time), xml_escaped(wording::news_of(event)),
          kml_position(*flights.origin, at->state));
    }
    text += "</Folder>\n";
  }
  return text + "</Document></kml>\n";
}

}  // namespace skein::recording_export
