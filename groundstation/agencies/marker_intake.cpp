// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/marker_intake.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <utility>

#include "skein/configuration/utc.hpp"

namespace skein::agencies {
namespace {

constexpr std::size_t kUidMax = 128;
constexpr std::size_t kNameMax = 60;

/// A whole attribute as a finite number in those limits.
std::optional<double> number_in(const pugi::xml_node& node, const char* name, double low,
                                double high) {
  const std::string_view text{node.attribute(name).value()};
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  return whole && value >= low && value <= high ? std::optional{value} : std::nullopt;
}

bool is_plain(char c) { return c >= ' ' && c <= '~'; }

/// What every codec and terminal takes.
std::string plain(std::string_view text) {
  std::string name{text.substr(0, kNameMax)};
  std::ranges::replace_if(
      name, [](char c) { return !is_plain(c); }, '?');
  return name;
}

std::string lower(std::string_view text) {
  std::string made{text};
  std::ranges::transform(made, made.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return made;
}

/// The incident that is named first in it.
std::optional<mission::IncidentKind> kind_in(std::string_view text) {
  const std::string words = lower(text);
  std::optional<mission::IncidentKind> first;
  std::size_t at = std::string::npos;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::IncidentKind::count); ++i) {
    const auto kind = static_cast<mission::IncidentKind>(i);
    const std::size_t found = words.find(to_string(kind));
    if (found < at) {
      at = found;
      first = kind;
    }
  }
  return first;
}

bool tells_of_a_place(std::string_view type) {
  constexpr std::array<std::string_view, 3> kTypes{"b-m-p-", "a-u-G", "a-n-G"};
  return std::ranges::any_of(kTypes, [type](auto begin) { return type.starts_with(begin); });
}

/// Whoever takes a marker away says that it is stale from the same moment on.
Result<bool> is_ended(const pugi::xml_node& event) {
  const auto time = configuration::parse_utc(event.attribute("time").value());
  const auto stale = configuration::parse_utc(event.attribute("stale").value());
  if (!time || !stale) return Error{"its time and stale are to be UTC, 2026-11-23T08:00:00Z"};
  return *stale <= *time;
}

Result<Vec2> place_in(const pugi::xml_node& event, const MissionOrigin& origin) {
  const auto point = event.child("point");
  const auto latitude = number_in(point, "lat", -90.0, 90.0);
  const auto longitude = number_in(point, "lon", -180.0, 180.0);
  if (!latitude || !longitude) return Error{"its point has no lat and lon in degrees"};
  const Vec2 place = origin.to_enu({*latitude, *longitude, origin.origin().height_m}).horizontal();
  const bool near =
      std::abs(place.x()) <= kMarkerPlaceMax_m && std::abs(place.y()) <= kMarkerPlaceMax_m;
  if (!near) return Error{"it lies farther than 100 km from the mission's origin"};
  return place;
}

}  // namespace

Result<std::optional<Marker>> read_marker(std::string_view text, const MissionOrigin& origin) {
  if (text.size() > kMarkerTextMax) return Error{"it has more than 8192 bytes"};
  pugi::xml_document document;
  // No document types, so no entities but XML's own five.
  const auto parsed =
      document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_trim_pcdata);
  if (!parsed) return Error{std::string{"it is no XML: "} + parsed.description()};
  const auto event = document.child("event");
  const std::string uid = event.attribute("uid").value();
  if (!event || std::string_view{event.attribute("version").value()} != "2.0" || uid.empty()) {
    return Error{"it is no event of version 2.0 with a uid"};
  }
  if (uid.size() > kUidMax || !std::ranges::all_of(uid, is_plain)) {
    return Error{"its uid is to have 128 ASCII characters at most"};
  }
  if (!tells_of_a_place(event.attribute("type").value())) return std::optional<Marker>{};
  const auto ended = is_ended(event);
  if (!ended) return ended.error();
  if (*ended) return std::optional<Marker>{};
  const auto place = place_in(event, origin);
  if (!place) return place.error();
  const auto detail = event.child("detail");
  const std::string_view callsign = detail.child("contact").attribute("callsign").value();
  const std::string_view remarks = detail.child("remarks").child_value();
  Marker marker;
  marker.uid = uid;
  auto kind = kind_in(callsign);
  if (!kind) kind = kind_in(remarks);
  marker.detection.kind = kind.value_or(mission::IncidentKind::damage);
  marker.detection.position = *place;
  marker.detection.confidence = 1.0;
  marker.detection.detector = "marker '" + plain(callsign.empty() ? uid : callsign) + "'";
  return std::optional{std::move(marker)};
}

MarkerIntake::MarkerIntake(const MissionOrigin& origin, std::string own_prefix)
    : origin_{origin}, own_prefix_{std::move(own_prefix)} {}

std::optional<mission::Detection> MarkerIntake::take(std::string_view datagram, Instant now) {
  auto read = read_marker(datagram, origin_);
  if (!read) {
    ++unreadable_;
    trouble_ = read.error().message;
    return std::nullopt;
  }
  if (!*read || (*read)->uid.starts_with(own_prefix_)) return std::nullopt;
  if (!has_room(now)) {
    ++too_many_;
    return std::nullopt;
  }
  return std::move((*read)->detection);
}

/// A bucket that fills at kRate_per_s.
bool MarkerIntake::has_room(Instant now) {
  const double refill = kRate_per_s * to_seconds(now - room_at_);
  room_ = std::min(room_ + refill, static_cast<double>(kBurst));
  room_at_ = now;
  if (room_ < 1.0) return false;
  room_ -= 1.0;
  return true;
}

std::optional<std::string> MarkerIntake::poll_trouble() { return std::exchange(trouble_, {}); }

}  // namespace skein::agencies
