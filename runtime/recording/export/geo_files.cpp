// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "flights.hpp"
#include "skein/wording/wording.hpp"

namespace skein::recording_export {
namespace {

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

std::string json_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

std::string geojson_position(const MissionOrigin& origin, const VehicleState& s) {
  const Wgs84 p = origin.to_wgs84(s.position());
  return fmt::format("[{:.7f},{:.7f},{:.1f}]", p.longitude_deg, p.latitude_deg, p.height_m);
}

std::string kml_position(const MissionOrigin& origin, const VehicleState& s) {
  const Wgs84 p = origin.to_wgs84(s.position());
  return fmt::format("{:.7f},{:.7f},{:.1f}", p.longitude_deg, p.latitude_deg, s.z_m);
}

}  // namespace

Result<std::string> geojson(const Flights& flights) {
  if (!flights.origin) return kNoOrigin;
  std::string text = "{\"type\":\"FeatureCollection\",\"features\":[";
  bool first = true;
  const auto feature = [&](const std::string& geometry, const std::string& properties) {
    text += fmt::format("{}\n{{\"type\":\"Feature\",\"geometry\":{},\"properties\":{{{}}}}}",
                        first ? "" : ",", geometry, properties);
    first = false;
  };
  for (const auto& [vehicle, flight] : flights.by_node) {
    if (flight.track.size() >= 2) {
      std::string line;
      for (const auto& point : flight.track) {
        line += (line.empty() ? "" : ",") + geojson_position(*flights.origin, point.state);
      }
      feature(fmt::format("{{\"type\":\"LineString\",\"coordinates\":[{}]}}", line),
              fmt::format("\"vehicle\":{},\"from_s\":{:.3f},\"to_s\":{:.3f}", vehicle.value,
                          to_seconds(flight.track.front().state.time),
                          to_seconds(flight.track.back().state.time)));
    }
    for (const auto& event : flight.events) {
      const auto* at = point_at(flight, event.time);
      if (at == nullptr) continue;
      feature(fmt::format("{{\"type\":\"Point\",\"coordinates\":{}}}",
                          geojson_position(*flights.origin, at->state)),
              fmt::format("\"vehicle\":{},\"time_s\":{:.3f},\"event\":\"{}\",\"site\":{},"
                          "\"text\":\"{}\"",
                          vehicle.value, to_seconds(event.time), to_string(event.kind()),
                          event.task.site.value, json_escaped(wording::news_of(event))));
    }
  }
  return text + "\n]}\n";
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
