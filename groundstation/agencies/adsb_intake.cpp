// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/adsb_intake.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::agencies {
namespace {

using codec::ParsedJson;

constexpr double kFoot_m = 0.3048;
constexpr double kKnot_mps = 1852.0 / 3600.0;
constexpr double kFootPerMinute_mps = kFoot_m / 60.0;
constexpr double kAltitudeMin_ft = -2000.0;
constexpr double kAltitudeMax_ft = 60'000.0;
constexpr double kSpeedMax_kn = 1500.0;
constexpr double kClimbMax_ftmin = 20'000.0;
constexpr std::size_t kCallsignMax = 8;
constexpr std::size_t kAircraftMax = 1000;  ///< of one file
/// A file that is older tells of nobody's place.
constexpr double kFileAgeMax_s = 30.0;
/// Of BaseStation's lines.
constexpr std::size_t kFields = 22;
enum Field : std::size_t {
  f_kind = 0,
  f_address = 4,
  f_callsign = 10,
  f_altitude = 11,
  f_speed = 12,
  f_track = 13,
  f_latitude = 14,
  f_longitude = 15,
  f_climb = 16,
  f_on_ground = 21
};

/// A whole field as a number in those limits.
std::optional<double> number_in(std::string_view text, double low, double high) {
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  return whole && value >= low && value <= high ? std::optional{value} : std::nullopt;
}
std::optional<double> number_in(const ParsedJson& json, const char* name, double low, double high) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const auto value = found->get<double>();
  return value >= low && value <= high ? std::optional{value} : std::nullopt;
}
/// The first of both that is told: forks of dump1090 name them differently.
std::optional<double> either(const ParsedJson& json, const char* name, const char* other,
                             double low, double high) {
  const auto first = number_in(json, name, low, high);
  return first ? first : number_in(json, other, low, high);
}

/// Of ICAO, 24 bits; none where it is made up by a receiver ("~2a4c1b").
std::optional<std::uint32_t> address_of(std::string_view text) {
  std::uint32_t address = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), address, 16);
  const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  return whole && text.size() == 6 && address != 0 ? std::optional{address} : std::nullopt;
}

/// What every codec and terminal takes.
std::string callsign_of(std::string_view text) {
  std::string name;
  for (const char c : text.substr(0, kCallsignMax)) {
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z');
    if (plain) name += c;
  }
  return name;
}

void set_velocity(mission::Aircraft& aircraft, double speed_kn, double track_deg) {
  const Vec2 velocity = speed_kn * kKnot_mps * unit_vector(heading_from_compass_deg(track_deg));
  aircraft.east_mps = velocity.x();
  aircraft.north_mps = velocity.y();
}

std::array<std::string_view, kFields> split(std::string_view line) {
  std::array<std::string_view, kFields> fields;
  for (std::size_t i = 0; i < kFields; ++i) {
    const std::size_t comma = line.find(',');
    fields.at(i) = line.substr(0, comma);
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  return fields;
}

}  // namespace

AdsbIntake::AdsbIntake(const MissionOrigin& origin, const PressureHeight& pressure)
    : origin_{origin},
      // Of ICAO's standard atmosphere.
      sea_level_m_{-44'330.77 * (1.0 - std::pow(pressure.qnh_hpa / 1013.25, 0.190263))},
      geoid_height_m_{pressure.geoid_height_m} {}

double AdsbIntake::from_pressure_m(double altitude_ft) const {
  return above_origin_m(altitude_ft * kFoot_m + sea_level_m_ + geoid_height_m_);
}

/// Without the earth's curve: far away it flies as high above the ground there.
double AdsbIntake::above_origin_m(double above_ellipsoid_m) const {
  return above_ellipsoid_m - origin_.origin().height_m;
}

std::optional<Vec2> AdsbIntake::place_of(double latitude_deg, double longitude_deg) const {
  const Vec2 place =
      origin_.to_enu({latitude_deg, longitude_deg, origin_.origin().height_m}).horizontal();
  const bool near =
      std::abs(place.x()) <= kAircraftPlaceMax_m && std::abs(place.y()) <= kAircraftPlaceMax_m;
  return near ? std::optional{place} : std::nullopt;
}

AdsbIntake::Known* AdsbIntake::known_of(std::uint32_t address, Instant now) {
  const auto found = known_.find(address);
  if (found == known_.end() && known_.size() >= kKnownMax) {
    std::erase_if(known_,
                  [now](const auto& entry) { return now - entry.second.heard_at > kForgotten; });
    if (known_.size() >= kKnownMax) return nullptr;
  }
  Known& known = known_[address];
  if (now - known.heard_at > kForgotten) known = {};
  known.seen.aircraft.address = address;
  known.heard_at = now;
  return &known;
}

std::optional<mission::SeenAircraft> AdsbIntake::take_sbs(std::string_view line, Instant now) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  const auto fields = split(line);
  if (fields[f_kind] != "MSG") {
    static constexpr std::array<std::string_view, 5> kOthers{"SEL", "ID", "AIR", "STA", "CLK"};
    const bool known_kind = std::ranges::find(kOthers, fields[f_kind]) != kOthers.end();
    if (!known_kind && !line.empty()) ++unreadable_;
    return std::nullopt;
  }
  const auto address = address_of(fields[f_address]);
  if (line.size() > kSbsLineMax || !address) {
    ++unreadable_;
    return std::nullopt;
  }
  Known* const known = known_of(*address, now);
  if (known == nullptr) return std::nullopt;
  mission::SeenAircraft& seen = known->seen;
  if (auto callsign = callsign_of(fields[f_callsign]); !callsign.empty()) {
    seen.callsign = std::move(callsign);
  }
  if (!fields[f_on_ground].empty()) {
    seen.on_ground = fields[f_on_ground] == "-1" || fields[f_on_ground] == "1";
  }
  const auto speed = number_in(fields[f_speed], 0.0, kSpeedMax_kn);
  const auto track = number_in(fields[f_track], 0.0, 360.0);
  if (speed && track) set_velocity(seen.aircraft, *speed, *track);
  if (const auto climb = number_in(fields[f_climb], -kClimbMax_ftmin, kClimbMax_ftmin)) {
    seen.aircraft.climb_mps = *climb * kFootPerMinute_mps;
  }
  const auto latitude = number_in(fields[f_latitude], -90.0, 90.0);
  const auto longitude = number_in(fields[f_longitude], -180.0, 180.0);
  if (latitude && longitude) {
    const auto place = place_of(*latitude, *longitude);
    if (!place) {
      ++far_away_;
      known->has_place = false;
      return std::nullopt;
    }
    seen.aircraft.position = *place;
    seen.aircraft.time = now;
    known->has_place = true;
  }
  if (const auto feet = number_in(fields[f_altitude], kAltitudeMin_ft, kAltitudeMax_ft)) {
    // As it was at the time of its place, from where it is carried on.
    const double since_place_s = known->has_place ? to_seconds(now - seen.aircraft.time) : 0.0;
    seen.aircraft.height_m = from_pressure_m(*feet) - seen.aircraft.climb_mps * since_place_s;
    seen.barometric = known->has_height = true;
  }
  const bool is_placed = known->has_place && now - seen.aircraft.time <= kPlaceAgeMax;
  const bool is_whole = is_placed && (known->has_height || seen.on_ground);
  return is_whole ? std::optional{seen} : std::nullopt;
}

std::vector<mission::SeenAircraft> AdsbIntake::take_json(std::string_view text, double unix_s,
                                                         Instant now) {
  std::vector<mission::SeenAircraft> all;
  if (text.size() > kAircraftJsonMax) {
    ++unreadable_;
    return all;
  }
  const ParsedJson file = codec::parse_json(text);
  const auto list = file.is_object() ? file.find("aircraft") : file.end();
  if (!file.is_object() || list == file.end() || !list->is_array()) {
    ++unreadable_;
    return all;
  }
  const auto written_s = number_in(file, "now", 0.0, 1e11);
  const double file_age_s = written_s ? std::max(0.0, unix_s - *written_s) : 0.0;
  is_old_ = file_age_s > kFileAgeMax_s;
  if (is_old_) return all;
  for (const ParsedJson& one : *list) {
    if (all.size() >= kAircraftMax) break;
    const auto hex = one.is_object() ? one.find("hex") : one.end();
    if (!one.is_object() || hex == one.end() || !hex->is_string()) {
      ++unreadable_;
      continue;
    }
    const auto address = address_of(hex->get_ref<const std::string&>());
    const auto latitude = number_in(one, "lat", -90.0, 90.0);
    const auto longitude = number_in(one, "lon", -180.0, 180.0);
    if (!address || !latitude || !longitude) continue;
    const auto place = place_of(*latitude, *longitude);
    if (!place) {
      ++far_away_;
      continue;
    }
    mission::SeenAircraft seen;
    seen.aircraft.address = *address;
    seen.aircraft.position = *place;
    // How old its place is; one that is too old is no place of now.
    const bool tells_age = one.find("seen_pos") != one.end();
    const auto place_age_s = number_in(one, "seen_pos", 0.0, to_seconds(kPlaceAgeMax));
    if (tells_age && !place_age_s) continue;
    const double age_s = file_age_s + place_age_s.value_or(0.0);
    seen.aircraft.time = now - from_seconds(age_s);
    const auto baro_word = one.find("alt_baro");
    seen.on_ground = baro_word != one.end() && baro_word->is_string();  // "ground"
    const auto geometric_ft = number_in(one, "alt_geom", kAltitudeMin_ft, kAltitudeMax_ft);
    const auto pressure_ft = either(one, "alt_baro", "altitude", kAltitudeMin_ft, kAltitudeMax_ft);
    if (!geometric_ft && !pressure_ft && !seen.on_ground) continue;
    seen.barometric = !geometric_ft && pressure_ft;
    if (geometric_ft) seen.aircraft.height_m = above_origin_m(*geometric_ft * kFoot_m);
    if (seen.barometric) seen.aircraft.height_m = from_pressure_m(*pressure_ft);
    const auto speed = either(one, "gs", "speed", 0.0, kSpeedMax_kn);
    const auto track = number_in(one, "track", 0.0, 360.0);
    if (speed && track) set_velocity(seen.aircraft, *speed, *track);
    auto climb = number_in(one, "geom_rate", -kClimbMax_ftmin, kClimbMax_ftmin);
    if (!climb) climb = either(one, "baro_rate", "vert_rate", -kClimbMax_ftmin, kClimbMax_ftmin);
    seen.aircraft.climb_mps = climb.value_or(0.0) * kFootPerMinute_mps;
    const auto flight = one.find("flight");
    if (flight != one.end() && flight->is_string()) {
      seen.callsign = callsign_of(flight->get_ref<const std::string&>());
    }
    all.push_back(std::move(seen));
  }
  return all;
}

}  // namespace skein::agencies
