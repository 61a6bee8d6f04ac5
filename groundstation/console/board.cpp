// SPDX-License-Identifier: Apache-2.0
#include "board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skein::console {

void Board::publish(double time_s, Sections sections) {
  time_s_ = time_s;
  ++number_;
  for (std::size_t i = 0; i < kSectionCount; ++i) {
    if (sections[i].empty() || sections[i] == sections_[i]) continue;
    if (static_cast<Section>(i) == Section::timeline) {
      // A recording may be wound back.
      if (std::abs(time_s - timeline_s_) < kTimelinePeriod_s) continue;
      timeline_s_ = time_s;
    }
    sections_[i] = std::move(sections[i]);
    revisions_[i] = number_;
  }
}

void Board::append(std::vector<std::string> events) {
  for (std::string& event : events) events_.push_back(std::move(event));
  while (events_.size() > kEventsKept) {
    events_.pop_front();
    ++first_seq_;
  }
}

void Board::truncate(std::uint64_t next_seq) {
  if (next_seq <= first_seq_) {
    events_.clear();
    first_seq_ = next_seq;
  } else if (next_seq < first_seq_ + events_.size()) {
    events_.resize(next_seq - first_seq_);
  }
}

std::string Board::state(Seen& seen) const {
  std::string text = fmt::format(R"({{"type":"state","time_s":{:.3f})", time_s_);
  for (std::size_t i = 0; i < kSectionCount; ++i) {
    if (revisions_[i] <= seen.revisions[i]) continue;
    seen.revisions[i] = revisions_[i];
    text += fmt::format(R"(,"{}":{})", to_string(static_cast<Section>(i)), sections_[i]);
  }
  seen.number = number_;
  return text += '}';
}

std::string Board::events(Seen& seen) const {
  std::string text = R"({"type":"events","events":[)";
  std::uint64_t seq = std::max(seen.next_seq, first_seq_);
  const std::uint64_t end = std::min(next_seq(), seq + kEventsPerText);
  for (bool first = true; seq < end; ++seq, first = false) {
    if (!first) text += ',';
    text += events_[seq - first_seq_];
  }
  seen.next_seq = end;
  return text += "]}";
}

std::string Board::history(const std::string& series) const {
  return fmt::format(
      R"({{"type":"history","series":{},"events":{{"first_seq":{},"next_seq":{}}}}})", series,
      first_seq_, next_seq());
}

}  // namespace skein::console
