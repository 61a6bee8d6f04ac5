// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

constexpr std::size_t kLineMax = 200;
constexpr std::size_t kTextMax = 500;
constexpr double kLongest_s = 9e9;  ///< that an Instant can tell

codec::Json json_of(const Audit::Entry& entry, std::uint64_t seq) {
  codec::Json json{{"seq", seq},         {"time_s", std::round(to_seconds(entry.time) * 1e3) / 1e3},
                   {"who", entry.who},   {"from", entry.from},
                   {"line", entry.line}, {"done", entry.done},
                   {"text", entry.text}};
  if (entry.in_part) json["in_part"] = true;
  return json;
}

/// What a line of the file has of it; what it has not is left empty.
Audit::Entry entry_of(const codec::ParsedJson& line) {
  const auto text = [&line](const char* name) {
    const auto found = line.find(name);
    return found != line.end() && found->is_string() ? found->get<std::string>() : std::string{};
  };
  const auto is_set = [&line](const char* name) {
    const auto found = line.find(name);
    return found != line.end() && found->is_boolean() && found->get<bool>();
  };
  const auto time = line.find("time_s");
  const double time_s = time != line.end() && time->is_number() ? time->get<double>() : 0.0;
  return {at_seconds(std::clamp(time_s, -kLongest_s, kLongest_s)),
          text("who"),
          text("from"),
          text("line"),
          is_set("done"),
          text("text"),
          is_set("in_part")};
}

/// No more than that, without what a terminal would obey.
std::string printable(std::string line, std::size_t most) {
  if (line.size() > most) line = line.substr(0, most) + "...";
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7f) c = '?';
  }
  return line;
}

}  // namespace

std::string_view outcome_word(const Audit::Entry& entry) {
  if (entry.done) return "";
  return entry.in_part ? "in part: " : "refused: ";
}

Result<Audit> Audit::open(const std::string& folder, std::optional<AuditKey> key) {
  Audit audit;
  if (folder.empty()) return audit;
  audit.path_ = (std::filesystem::path{folder} / "audit.jsonl").string();
  audit.key_ = std::move(key);
  std::ifstream earlier{audit.path_, std::ios::binary};
  const std::string before{std::istreambuf_iterator<char>{earlier}, {}};
  audit.recall(before);
  if (auto opened = audit.open_file(); !opened) return opened.error();
  return audit;
}

/// To add to; a line that was cut short stays as it is.
Result<void> Audit::open_file() {
  std::string last;
  {
    std::ifstream earlier{path_, std::ios::binary};
    bool ended = true;
    for (std::string line; std::getline(earlier, line); last = std::move(line)) {
      ended = !earlier.eof();
    }
    file_ = {};
    file_.rdbuf()->pubsetbuf(nullptr, 0);  // what failed is not tried again behind our back
    file_.open(path_, std::ios::app);
    if (!ended) file_ << '\n' << std::flush;
    line_before_ = ended && last.empty() ? kNoLineBefore : hash_of_line(last);
  }
  if (!file_) return Error{"cannot write " + path_};
  return {};
}

/// Of what the file has; whether somebody has changed it is for verify_audit() to say.
void Audit::recall(std::string_view text) {
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto json = codec::parse_json(text.substr(0, end));
    if (json.is_object()) {
      const auto seq = json.find("seq");
      if (seq != json.end() && seq->is_number_unsigned()) next_seq_ = seq->get<std::uint64_t>();
      if (json.contains("who")) keep(entry_of(json), next_seq_);
      is_unsigned_ = !json.contains("signed_by");
      ++next_seq_;
    }
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  written_to_ = next_seq_;
  show();
}

void Audit::keep(Entry entry, std::uint64_t seq) {
  entries_.push_back({std::move(entry), seq});
  if (entries_.size() > kShown) entries_.pop_front();
}

void Audit::show() {
  auto all = codec::Json::array();
  for (const auto& [one, number] : entries_) all.push_back(json_of(one, number));
  json_ = codec::json_text(all);
}

Result<void> Audit::write(const std::string& line) {
  file_ << line + '\n' << std::flush;
  is_broken_ = !file_;
  if (is_broken_) return Error{"cannot write " + path_};
  line_before_ = hash_of_line(line);
  return {};
}

/// What is kept and not yet in the file.
Result<void> Audit::write_kept() {
  if (path_.empty()) return {};
  if (is_broken_) {
    if (auto opened = open_file(); !opened) return opened;
  }
  for (const auto& [entry, seq] : entries_) {
    if (seq < written_to_) continue;
    auto line = json_of(entry, seq);
    line["prev"] = line_before_;
    if (auto written = write(codec::json_text(line)); !written) return written;
    written_to_ = seq + 1;
    is_unsigned_ = true;
  }
  return {};
}

Result<void> Audit::add(Entry entry) {
  entry.text = printable(wording::one_line(std::move(entry.text)), kTextMax);
  entry.line = printable(std::move(entry.line), kLineMax);
  keep(std::move(entry), next_seq_++);
  show();
  return write_kept();
}

Result<void> Audit::close(Instant now, std::int64_t unix_s) {
  if (auto written = write_kept(); !written) return written;
  if (!key_ || !is_unsigned_) return {};
  if (auto written = write(seal_line(*key_, next_seq_, line_before_, now, unix_s)); !written) {
    return written;
  }
  written_to_ = ++next_seq_;
  is_unsigned_ = false;
  return {};
}

std::string Audit::text() const {
  std::string text;
  for (const auto& [entry, seq] : entries_) {
    text += fmt::format("{:.1f} s  {} ({}): {} -> {}{}\n", to_seconds(entry.time), entry.who,
                        entry.from, entry.line, outcome_word(entry), entry.text);
  }
  return text.empty() ? "nobody has given an order yet\n" : text;
}

}  // namespace skein::groundstation
