// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/audit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "skein/codec/json_text.hpp"

namespace skein::groundstation {
namespace {

constexpr std::size_t kLineMax = 200;

codec::Json json_of(const Audit::Entry& entry, std::uint64_t seq) {
  return {{"seq", seq},         {"time_s", std::round(to_seconds(entry.time) * 1e3) / 1e3},
          {"who", entry.who},   {"from", entry.from},
          {"line", entry.line}, {"done", entry.done},
          {"text", entry.text}};
}

/// Of what somebody typed: a line's worth, without what a terminal would obey.
std::string printable(std::string line) {
  if (line.size() > kLineMax) line = line.substr(0, kLineMax) + "...";
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7f) c = '?';
  }
  return line;
}

}  // namespace

Result<Audit> Audit::open(const std::string& folder) {
  Audit audit;
  if (folder.empty()) return audit;
  audit.path_ = (std::filesystem::path{folder} / "audit.jsonl").string();
  audit.file_.open(audit.path_, std::ios::app);
  if (!audit.file_) return Error{"cannot write " + audit.path_};
  return audit;
}

Result<void> Audit::add(Entry entry) {
  entry.text = entry.text.substr(0, entry.text.find('\n'));
  entry.line = printable(entry.line);
  const auto line = json_of(entry, next_seq_++);
  entries_.push_back(std::move(entry));
  if (entries_.size() > kShown) entries_.pop_front();
  auto all = codec::Json::array();
  std::uint64_t seq = next_seq_ - entries_.size();
  for (const Entry& one : entries_) all.push_back(json_of(one, seq++));
  json_ = codec::json_text(all);
  if (path_.empty()) return {};
  file_ << codec::json_text(line) << '\n' << std::flush;
  if (file_) return {};
  file_.clear();
  return Error{"cannot write " + path_};
}

std::string Audit::text() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += fmt::format("{:.1f} s  {} ({}): {} -> {}{}\n", to_seconds(entry.time), entry.who,
                        entry.from, entry.line, entry.done ? "" : "refused: ", entry.text);
  }
  return text.empty() ? "nobody has given an order yet\n" : text;
}

}  // namespace skein::groundstation
