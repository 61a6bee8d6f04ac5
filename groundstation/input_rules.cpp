// SPDX-License-Identifier: Apache-2.0
#include "input_rules.hpp"

#include <string>
#include <variant>

namespace skein::groundstation {

bool only_looks(const Input& input) {
  const auto* formation = std::get_if<Formation>(&input);
  const auto* site = std::get_if<NewSite>(&input);
  const auto* routes = std::get_if<RoutesFromFile>(&input);
  const auto* fence = std::get_if<NewFence>(&input);
  const auto* search = std::get_if<SearchArea>(&input);
  const auto* hazard = std::get_if<NewHazard>(&input);
  return std::holds_alternative<std::monostate>(input) || std::holds_alternative<View>(input) ||
         std::holds_alternative<PreflightOf>(input) || std::holds_alternative<StatusOf>(input) ||
         std::holds_alternative<ReturnPreview>(input) ||
         (formation != nullptr && formation->preview) || (site != nullptr && site->preview) ||
         (routes != nullptr && routes->preview) || (fence != nullptr && fence->preview) ||
         (search != nullptr && search->preview) || (hazard != nullptr && hazard->preview);
}

const char* why_not_on_console(const Input& input) {
  const auto names_file = [](const std::string& text) {
    return text.find_first_of("./") != std::string::npos;
  };
  const auto* formation = std::get_if<Formation>(&input);
  if (formation != nullptr && (names_file(formation->shape) || names_file(formation->track))) {
    return "the console takes shapes and tracks by their names; files are for the prompt\n";
  }
  if (std::holds_alternative<SitesFromFile>(input)) {
    return "files of sites are for the prompt and the command line\n";
  }
  const auto* fence = std::get_if<NewFence>(&input);
  if (fence != nullptr && !fence->file.empty()) {
    return "files of fences are for the prompt and the command line; the page reads its own\n";
  }
  if (std::holds_alternative<RoutesFromFile>(input)) {
    return "files of routes are for the prompt and the command line\n";
  }
  if (std::holds_alternative<Record>(input)) {
    return "record is for the prompt and the command line\n";
  }
  if (std::holds_alternative<Quit>(input)) return "quit is for the prompt and the command line\n";
  return nullptr;
}

}  // namespace skein::groundstation
