// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <string>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"

namespace skein::groundstation {

/// Every order and decision of people: who gave it, from where, and what came of it. Kept for the
/// console and, where there is a recording, in audit.jsonl, a JSON object a line, written through
/// at once.
class Audit {
 public:
  static constexpr std::size_t kShown = 200;

  struct Entry {
    Instant time{};
    std::string who;
    std::string from;  ///< console, prompt, command line
    std::string line;  ///< as it was given
    bool done = false;
    std::string text;  ///< the answer's first line
  };

  /// `folder` empty: kept in memory only. A file of an earlier run is gone on with.
  [[nodiscard]] static Result<Audit> open(const std::string& folder);

  /// Fails where the file cannot be written; the entry is kept all the same.
  Result<void> add(Entry entry);

  /// Precondition: one was added.
  [[nodiscard]] const Entry& newest() const { return entries_.back(); }
  /// The newest kShown, oldest first, as a JSON array.
  [[nodiscard]] const std::string& json() const { return json_; }
  [[nodiscard]] std::string text() const;

 private:
  std::string path_;
  std::ofstream file_;
  std::deque<Entry> entries_;
  std::uint64_t next_seq_ = 0;
  std::string json_ = "[]";
};

}  // namespace skein::groundstation
