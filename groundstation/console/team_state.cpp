// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "skein/codec/json_text.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::console {
namespace {

using mission::ShownState;

constexpr std::size_t kStates = static_cast<std::size_t>(TeamState::count);

/// The table; in the order of TeamState.
const std::array<TeamStateRow, kStates> kRows{{
    {TeamState::no_command,
     "alarm",
     "Nobody is in command",
     "Vehicles go on as they were told; no delivery is authorised, and no order is given.",
     "Take the command here, or find out why the ground station that has it is silent.",
     {}},
    {TeamState::lost_link,
     "alarm",
     "No vehicle is heard",
     "Vehicles go on: they hold at their gates, and come home when their range ends.",
     "Look at this ground station's radio and antenna first; then move to where vehicles are "
     "heard.",
     {}},
    {TeamState::in_the_way,
     "alarm",
     "In the way of other aircraft",
     "They come too near to an aircraft that is not of the team, and do not give way.",
     "Move them now, or tell its pilot; 'alarms' says how near and when.",
     {}},
    {TeamState::held,
     "warning",
     "All hold",
     "All who are heard hold by order.",
     "Resume them, or order them home, before their range ends.",
     {}},
    {TeamState::recall,
     "warning",
     "Recall",
     "All who are heard come home by order.",
     "Keep the landing place clear; 'land all' has them land, one after another.",
     {}},
    {TeamState::degraded,
     "warning",
     "Degraded",
     "Some vehicles cannot do their part; the others share out what they can.",
     "Look at those that are named; what is left may need fewer sites, or more vehicles.",
     {}},
    {TeamState::part_held,
     "info",
     "Some hold",
     "They hold by order, and take nothing up.",
     "Resume them when the reason is over.",
     {}},
    {TeamState::part_recall,
     "info",
     "Some come home",
     "They come home by order.",
     "'land' has those land that are at home.",
     {}},
    {TeamState::keeps_clear,
     "info",
     "Some keep clear of other aircraft",
     "They give way by their height, and go on with what they did.",
     "",
     {}},
    {TeamState::on_ground, "info", "On the ground", "All who are heard are on the ground.", "", {}},
    {TeamState::normal, "info", "Normal", "All are heard and do their part.", "", {}},
}};

bool holds(ShownState state) { return state == ShownState::holding_by_order; }
bool is_down(ShownState state) {
  return state == ShownState::on_the_ground || state == ShownState::landed;
}
bool is_recalled(ShownState state) {
  return state == ShownState::returning || state == ShownState::at_home ||
         state == ShownState::landing;
}
bool is_out_of_work(ShownState state) {
  return state == ShownState::range_reserve || state == ShownState::not_worked_with ||
         state == ShownState::back_into_its_fence || state == ShownState::piloted;
}

struct Counted {
  std::vector<VehicleId> heard, silent, held, recalled, down, degraded, in_the_way, keep_clear;
};

Counted count(const mission::Fleet& fleet, Instant now) {
  Counted all;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (entry.revoked || (!entry.expected && !entry.telemetry)) continue;
    if (!entry.telemetry) {
      // Before the mission's start they may not be there yet.
      if (now >= Instant{}) all.degraded.push_back(id);
      continue;
    }
    const ShownState state = mission::shown_state(entry);
    if (entry.silent) {
      all.silent.push_back(id);
      if (!is_down(state)) all.degraded.push_back(id);
      continue;
    }
    all.heard.push_back(id);
    if (entry.duplicate || entry.differs || is_out_of_work(state)) all.degraded.push_back(id);
    const auto does_not = [](const auto& aircraft) { return !aircraft.second; };
    if (std::ranges::any_of(entry.aircraft, does_not)) {
      all.in_the_way.push_back(id);
    } else if (!entry.aircraft.empty()) {
      all.keep_clear.push_back(id);
    }
    if (holds(state)) all.held.push_back(id);
    if (is_recalled(state)) all.recalled.push_back(id);
    if (is_down(state)) all.down.push_back(id);
  }
  return all;
}

}  // namespace

std::string_view to_string(TeamState state) {
  static constexpr std::array<std::string_view, kStates> kNames{
      "no_command", "lost_link",   "in_the_way",  "held",      "recall", "degraded",
      "part_held",  "part_recall", "keeps_clear", "on_ground", "normal"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::vector<TeamStateRow> team_state(const mission::Fleet& fleet, const TeamFacts& facts,
                                     Instant now) {
  const Counted team = count(fleet, now);
  const std::size_t heard = team.heard.size();
  const bool all_held = heard > 0 && team.held.size() == heard;
  const bool all_recalled =
      !team.recalled.empty() && team.recalled.size() + team.down.size() == heard;
  std::vector<TeamStateRow> rows;
  const auto add = [&rows](TeamState state, const std::vector<VehicleId>& vehicles = {}) {
    rows.push_back(kRows.at(static_cast<std::size_t>(state)));
    rows.back().vehicles = vehicles;
  };
  if (facts.nobody_commands) add(TeamState::no_command);
  if (heard == 0 && !team.silent.empty()) add(TeamState::lost_link);
  if (!team.in_the_way.empty()) add(TeamState::in_the_way, team.in_the_way);
  if (all_held) add(TeamState::held);
  if (all_recalled) add(TeamState::recall);
  if (!team.degraded.empty()) add(TeamState::degraded, team.degraded);
  if (!all_held && !team.held.empty()) add(TeamState::part_held, team.held);
  if (!all_recalled && !team.recalled.empty()) add(TeamState::part_recall, team.recalled);
  if (!team.keep_clear.empty()) add(TeamState::keeps_clear, team.keep_clear);
  if (heard > 0 && team.down.size() == heard) add(TeamState::on_ground);
  if (rows.empty()) add(TeamState::normal);
  return rows;
}

std::string team_text(const std::vector<TeamStateRow>& rows) {
  std::string text;
  for (const TeamStateRow& row : rows) {
    std::vector<std::uint16_t> ids;
    for (const VehicleId id : row.vehicles) ids.push_back(id.value);
    text += fmt::format("{}{}{}{}: {}{}{}\n", text.empty() ? "team: " : "      ", row.title,
                        ids.empty() ? "" : ": ", fmt::join(ids, ", "), row.means,
                        row.to_do.empty() ? "" : " ", row.to_do);
  }
  return text;
}

std::string team_json(const std::vector<TeamStateRow>& rows) {
  codec::Json all = codec::Json::array();
  for (const TeamStateRow& row : rows) {
    codec::Json vehicles = codec::Json::array();
    for (const VehicleId id : row.vehicles) vehicles.push_back(id.value);
    all.push_back({{"state", to_string(row.state)},
                   {"level", row.level},
                   {"title", row.title},
                   {"means", row.means},
                   {"to_do", row.to_do},
                   {"vehicles", std::move(vehicles)}});
  }
  return codec::json_text(all);
}

}  // namespace skein::console
