// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "process_fields.hpp"

namespace skein::configuration {
namespace {

using IdType = RemoteId::IdType;
using UaType = RemoteId::UaType;
using Category = RemoteId::Category;

/// Without the first: who has no id says none.
constexpr std::array<std::string_view, static_cast<std::size_t>(IdType::count) - 1> kIdTypes{
    "serial_number", "registration", "utm_assigned", "session"};
constexpr std::array<std::string_view, static_cast<std::size_t>(UaType::count)> kUaTypes{
    "by_airframe", "aeroplane", "helicopter_or_multirotor", "gyroplane", "hybrid_lift"};
constexpr std::array<std::string_view, static_cast<std::size_t>(Category::count)> kCategories{
    "undeclared", "open", "specific", "certified"};
constexpr std::array<std::string_view, 8> kClasses{"undeclared", "C0", "C1", "C2",
                                                   "C3",         "C4", "C5", "C6"};
constexpr std::array<std::string_view, 2> kFalseTrue{"false", "true"};
constexpr std::size_t kIdMax = 20;    ///< bytes of a UAS or operator id
constexpr std::size_t kTextMax = 23;  ///< of a description

template <class Choice, std::size_t Count>
void choose(FieldVisitor& v, const Field& field, const std::array<std::string_view, Count>& names,
            Choice& value) {
  auto index = static_cast<std::size_t>(value);
  v.choice(field, names, index);
  value = static_cast<Choice>(index);
}

bool is_ascii(const std::string& text, std::size_t bytes_max) {
  return text.size() <= bytes_max &&
         std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

void uas_id_field(FieldVisitor& v, std::string& id) {
  v.text({"uas_id", "serial number (ANSI/CTA-2063-A), or what id_type says it is"}, id);
  v.require(is_ascii(id, kIdMax), "uas_id", "may have 20 ASCII characters at most");
}

void common_fields(FieldVisitor& v, RemoteId& c) {
  std::size_t id_type = static_cast<std::size_t>(c.id_type) - 1;
  v.choice({"id_type", "what a uas_id is"}, kIdTypes, id_type);
  c.id_type = static_cast<IdType>(id_type + 1);
  choose(v, {"ua_type", "what the aircraft is"}, kUaTypes, c.ua_type);
  v.text({"operator_id", "as the authority gave it to the operator; 20 ASCII characters at most"},
         c.operator_id);
  v.require(is_ascii(c.operator_id, kIdMax), "operator_id", "may have 20 ASCII characters at most");
  v.text({"description", "free text of what the flight is for; 23 ASCII characters at most"},
         c.description);
  v.require(is_ascii(c.description, kTextMax), "description",
            "may have 23 ASCII characters at most");
  choose(v, {"category", "of the flight, in the European Union"}, kCategories, c.category);
  choose(v, {"class", "of the aircraft, in the European Union"}, kClasses, c.class_eu);
  v.section({"operator", "where the operator is; without a place, where the vehicle takes off"},
            [&c](FieldVisitor& inner) {
              std::optional<double> latitude;
              std::optional<double> longitude;
              double height_m = 0.0;
              if (c.operator_at) {
                latitude = c.operator_at->latitude_deg;
                longitude = c.operator_at->longitude_deg;
                height_m = c.operator_at->height_m;
              }
              inner.number({"latitude_deg", "north positive"}, {-90.0, 90.0, "deg"}, latitude);
              inner.number({"longitude_deg", "east positive"}, {-180.0, 180.0, "deg"}, longitude);
              inner.number({"height_m", "above the ellipsoid"}, {-500.0, 9000.0, "m"}, height_m);
              inner.require(latitude.has_value() == longitude.has_value(), "longitude_deg",
                            "a place has both latitude and longitude; give both or neither");
              c.operator_at.reset();
              if (latitude && longitude) c.operator_at = Wgs84{*latitude, *longitude, height_m};
            });
  whole(v, {"group_count", "of aircraft that fly as one, this one among them"}, {1.0, 1000.0},
        c.group_count);
  v.number({"group_radius_m", "around each of them, in which the others are; tens of metres"},
           {0.0, 2550.0, "m"}, c.group_radius_m);
  std::size_t required = c.required ? 1 : 0;
  v.choice({"required",
            "a vehicle is not ready, nor armed by its companion, without a transmitter "
            "that says it is good"},
           kFalseTrue, required);
  c.required = required == 1;
}

}  // namespace

void remote_id_section(FieldVisitor& v, RemoteId& config) {
  v.section({"remote_id", "what the vehicle says of itself by Remote ID (docs/agencies.md)"},
            [&config](FieldVisitor& inner) {
              uas_id_field(inner, config.uas_id);
              common_fields(inner, config);
              inner.require(!config.required || config.exists(), "required",
                            "needs the vehicle's uas_id; give one");
            });
}

void team_remote_id_section(FieldVisitor& v, TeamRemoteId& team) {
  v.section({"remote_id", "what vehicles say of themselves by Remote ID (docs/agencies.md)"},
            [&team](FieldVisitor& inner) {
              common_fields(inner, team.common);
              inner.list(
                  {"ids", "of each vehicle; who has none says nothing"},
                  unique_groups_of(
                      team.ids, kVehiclesMax,
                      [](FieldVisitor& of, TeamRemoteId::Id& one) {
                        id(of, {"vehicle", "number of the vehicle", kRequired}, one.vehicle);
                        uas_id_field(of, one.uas_id);
                      },
                      "vehicle", [](const TeamRemoteId::Id& one) { return one.vehicle.value; }));
            });
}

}  // namespace skein::configuration
