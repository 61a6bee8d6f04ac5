// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_preflight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using codec::Json;
using mission::CheckGroup;
using mission::CheckVerdict;
using mission::Preflight;

constexpr std::size_t kNamedMax = 12;  ///< in the summary

void add(std::string& list, std::string_view word) {
  list.append(list.empty() ? "" : ", ").append(word);
}

CheckMark mark_of(const mission::CheckCount& count) {
  if (count.failed > 0) return CheckMark::fail;
  if (count.warned > 0) return CheckMark::warn;
  return count.passed > 0 ? CheckMark::ok : CheckMark::not_looked_at;
}

struct Heard {
  Instant at;
  InstanceId instance;
};
/// A vehicle whose flight controller has told no state yet sends no telemetry, but how it is.
std::optional<Heard> newest_of(const mission::FleetEntry& entry) {
  std::optional<Heard> newest;
  if (entry.telemetry) newest = {entry.heard_at, entry.telemetry->instance};
  if (entry.health && (!newest || entry.health_at > newest->at)) {
    newest = {entry.health_at, entry.health->instance};
  }
  return newest;
}

/// Why what it has told does not count, or the vehicle is not worked with; empty: neither. And
/// whether that will be over by itself.
struct NotHeard {
  std::string why;
  bool will_come = false;
};
NotHeard why_not_heard(const mission::FleetEntry& entry, Duration silence, Instant now) {
  if (entry.revoked) return {"revoked"};
  if (entry.duplicate) return {"two programs with this number"};
  const auto heard = newest_of(entry);
  if (!heard) return {"never heard"};
  if (now - heard->at >= silence) return {"silent"};
  if (!entry.preflight || entry.preflight->instance != heard->instance) {
    return {"has not told yet", true};
  }
  if (now - entry.preflight_at > kPreflightCounts) return {"has not told lately", true};
  return {};
}

/// Fills in whether it is ready, and why not.
void judge(PreflightRow& row, const mission::FleetEntry& entry) {
  const Preflight& told = *row.told;
  for (std::size_t group = 0; group < kCheckGroups; ++group) {
    if (row.marks.at(group) == CheckMark::fail) {
      add(row.why, name_of(static_cast<CheckGroup>(group)));
    }
  }
  if (entry.differs) add(row.why, "differs from the ground station");
  if (!row.why.empty()) {
    row.readiness = Readiness::not_ready;
  } else if (!told.complete) {
    row.readiness = Readiness::not_known;
    row.why = "has not told all yet";
  } else {
    row.readiness = Readiness::ready;
  }
  if (told.in_flight) row.readiness = Readiness::in_flight;
}

PreflightRow row_of(VehicleId vehicle, const mission::FleetEntry& entry, Duration silence,
                    Instant now) {
  PreflightRow row;
  row.vehicle = vehicle;
  if (entry.preflight) {
    row.told = &*entry.preflight;
    row.told_at = entry.preflight_at;
    if (row.told->complete) row.marks.fill(CheckMark::not_looked_at);
    for (const auto& count : row.told->counts) {
      row.marks.at(static_cast<std::size_t>(count.group)) = mark_of(count);
    }
  }
  auto [why, will_come] = why_not_heard(entry, silence, now);
  row.why = std::move(why);
  row.counts = row.why.empty();
  if (row.counts) {
    judge(row, entry);
  } else {
    row.readiness = will_come ? Readiness::not_known : Readiness::not_ready;
  }
  return row;
}

/// Marks those whose value is not the one that most have. `value_of` gives what is compared and
/// among whom; nothing where it is not known.
template <class ValueOf>
void mark_odd(std::vector<PreflightRow>& rows, bool PreflightRow::Odd::*odd,
              const ValueOf& value_of) {
  std::map<int, std::map<std::string, int>> counts;
  for (const auto& row : rows) {
    if (!row.counts) continue;
    if (const auto [among, value] = value_of(*row.told); !value.empty()) ++counts[among][value];
  }
  for (auto& row : rows) {
    if (!row.counts) continue;
    const auto own = value_of(*row.told);
    if (own.second.empty()) continue;
    const auto& values = counts[own.first];
    const int as_own = values.at(own.second);
    row.odd.*odd = std::ranges::any_of(values, [&](const auto& other) {
      return other.first != own.second && other.second >= as_own;
    });
  }
}

void mark_odd(std::vector<PreflightRow>& rows) {
  using Compared = std::pair<int, std::string>;
  mark_odd(rows, &PreflightRow::Odd::release, [](const Preflight& told) {
    return Compared{0, told.release};
  });
  mark_odd(rows, &PreflightRow::Odd::configuration, [](const Preflight& told) {
    return Compared{0, digest_text(told.configuration)};
  });
  mark_odd(rows, &PreflightRow::Odd::firmware, [](const Preflight& told) {
    return Compared{told.copter ? 1 : 0, told.firmware};
  });
  mark_odd(rows, &PreflightRow::Odd::parameters, [](const Preflight& told) {
    return Compared{told.copter ? 1 : 0, digest_text(told.parameters)};
  });
}

std::string summary_of(const std::vector<PreflightRow>& rows) {
  if (rows.empty()) return "no vehicle is expected, and none is heard";
  const auto count = [&](Readiness wanted) {
    return std::ranges::count(rows, wanted, &PreflightRow::readiness);
  };
  std::string text = fmt::format("{} of {} ready", count(Readiness::ready), rows.size());
  if (const auto flying = count(Readiness::in_flight); flying > 0) {
    text += fmt::format(", {} armed or in the air", flying);
  }
  const auto others = count(Readiness::not_ready) + count(Readiness::not_known);
  if (others == 0) return text;
  std::string named;
  std::size_t names = 0;
  for (const auto& row : rows) {
    if (row.readiness == Readiness::ready || row.readiness == Readiness::in_flight) continue;
    if (++names <= kNamedMax) add(named, fmt::format("{} ({})", row.vehicle.value, row.why));
  }
  if (names > kNamedMax) named += fmt::format(" and {} more", names - kNamedMax);
  return text + fmt::format(", {} not: {}", others, named);
}

std::string verdict_text(const PreflightRow& row) {
  switch (row.readiness) {
    case Readiness::ready:
      return std::ranges::find(row.marks, CheckMark::warn) != row.marks.end() ? "ready, warned"
                                                                              : "ready";
    case Readiness::in_flight:
      return row.why.empty() ? "armed or in the air" : "armed or in the air: " + row.why;
    case Readiness::not_known:
      return "not known: " + row.why;
    default:
      return "NOT READY: " + row.why;
  }
}

std::string figure(const std::string& text, bool odd) {
  return text.empty() ? "-" : odd ? text + "*" : text;
}

/// A row's figures, as the table has them.
std::array<std::string, 6> cells_of(const PreflightRow& row, Instant now) {
  std::array<std::string, 6> cells{std::to_string(row.vehicle.value), "-", "-", "-", "-", "-"};
  if (row.told == nullptr) return cells;
  const Preflight& told = *row.told;
  cells[1] = fmt::format("{:.0f} s", to_seconds(now - row.told_at));
  cells[2] = figure(told.release, row.odd.release);
  cells[3] = figure(told.firmware, row.odd.firmware);
  cells[4] = figure(digest_text(told.parameters), row.odd.parameters);
  cells[5] = figure(digest_text(told.configuration), row.odd.configuration);
  return cells;
}

constexpr std::array<std::string_view, 6> kHeads{"vehicle",  "told",       "release",
                                                 "firmware", "parameters", "configuration"};
constexpr std::size_t kFiguresFirst = 2;  ///< of them: to the right
constexpr std::string_view kOddNote = "* others of the team have another one\n";

/// Columns as wide as what stands in them, and what is made of the checks.
class Table {
 public:
  Table(const std::vector<PreflightRow>& rows, Instant now) : now_{now} {
    for (std::size_t i = 0; i < kHeads.size(); ++i) widths_.at(i) = kHeads.at(i).size();
    for (const auto& row : rows) {
      const auto cells = cells_of(row, now);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        widths_.at(i) = std::max(widths_.at(i), cells.at(i).size());
      }
    }
  }
  [[nodiscard]] std::string head() const { return line(kHeads) + "checks\n"; }
  [[nodiscard]] std::string of(const PreflightRow& row) const {
    return line(cells_of(row, now_)) + verdict_text(row) + "\n";
  }

 private:
  template <class Cells>
  [[nodiscard]] std::string line(const Cells& cells) const {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += i < kFiguresFirst ? fmt::format("{:>{}}  ", cells.at(i), widths_.at(i))
                                : fmt::format("{:<{}}  ", cells.at(i), widths_.at(i));
    }
    return text;
  }

  Instant now_;
  std::array<std::size_t, kHeads.size()> widths_{};
};

bool is_odd(const PreflightRow& row) {
  return row.odd.release || row.odd.firmware || row.odd.parameters || row.odd.configuration;
}

/// What was told of it and is not ok.
void add_lines(std::string& text, const PreflightRow& row, bool fails_only) {
  if (row.told == nullptr) return;
  std::string lines;
  for (const auto& line : row.told->lines) {
    if (fails_only && line.verdict != CheckVerdict::fail) continue;
    lines +=
        "         " + wording::check_line(line.verdict, line.what, line.found, line.remedy) + "\n";
  }
  if (!row.counts && !lines.empty()) text += "         as it was told last:\n";
  text += lines;
}

Json row_json(const PreflightRow& row) {
  Json json{{"id", row.vehicle.value},  {"readiness", to_string(row.readiness)},
            {"why", row.why},           {"counts", row.counts},
            {"told_s", nullptr},        {"release", nullptr},
            {"firmware", nullptr},      {"parameters", nullptr},
            {"configuration", nullptr}, {"odd", Json::array()},
            {"marks", Json::array()},   {"lines", Json::array()},
            {"lines_left_out", 0}};
  for (const CheckMark mark : row.marks) json["marks"].push_back(to_string(mark));
  if (row.told == nullptr) return json;
  const Preflight& told = *row.told;
  json["told_s"] = to_seconds(row.told_at);
  const auto set = [&json](const char* name, const std::string& text, bool odd) {
    if (!text.empty()) json[name] = text;
    if (odd) json["odd"].push_back(name);
  };
  set("release", told.release, row.odd.release);
  set("firmware", told.firmware, row.odd.firmware);
  set("parameters", digest_text(told.parameters), row.odd.parameters);
  set("configuration", digest_text(told.configuration), row.odd.configuration);
  for (const auto& line : told.lines) {
    json["lines"].push_back({{"group", name_of(line.group)},
                             {"verdict", to_string(line.verdict)},
                             {"what", line.what},
                             {"found", line.found},
                             {"remedy", line.remedy}});
  }
  json["lines_left_out"] = told.lines_left_out;
  return json;
}

}  // namespace

std::string_view name_of(CheckGroup group) {
  static constexpr std::array<std::string_view, kCheckGroups> kNames{
      "clock",    "storage",    "keys", "network", "computer", "configuration", "bus",
      "firmware", "parameters", "GNSS", "filter",  "battery",  "arming"};
  return kNames.at(static_cast<std::size_t>(group));
}

std::string_view to_string(Readiness readiness) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Readiness::count)> kNames{
      "ready", "not_ready", "in_flight", "not_known"};
  return kNames.at(static_cast<std::size_t>(readiness));
}

std::string_view to_string(CheckMark mark) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(CheckMark::count)> kNames{
      "not_known", "not_looked_at", "ok", "warn", "fail"};
  return kNames.at(static_cast<std::size_t>(mark));
}

TeamPreflight team_preflight(const mission::Fleet& fleet, Instant now) {
  TeamPreflight team;
  for (const auto& [vehicle, entry] : fleet.vehicles()) {
    team.rows.push_back(row_of(vehicle, entry, fleet.silence(), now));
  }
  mark_odd(team.rows);
  team.summary = summary_of(team.rows);
  return team;
}

std::string digest_text(std::uint32_t digest) {
  return digest == 0 ? "" : fmt::format("{:08x}", digest);
}

std::string preflight_text(const TeamPreflight& team, Instant now) {
  std::string text = team.summary + "\n";
  const Table table{team.rows, now};
  text += table.head();
  for (const auto& row : team.rows) {
    text += table.of(row);
    add_lines(text, row, true);
  }
  if (std::ranges::any_of(team.rows, is_odd)) text += kOddNote;
  return text;
}

std::optional<std::string> preflight_text(const TeamPreflight& team, VehicleId vehicle,
                                          Instant now) {
  const auto row = std::ranges::find(team.rows, vehicle, &PreflightRow::vehicle);
  if (row == team.rows.end()) return std::nullopt;
  const Table table{{*row}, now};
  std::string text = table.head() + table.of(*row);
  add_lines(text, *row, false);
  if (row->told != nullptr) {
    if (row->told->lines_left_out > 0) {
      text += fmt::format("         and {} more: 'skein-onboard check' there has them\n",
                          row->told->lines_left_out);
    }
    std::string good;
    for (const auto& count : row->told->counts) {
      if (count.passed > 0) add(good, fmt::format("{} {}", name_of(count.group), count.passed));
    }
    text += fmt::format("         {}: {}\n", row->counts ? "ok" : "were ok", good);
  }
  if (is_odd(*row)) text += kOddNote;
  return text;
}

std::string preflight_json(const TeamPreflight& team) {
  Json json{{"summary", team.summary}, {"groups", Json::array()}, {"vehicles", Json::array()}};
  for (std::size_t group = 0; group < kCheckGroups; ++group) {
    json["groups"].push_back(name_of(static_cast<CheckGroup>(group)));
  }
  for (const auto& row : team.rows) json["vehicles"].push_back(row_json(row));
  return codec::json_text(json);
}

}  // namespace skein::console
