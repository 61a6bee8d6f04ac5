// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using codec::Json;

constexpr double kCountedFor_s = 10.0;
constexpr std::uint8_t kPercentMax = 100;
/// Older is no link any more, and says nothing of the way by which it came.
constexpr Duration kLinkAge = std::chrono::seconds{5};

void set_counts(LinkFigures& link, std::uint16_t datagrams, std::uint8_t lost_percent) {
  if (lost_percent > kPercentMax) return;
  link.per_s = datagrams / kCountedFor_s;
  link.lost_percent = lost_percent;
  link.through_others = datagrams == 0 && lost_percent == kPercentMax && link.age < kLinkAge;
}

LinkRow own_row(const mission::Fleet& fleet, const std::vector<GroundReception>& own, Instant now) {
  LinkRow row{.who = kGroundStation, .told_age = Duration{}, .tells_loss = !own.empty()};
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.telemetry) continue;
    LinkFigures& link = row.hears.emplace_back();
    link.whom = id;
    link.age = now - entry.heard_at;
    const auto counted = std::ranges::find(own, id, &GroundReception::vehicle);
    if (counted == own.end()) continue;
    set_counts(link, counted->datagrams, counted->lost_percent);
    link.bytes_per_s = counted->bytes_per_s;
  }
  return row;
}

LinkRow row_of(VehicleId id, const mission::FleetEntry& entry, const mission::Fleet& fleet,
               Instant now) {
  LinkRow row{.who = id};
  if (!entry.health) return row;
  const Duration told_age = now - entry.health_at;
  row.told_age = told_age;
  for (const mission::Heard& heard : entry.health->heard) {
    // Also what plays sensors on a bench is heard, and whoever is not of this team.
    if (heard.vehicle != kGroundStation && !fleet.vehicles().contains(heard.vehicle)) continue;
    LinkFigures& link = row.hears.emplace_back();
    link.whom = heard.vehicle;
    link.age = heard.age + told_age;
    set_counts(link, heard.datagrams, heard.lost_percent);
    row.tells_loss = row.tells_loss || link.lost_percent.has_value();
  }
  std::ranges::sort(row.hears, {}, &LinkFigures::whom);
  return row;
}

double rounded(double value) { return std::round(10.0 * value) / 10.0; }

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string name_of(VehicleId id) {
  return id == kGroundStation ? "ground" : fmt::format("{}", id.value);
}

std::string text_of(const LinkFigures& link) {
  std::string text = name_of(link.whom);
  if (link.lost_percent) text += fmt::format(" {:.1f}/s {} %", *link.per_s, *link.lost_percent);
  if (link.bytes_per_s) text += fmt::format(" {:.0f} B/s", *link.bytes_per_s);
  if (link.through_others) text += " through others";
  if (link.age >= kLinkAge) text += fmt::format(" {:.0f} s ago", to_seconds(link.age));
  return text;
}

}  // namespace

std::vector<LinkRow> team_links(const mission::Fleet& fleet,
                                const std::vector<GroundReception>& own, Instant now) {
  std::vector<LinkRow> rows{own_row(fleet, own, now)};
  for (const auto& [id, entry] : fleet.vehicles()) rows.push_back(row_of(id, entry, fleet, now));
  return rows;
}

std::string links_json(const std::vector<LinkRow>& rows) {
  Json all = Json::array();
  for (const LinkRow& row : rows) {
    Json hears = Json::array();
    for (const LinkFigures& link : row.hears) {
      hears.push_back(
          {{"id", link.whom.value},
           {"age_s", rounded(to_seconds(link.age))},
           {"per_s", link.per_s ? Json(rounded(*link.per_s)) : Json(nullptr)},
           {"lost_percent", or_null(link.lost_percent)},
           {"bytes_per_s", link.bytes_per_s ? Json(std::round(*link.bytes_per_s)) : Json(nullptr)},
           {"through_others", link.through_others}});
    }
    all.push_back(
        {{"id", row.who.value},
         {"told_age_s", row.told_age ? Json(rounded(to_seconds(*row.told_age))) : Json(nullptr)},
         {"tells_loss", row.tells_loss},
         {"hears", std::move(hears)}});
  }
  return codec::json_text(all);
}

std::string links_text(const std::vector<LinkRow>& rows) {
  std::string text =
      "who hears whom, over 10 s: datagrams a second, lost of those that were sent\n";
  for (const LinkRow& row : rows) {
    text += fmt::format("{:<8}", name_of(row.who));
    if (!row.told_age) {
      text += "has not told\n";
      continue;
    }
    const char* separator = "";
    for (const LinkFigures& link : row.hears) {
      text += separator + text_of(link);
      separator = ", ";
    }
    if (row.hears.empty()) text += "nobody";
    if (!row.hears.empty() && !row.tells_loss) text += "; loss is not told";
    if (*row.told_age >= kLinkAge) {
      text += fmt::format("; told {:.0f} s ago", to_seconds(*row.told_age));
    }
    text += "\n";
  }
  return text;
}

}  // namespace skein::console
