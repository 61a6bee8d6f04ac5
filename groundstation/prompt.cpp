// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/prompt.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <vector>

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

/// A number from 1 up, as sites and vehicles have.
std::optional<std::uint16_t> id_of(std::string_view word) {
  std::uint16_t id = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), id);
  if (error != std::errc{} || end != word.data() + word.size() || id == 0) return std::nullopt;
  return id;
}

Result<Input> view(View which, const std::vector<std::string_view>& words) {
  if (words.size() > 1) return Error{fmt::format("'{}' stands alone", words[0])};
  return Input{which};
}

Result<Input> decision(bool grant, const std::vector<std::string_view>& words) {
  const auto site = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (!site) {
    return Error{fmt::format(
        "'{0}' needs the number of a site, as in '{0} 3'; 'pending' shows what waits", words[0])};
  }
  return Input{Decision{{*site}, grant}};
}

Result<Input> order(mission::CommandKind kind, const std::vector<std::string_view>& words) {
  if (words.size() == 2 && words[1] == "all") return Input{Order{kGroundStation, kind}};
  const auto vehicle = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (!vehicle) {
    return Error{
        fmt::format("'{0}' needs the number of a vehicle or 'all', as in '{0} 7'", words[0])};
  }
  return Input{Order{{*vehicle}, kind}};
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

}  // namespace

Result<Input> parse_input(std::string_view line) {
  const auto words = words_of(line);
  if (words.empty()) return Input{};
  const auto verb = words[0];
  if (verb == "help") return view(View::help, words);
  if (verb == "status") return view(View::status, words);
  if (verb == "sites") return view(View::sites, words);
  if (verb == "pending") return view(View::pending, words);
  if (verb == "authorise") return decision(true, words);
  if (verb == "refuse") return decision(false, words);
  if (verb == "hold") return order(mission::CommandKind::hold, words);
  if (verb == "resume") return order(mission::CommandKind::resume, words);
  if (verb == "return") return order(mission::CommandKind::return_home, words);
  if (verb == "give-back") return give_back(words);
  if (verb == "quit") {
    if (words.size() > 1) return Error{"'quit' stands alone"};
    return Input{Quit{}};
  }
  return Error{fmt::format("there is no command '{}'; 'help' lists them", verb)};
}

std::string help_text() {
  return "status            the fleet: what each vehicle does, when it was last heard, its health\n"
         "sites             the sites and what was done there\n"
         "pending           deliveries that wait for your decision\n"
         "authorise SITE    let the deliveries at SITE be flown as planned\n"
         "refuse SITE       do not\n"
         "hold ID|all       fly a holding pattern until told otherwise\n"
         "resume ID|all     go on with the mission\n"
         "return ID|all     fly back to the start and hold there\n"
         "give-back ID      its pilot gives the aircraft (back) to the companion: in the air to "
         "be\n"
         "                  flown, on the ground to be launched where it takes off by itself\n"
         "quit              end the ground station; the vehicles go on\n";
}

}  // namespace skein::groundstation
