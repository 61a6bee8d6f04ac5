// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/cot_event.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <tuple>

#include "skein/configuration/utc.hpp"

namespace skein::agencies {
namespace {

constexpr const char* kUnknown = "9999999.0";  // an accuracy that is not told
constexpr double kUnknown_m = 9'999'999.0;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

/// With three digits of milliseconds, always: some programs take ".9" for nine of them.
std::string time_text(std::int64_t unix_ns) {
  const std::int64_t ms = unix_ns / kMillisecond_ns;
  std::string text = configuration::utc_text(ms / 1000 * 1000 * kMillisecond_ns);
  text.pop_back();
  return text + fmt::format(".{:03}Z", ms % 1000);
}

// 1e-7 degrees are a centimetre.
std::string degrees_text(double degrees) { return fmt::format("{:.7f}", degrees); }
std::string metres_text(double metres) { return fmt::format("{:.2f}", metres); }

/// As TAK's colours are: a signed number.
std::string colour_text(std::uint32_t argb) {
  return std::to_string(std::bit_cast<std::int32_t>(argb));
}

void add_ellipse(pugi::xml_node detail, double radius_m) {
  auto ellipse = detail.append_child("shape").append_child("ellipse");
  set(ellipse, "major", metres_text(radius_m));
  set(ellipse, "minor", metres_text(radius_m));
  set(ellipse, "angle", "360");
}

void add_line(pugi::xml_node detail, const std::vector<Wgs84>& line) {
  for (const Wgs84& point : line) {
    set(detail.append_child("link"), "point",
        fmt::format("{},{},{}", degrees_text(point.latitude_deg), degrees_text(point.longitude_deg),
                    metres_text(point.height_m)));
  }
}

void add_colours(pugi::xml_node detail, const CotEvent& event) {
  constexpr std::uint32_t kRgb = 0x00FFFFFF;
  constexpr std::uint32_t kFaint = 0x40000000;
  const std::string colour = colour_text(*event.colour_argb);
  if (!event.radius_m && event.line.empty()) {
    set(detail.append_child("color"), "argb", colour);
    return;
  }
  set(detail.append_child("strokeColor"), "value", colour);
  set(detail.append_child("strokeWeight"), "value", "3.0");
  if (!event.radius_m) return;
  set(detail.append_child("fillColor"), "value", colour_text((*event.colour_argb & kRgb) | kFaint));
}

/// What TAK's protocol has no fields for.
void add_other_details(pugi::xml_node detail, const CotEvent& event) {
  if (event.radius_m) add_ellipse(detail, *event.radius_m);
  add_line(detail, event.line);
  if (event.colour_argb) add_colours(detail, event);
  detail.append_child("remarks").text().set(event.remarks.c_str());
}

void add_typed_details(pugi::xml_node detail, const CotEvent& event) {
  set(detail.append_child("contact"), "callsign", event.callsign);
  if (event.track) {
    auto track = detail.append_child("track");
    set(track, "course", fmt::format("{:.2f}", event.track->course_deg));
    set(track, "speed", fmt::format("{:.2f}", event.track->speed_mps));
  }
  if (event.battery_percent) {
    set(detail.append_child("status"), "battery", std::to_string(*event.battery_percent));
  }
}

std::string text_of(const pugi::xml_node& node) {
  std::ostringstream out;
  node.print(out, "", pugi::format_raw);
  return out.str();
}

/// Protocol buffers, as far as they are in use here: numbers, doubles and bytes
/// (https://protobuf.dev/programming-guides/encoding).
class ProtobufWriter {
 public:
  void number(std::uint32_t field, std::uint64_t value) {
    tag(field, 0);
    varint(value);
  }
  void real(std::uint32_t field, double value) {
    tag(field, 1);
    auto bits = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i, bits >>= 8U) bytes_ += static_cast<char>(bits & 0xFFU);
  }
  void bytes(std::uint32_t field, std::string_view value) {
    tag(field, 2);
    varint(value.size());
    bytes_ += value;
  }
  [[nodiscard]] const std::string& written() const { return bytes_; }

 private:
  void tag(std::uint32_t field, std::uint32_t type) { varint((field << 3U) | type); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes_ += static_cast<char>((value & 0x7FU) | 0x80U);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

/// atakmap.commoncommo.protobuf.v1.Detail
std::string detail_message(const CotEvent& event) {
  pugi::xml_document others;
  auto detail = others.append_child("detail");
  add_other_details(detail, event);
  std::string xml;
  for (const auto& child : detail.children()) xml += text_of(child);
  ProtobufWriter message;
  message.bytes(1, xml);
  ProtobufWriter contact;
  contact.bytes(2, event.callsign);
  message.bytes(2, contact.written());
  if (event.battery_percent) {
    ProtobufWriter status;
    status.number(1, *event.battery_percent);
    message.bytes(5, status.written());
  }
  if (event.track) {
    ProtobufWriter track;
    track.real(1, event.track->speed_mps);
    track.real(2, event.track->course_deg);
    message.bytes(7, track.written());
  }
  return message.written();
}

auto fields_of(const Wgs84& place) {
  return std::tuple{place.latitude_deg, place.longitude_deg, place.height_m};
}

bool same_line(const std::vector<Wgs84>& a, const std::vector<Wgs84>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const Wgs84& one, const Wgs84& other) { return fields_of(one) == fields_of(other); });
}

auto track_of(const CotEvent& event) {
  const auto track = event.track.value_or(CotEvent::Track{});
  return std::tuple{event.track.has_value(), track.course_deg, track.speed_mps};
}

}  // namespace

bool operator==(const CotEvent& a, const CotEvent& b) {
  const auto words = [](const CotEvent& e) {
    return std::tie(e.uid, e.type, e.how, e.time_unix_ns, e.stale_unix_ns, e.callsign, e.remarks);
  };
  const auto figures = [](const CotEvent& e) {
    return std::tie(e.battery_percent, e.radius_m, e.colour_argb);
  };
  return words(a) == words(b) && figures(a) == figures(b) && track_of(a) == track_of(b) &&
         fields_of(a.place) == fields_of(b.place) && same_line(a.line, b.line);
}

std::string to_xml(const CotEvent& event) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  auto root = document.append_child("event");
  set(root, "version", "2.0");
  set(root, "uid", event.uid);
  set(root, "type", event.type);
  set(root, "how", event.how);
  set(root, "time", time_text(event.time_unix_ns));
  set(root, "start", time_text(event.time_unix_ns));
  set(root, "stale", time_text(event.stale_unix_ns));
  auto point = root.append_child("point");
  set(point, "lat", degrees_text(event.place.latitude_deg));
  set(point, "lon", degrees_text(event.place.longitude_deg));
  set(point, "hae", metres_text(event.place.height_m));
  set(point, "ce", kUnknown);
  set(point, "le", kUnknown);
  auto detail = root.append_child("detail");
  add_typed_details(detail, event);
  add_other_details(detail, event);
  return text_of(document);
}

std::string to_protobuf(const CotEvent& event) {
  const auto milliseconds = [](std::int64_t unix_ns) {
    return static_cast<std::uint64_t>(unix_ns / kMillisecond_ns);
  };
  ProtobufWriter cot;
  cot.bytes(1, event.type);
  cot.bytes(5, event.uid);
  cot.number(6, milliseconds(event.time_unix_ns));
  cot.number(7, milliseconds(event.time_unix_ns));
  cot.number(8, milliseconds(event.stale_unix_ns));
  cot.bytes(9, event.how);
  cot.real(10, event.place.latitude_deg);
  cot.real(11, event.place.longitude_deg);
  cot.real(12, event.place.height_m);
  cot.real(13, kUnknown_m);
  cot.real(14, kUnknown_m);
  cot.bytes(15, detail_message(event));
  ProtobufWriter message;
  message.bytes(2, cot.written());
  return "\xBF\x01\xBF" + message.written();
}

}  // namespace skein::agencies
