// SPDX-License-Identifier: Apache-2.0
#include "includes.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <string_view>

namespace skein::tidy {
namespace {

/// Walks depth first, and remembers which nodes lead to the one that it stands on.
class Walk {
 public:
  explicit Walk(const Graph& graph) : graph_{graph} {}

  void from(const std::string& node) {
    const auto open = std::find(way_.begin(), way_.end(), node);
    if (open != way_.end()) {
      cycles_.emplace_back(open, way_.end()).push_back(node);
      return;
    }
    if (!seen_.insert(node).second) return;
    way_.push_back(node);
    if (const auto next = graph_.find(node); next != graph_.end()) {
      for (const std::string& n : next->second) from(n);
    }
    way_.pop_back();
  }

  [[nodiscard]] std::vector<std::vector<std::string>> take() { return std::move(cycles_); }

 private:
  const Graph& graph_;
  std::vector<std::string> way_;
  std::set<std::string> seen_;
  std::vector<std::vector<std::string>> cycles_;
};

}  // namespace

Graph includes_of(const std::map<std::string, std::string>& code_of_path) {
  static constexpr std::string_view kFolder = "/include/";
  std::map<std::string, std::string> public_headers;  // their paths by what includes write
  for (const auto& [path, code] : code_of_path) {
    const std::size_t at = path.find(kFolder);
    if (at != std::string::npos) public_headers[path.substr(at + kFolder.size())] = path;
  }
  static const std::regex include{R"x((^|\n)[ \t]*#[ \t]*include[ \t]*"([^"\n]+)")x"};
  Graph graph;
  for (const auto& [path, code] : code_of_path) {
    std::set<std::string>& mine = graph[path];
    for (std::sregex_iterator it{code.begin(), code.end(), include}, end; it != end; ++it) {
      const auto header = public_headers.find((*it)[2].str());
      const auto beside =
          (std::filesystem::path{path}.parent_path() / (*it)[2].str()).lexically_normal();
      if (header != public_headers.end()) {
        mine.insert(header->second);
      } else if (code_of_path.contains(beside.generic_string())) {
        mine.insert(beside.generic_string());
      }
    }
  }
  return graph;
}

std::vector<std::vector<std::string>> cycles_of(const Graph& graph) {
  Walk walk{graph};
  for (const auto& [node, next] : graph) walk.from(node);
  return walk.take();
}

}  // namespace skein::tidy
