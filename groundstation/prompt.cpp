// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/prompt.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "area_words.hpp"
#include "fence_words.hpp"
#include "prompt_words.hpp"
#include "site_words.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/text.hpp"

namespace skein::groundstation {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  static constexpr std::string_view kBlank = " \t\r\n";
  std::vector<std::string_view> words;
  for (auto begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
    const auto end = line.find_first_of(kBlank, begin);
    words.push_back(line.substr(begin, end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(kBlank, end);
  }
  return words;
}

Result<Input> view(View which, const std::vector<std::string_view>& words) {
  if (words.size() > 1) return Error{fmt::format("'{}' stands alone", words[0])};
  return Input{which};
}

Result<Input> decision(bool grant, const std::vector<std::string_view>& words) {
  const bool although_silent = grant && words.size() == 3 && words[2] == "override";
  const auto site = words.size() == 2 || although_silent ? id_of(words[1]) : std::nullopt;
  if (!site) {
    return Error{fmt::format(
        "'{0}' needs the number of a site, as in '{0} 3'; 'pending' shows what waits", words[0])};
  }
  return Input{Decision{{*site}, grant, {}, although_silent}};
}

Result<Input> order(mission::CommandKind kind, const std::vector<std::string_view>& words) {
  if (words.size() == 2 && words[1] == "all") return Input{Order{kGroundStation, kind}};
  const auto vehicle = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (vehicle) return Input{Order{{*vehicle}, kind}};
  if (auto several = words.size() == 2 ? ids_of(words[1]) : std::nullopt) {
    return Input{OrderToSeveral{*std::move(several), kind}};
  }
  return Error{fmt::format(
      "'{0}' needs the number of a vehicle, several as '{0} 3,5-9', or 'all', as in '{0} 7'",
      words[0])};
}

/// 'land' alone is of a formation.
bool lands_vehicles(const std::vector<std::string_view>& words) {
  return words.size() == 2 && words[0] == "land";
}

Result<Input> give_back(const std::vector<std::string_view>& words) {
  const auto vehicle = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (!vehicle) {
    return Error{fmt::format(
        "'{0}' needs the number of one vehicle, as in '{0} 7': each pilot gives his own",
        words[0])};
  }
  return Input{Order{{*vehicle}, mission::CommandKind::give_back}};
}

/// What follows the shape, in any order.
Result<Formation> with_options(Formation input, const std::vector<std::string_view>& words) {
  std::size_t next = 0;
  const auto take = [&](std::string_view keyword, const Limit& limit) -> Result<double> {
    if (next == words.size()) return Error{fmt::format("'{}' needs a number after it", keyword)};
    return number_after(keyword, words[next++], limit);
  };
  formation::ShapeSpec& shape = input.order.shape;
  const bool along = input.order.kind == mission::OrderKind::fly_along;
  while (next < words.size()) {
    const auto keyword = words[next++];
    if (along && keyword != "spacing" && keyword != "speed" && keyword != "laps") {
      return Error{fmt::format("'{}' is none of spacing M, speed M/S, laps N", keyword)};
    }
    if (keyword == "spacing") {
      const auto metres = take(keyword, kSpacing_m);
      if (!metres) return metres.error();
      shape.spacing_m = *metres;
      input.has_spacing = true;
    } else if (keyword == "heading") {
      const auto degrees = take(keyword, kHeading_deg);
      if (!degrees) return degrees.error();
      shape.heading_rad = heading_from_compass_deg(*degrees);
      input.has_heading = true;
    } else if (keyword == "speed" && along) {
      const auto speed = take(keyword, kTrackSpeed_mps);
      if (!speed) return speed.error();
      input.speed_mps = *speed;
    } else if (keyword == "laps" && along) {
      const auto laps = take(keyword, kLaps);
      if (!laps) return laps.error();
      input.laps = static_cast<int>(*laps);
    } else if (keyword == "places") {
      const auto count = take(keyword, kPlaces);
      if (!count) return count.error();
      input.order.places = static_cast<std::size_t>(*count);
    } else if (keyword == "at") {
      for (int axis = 0; axis < 3; ++axis) {
        const auto metres = take("at EAST NORTH HEIGHT", kCoordinate_m);
        if (!metres) return metres.error();
        shape.centre[axis] = *metres;
      }
      input.has_centre = true;
    } else {
      return Error{fmt::format(
          "'{}' is none of spacing M, heading DEG, at EAST NORTH HEIGHT, places N", keyword)};
    }
  }
  return input;
}

/// A shape's name, or what is left to be looked up.
void set_shape(Formation& input, std::string_view word) {
  const auto kind = shape_named(word);
  input.order.shape.kind = kind.value_or(formation::ShapeKind::free);
  if (!kind) input.shape = word;
}

Result<Input> fly_along(Formation input, const std::vector<std::string_view>& words) {
  if (words.size() < 4 || words[2] != "in") {
    return Error{
        "'fly-along' needs a track and a shape, as in 'fly-along lap in wedge spacing 40 speed "
        "18'"};
  }
  input.order.kind = mission::OrderKind::fly_along;
  input.track = words[1];
  set_shape(input, words[3]);
  auto complete = with_options(input, {words.begin() + 4, words.end()});
  if (!complete) return complete.error();
  return Input{*std::move(complete)};
}

Result<Input> formation_order(const std::vector<std::string_view>& words, bool preview) {
  Formation input;
  input.preview = preview;
  const auto verb = words[0];
  if (verb == "fly-along") return fly_along(std::move(input), words);
  if (verb != "form") {
    if (words.size() > 1) return Error{fmt::format("'{}' stands alone", verb)};
    input.order.kind = verb == "take-off" ? mission::OrderKind::take_off
                       : verb == "land"   ? mission::OrderKind::land
                                          : mission::OrderKind::rally;
    return Input{input};
  }
  if (words.size() < 2) {
    return Error{
        fmt::format("'form' needs a shape: {}, or the name or file of a free one, as in "
                    "'form wedge spacing 5'",
                    fmt::join(shape_names(), ", "))};
  }
  input.order.kind = mission::OrderKind::form;
  set_shape(input, words[1]);
  auto complete = with_options(input, {words.begin() + 2, words.end()});
  if (!complete) return complete.error();
  return Input{*std::move(complete)};
}

bool is_formation_verb(std::string_view word) {
  return word == "take-off" || word == "rally" || word == "form" || word == "land" ||
         word == "fly-along";
}

bool is_of_hazard(const std::vector<std::string_view>& words) {
  return !words.empty() && (words[0] == "hazard" ||
                            (words[0] == "change" && words.size() > 1 && words[1] == "hazard"));
}

/// `routes` alone looks; with a file it gives them.
Result<Input> route_order(const std::vector<std::string_view>& words, bool preview) {
  if (words.size() == 1 && !preview) return Input{View::routes};
  const bool timed = words.size() == 4 && words[2] == "in";
  if (words.size() != 2 && !timed) {
    return Error{
        "'routes' needs the file of a plan, and when it begins where that is not mission time 0, "
        "as in 'routes plan.yaml in 60'"};
  }
  RoutesFromFile order{std::string{words[1]}, {}, preview};
  if (timed) {
    const auto seconds = number_after("in", words[3], kRoutesIn_s);
    if (!seconds) return seconds.error();
    order.in_s = *seconds;
  }
  return Input{order};
}

/// 'return all', or numbers with commas between them.
Result<Input> return_preview(const std::vector<std::string_view>& words) {
  const Error wrong{
      "'preview return' needs the numbers of vehicles or 'all', as in 'preview return 3,5-9'"};
  if (words.size() != 2) return wrong;
  ReturnPreview preview;
  if (words[1] == "all") return Input{preview};
  auto vehicles = ids_of(words[1]);
  if (!vehicles) return wrong;
  preview.vehicles = *std::move(vehicles);
  return Input{std::move(preview)};
}

Result<Input> preview(std::vector<std::string_view> words) {
  words.erase(words.begin());
  if (!words.empty() && words[0] == "return") return return_preview(words);
  if (!words.empty() && words[0] == "routes") return route_order(words, true);
  if (!words.empty() && words[0] == "fence") return fence_order(words, true);
  if (!words.empty() && words[0] == "search") return search_order(words, true);
  if (is_of_hazard(words)) return hazard_order(words, true);
  if (!words.empty() && (words[0] == "site" || words[0] == "change")) {
    return site_order(words, true);
  }
  if (words.empty() || !is_formation_verb(words[0])) {
    return Error{
        "'preview' needs an order to the formation, of a site, of routes, of a search, of a "
        "hazard, "
        "of a fence or to return, as in "
        "'preview form wedge spacing 5'"};
  }
  return formation_order(words, true);
}

Result<Input> wait(const std::vector<std::string_view>& words) {
  if (words.size() != 2) return Error{"'wait' needs seconds, as in 'wait 10'"};
  const auto seconds = number_after("wait", words[1], kWait_s);
  if (!seconds) return seconds.error();
  return Input{Wait{from_seconds(*seconds)}};
}

Result<Input> preflight(const std::vector<std::string_view>& words) {
  if (words.size() == 1 || (words.size() == 2 && words[1] == "all")) return Input{View::preflight};
  const auto id = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (!id) return Error{"'preflight' stands alone, or before 'all' or a vehicle's number"};
  return Input{PreflightOf{{*id}}};
}

Result<Input> status(const std::vector<std::string_view>& words) {
  if (words.size() == 1) return Input{View::status};
  const auto id = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (!id) return Error{"'status' stands alone, or before a vehicle's number"};
  return Input{StatusOf{{*id}}};
}

Result<Input> acknowledgement(const std::vector<std::string_view>& words) {
  if (words.size() == 2 && words[1] == "all") return Input{Acknowledge{}};
  Acknowledge order;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto number = number_of(words[i]);
    const bool whole = number && *number >= 1.0 && *number < 4294967296.0 &&
                       static_cast<double>(static_cast<std::uint32_t>(*number)) == *number;
    if (!whole) order.numbers.clear();
    if (!whole) break;
    order.numbers.push_back(static_cast<std::uint32_t>(*number));
  }
  if (!order.numbers.empty()) return Input{order};
  return Error{
      "'acknowledge' needs the numbers of alarms or 'all', as in 'acknowledge 3'; 'alarms' "
      "lists them"};
}

Result<Input> record(const std::vector<std::string_view>& words) {
  if (words.size() != 2) return Error{"'record' needs a folder, or 'stop'"};
  return Input{Record{words[1] == "stop" ? std::string{} : std::string{words[1]}}};
}

Result<Input> take_command(const std::vector<std::string_view>& words) {
  if (words.size() < 2 || words[1] != "command") {
    return Error{"'take' takes the command: 'take command', and why, for the others"};
  }
  // As it was typed, blanks and all: words are views of one line.
  const auto reason = words.size() == 2 ? std::string_view{}
                                        : std::string_view{words[2].begin(), words.back().end()};
  return Input{TakeCommand{as_text(reason, kReasonMax)}};
}

Result<Input> hand_over(const std::vector<std::string_view>& words) {
  if (words.size() != 2 || words[1] != "over") {
    return Error{"'hand over' stands alone; a watching ground station takes the command"};
  }
  return Input{HandOver{}};
}

}  // namespace

Result<Input> parse_input(std::string_view line) {
  if (line.size() > kLineMax) {
    return Error{fmt::format("a line has at most {} characters; nothing is done", kLineMax)};
  }
  const auto words = words_of(line);
  if (words.empty()) return Input{};
  const auto verb = words[0];
  if (verb == "help") return view(View::help, words);
  if (verb == "status") return status(words);
  if (verb == "links") return view(View::links, words);
  if (verb == "wind") return view(View::wind, words);
  if (verb == "traffic") return view(View::traffic, words);
  if (verb == "sites" && words.size() == 2) return Input{SitesFromFile{std::string{words[1]}}};
  if (verb == "sites") return view(View::sites, words);
  if (is_of_hazard(words)) return hazard_order(words, false);
  if (verb == "search") return search_order(words, false);
  if (verb == "site" || verb == "change") return site_order(words, false);
  if (verb == "routes") return route_order(words, false);
  if (verb == "withdraw" && words.size() == 2 && words[1] == "routes") {
    return Input{CallOffRoutes{}};
  }
  if (verb == "withdraw") return withdrawal(words);
  if (verb == "accept" || verb == "dismiss") return proposal_answer(verb == "accept", words);
  if (verb == "proposals") return view(View::proposals, words);
  if (verb == "pending") return view(View::pending, words);
  if (verb == "authorise") return decision(true, words);
  if (verb == "refuse") return decision(false, words);
  if (verb == "coalitions") return view(View::coalitions, words);
  if (verb == "preflight") return preflight(words);
  if (verb == "hazards") return view(View::hazards, words);
  if (verb == "alarms") return view(View::alarms, words);
  if (verb == "acknowledge") return acknowledgement(words);
  if (verb == "audit") return view(View::audit, words);
  if (verb == "console") return view(View::console, words);
  if (verb == "command") return view(View::command, words);
  if (verb == "take") return take_command(words);
  if (verb == "hand") return hand_over(words);
  if (verb == "fence") return fence_order(words, false);
  if (verb == "hold") return order(mission::CommandKind::hold, words);
  if (verb == "resume") return order(mission::CommandKind::resume, words);
  if (verb == "return") return order(mission::CommandKind::return_home, words);
  if (lands_vehicles(words)) return order(mission::CommandKind::land, words);
  if (is_formation_verb(verb)) return formation_order(words, false);
  if (verb == "preview") return preview(words);
  if (verb == "wait") return wait(words);
  if (verb == "places") return view(View::places, words);
  if (verb == "give-back") return give_back(words);
  if (verb == "record") return record(words);
  if (verb == "quit") {
    if (words.size() > 1) return Error{"'quit' stands alone"};
    return Input{Quit{}};
  }
  return Error{fmt::format("there is no command '{}'; 'help' lists them", verb)};
}

bool is_of_formation(std::string_view line) {
  const auto words = words_of(line);
  return !words.empty() && !lands_vehicles(words) &&
         (is_formation_verb(words[0]) || words[0] == "places" ||
          (words[0] == "preview" && words.size() > 1 && is_formation_verb(words[1])));
}

namespace {

/// What is looked at, told and decided.
std::string help_of_sites() {
  return "status [ID]       the fleet: what each vehicle does, when it was last heard, its health\n"
         "links             who hears whom, how often, and what is lost\n"
         "wind              as the planes that fly tell it\n"
         "traffic           aircraft that are not of the team, the nearest first\n"
         "preflight [ID]    who is ready before the flight, and what each vehicle's checks find\n"
         "sites             the sites and what was done there\n"
         "pending           deliveries that wait for your decision\n"
         "authorise SITE    let the deliveries at SITE be flown as planned; with 'override' "
         "behind\n"
         "                  it also where one that takes part is silent\n"
         "refuse SITE       do not\n"
         "withdraw decision SITE\n"
         "                  take back what was authorised there, but for a delivery that has "
         "begun\n"
         "coalitions        what was announced, bid and awarded, and what came of it\n"
         "hazards           what to keep out of\n"
         "hazard EAST NORTH RADIUS\n"
         "                  tell all of another one, in metres from the origin\n"
         "hazard polygon E,N E,N E,N ...\n"
         "                  the same of a polygon: circles hold it; change hazard N ...: another "
         "shape\n"
         "withdraw hazard N there is none any more\n"
         "fence EAST,NORTH EAST,NORTH ... height M\n"
         "                  where all are to stay from now on, or of a file: fence FILE height M "
         "(GeoJSON,\n"
         "                  or a plan of QGroundControl); preview fence ...: whether it can be\n"
         "fence             which one is to be kept, and who keeps it\n"
         "search E,N E,N E,N ...\n"
         "                  share an area out among vehicles that search it, by its corners in "
         "metres;\n"
         "                  then, as wanted, by IDS, spacing M, in S; search rest: what was not "
         "seen;\n"
         "                  search: how far it is; withdraw routes calls it off\n"
         "site EAST NORTH ...\n"
         "                  tell the team of a site, in metres from the origin or as 59.12N "
         "17.23E;\n"
         "                  then, as wanted, like NAME, deliver BEARINGS, simultaneous or every "
         "S,\n"
         "                  assess N, wait S, dwell S, survey S, reward R, decay R, by ID, "
         "anyway:\n"
         "                  site 1200 -300 deliver 090,180 every 4 assess 2 reward 3\n"
         "                  site like NAME at EAST NORTH ...: as the configuration's template has "
         "it\n"
         "sites FILE        tell it of those of a file\n"
         "change site N ... until a delivery there is authorised; a place goes after 'at'\n"
         "withdraw site N   nobody goes on with it, but for a delivery that has begun\n"
         "routes FILE       offer vehicles the routes of a plan (plan.yaml of skein-ground plan), "
         "from\n"
         "                  mission time 0 on, or in S seconds: routes FILE in S; they fly when "
         "all\n"
         "                  have taken theirs\n"
         "routes            which plan is given, and how far each vehicle is with its route\n"
         "withdraw routes   nobody flies them, or goes on with them\n"
         "proposals         what detectors have seen and you have not answered\n"
         "accept N          take proposal N as a site; dismiss N: it is none\n"
         "alarms            what needs you now, the worst first, with what to do; and how long it "
         "took\n"
         "                  until vehicles showed that they obey\n"
         "acknowledge N|all those alarms are seen: they are silent, and stay until they are over\n"
         "audit             who gave which order, from where, and what came of it\n"
         "command           which ground station has the command\n"
         "take command WHY  this one takes it, whoever has it, and tells the others why\n"
         "hand over         ask a ground station that watches to take it\n"
         "console           the address of its page, with the token that opens it\n";
}

}  // namespace

std::string help_text() {
  return help_of_sites() +
         "hold ID|all       fly a holding pattern until told otherwise; this one and the next "
         "three "
         "also\n"
         "                  to several at once: hold 3,5-9\n"
         "resume ID|all     go on with the mission\n"
         "return ID|all     fly back to the start and hold there\n"
         "land ID|all       who is at home, or on the way there, lands, one after another, the "
         "lowest\n"
         "                  first; hold, return or resume before touch-down: it goes around\n"
         "give-back ID      its pilot gives the aircraft (back) to the companion: in the air to "
         "be\n"
         "                  flown, on the ground to be launched where it takes off by itself\n"
         "take-off          the formation rises to the rally's height\n"
         "rally             it gathers at the rally\n"
         "form SHAPE ...    it takes a shape, by its name ('form' alone lists them) or the file "
         "of\n"
         "                  a free one; then, as wanted, spacing M, heading DEG,\n"
         "                  at EAST NORTH HEIGHT, places N\n"
         "fly-along TRACK in SHAPE ...\n"
         "                  planes join in the shape and fly along the track, by its name or "
         "file;\n"
         "                  then, as wanted, spacing M, speed M/S, laps N; form SHAPE spacing M: "
         "they\n"
         "                  slide into another shape on the way\n"
         "land              it comes straight down\n"
         "preview ORDER     what one of these five, site, change, routes, search, hazard, fence or "
         "return\n"
         "                  would do, and whether it is safe; return takes several: preview return "
         "3,4\n"
         "places            where each vehicle of the formation is, and how far from its place\n"
         "record FOLDER     record all that is said into FOLDER, too, from now on; record stop: no "
         "more\n"
         "quit              end the ground station; the vehicles go on\n";
}

}  // namespace skein::groundstation
