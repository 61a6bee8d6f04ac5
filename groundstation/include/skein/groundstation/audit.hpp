// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <optional>
#include <string>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/groundstation/audit_chain.hpp"

namespace skein::groundstation {

/// Every order and decision of people: who gave it, from where, and what came of it. Kept for the
/// console and, where there is a recording, in audit.jsonl, a JSON object a line, written through
/// at once, chained and signed (audit_chain.hpp).
class Audit {
 public:
  static constexpr std::size_t kShown = 200;

  struct Entry {
    Instant time{};
    std::string who;
    std::string from;  ///< console, prompt, command line
    std::string line;  ///< as it was given
    bool done = false;
    std::string text;      ///< the answer, its lines in one
    bool in_part = false;  ///< done for some of whom it was for
  };

  /// `folder` empty: kept in memory only. A file of an earlier run is gone on with, and its newest
  /// entries are shown.
  [[nodiscard]] static Result<Audit> open(const std::string& folder,
                                          std::optional<AuditKey> key = {});

  /// Fails where the file cannot be written; the entry is kept all the same, and written as soon as
  /// the file can be, unless kShown have come since.
  Result<void> add(Entry entry);
  /// The run ends: it signs, where it has a key and has written anything.
  Result<void> close(Instant now, std::int64_t unix_s);

  /// Precondition: one was added.
  [[nodiscard]] const Entry& newest() const { return entries_.back().entry; }
  /// The newest kShown, oldest first, as a JSON array.
  [[nodiscard]] const std::string& json() const { return json_; }
  [[nodiscard]] std::string text() const;

 private:
  void recall(std::string_view text);
  void keep(Entry entry, std::uint64_t seq);
  void show();
  Result<void> open_file();
  Result<void> write_kept();
  Result<void> write(const std::string& line);

  std::string path_;
  std::ofstream file_;
  std::optional<AuditKey> key_;
  struct Numbered {
    Entry entry;
    std::uint64_t seq = 0;
  };
  std::deque<Numbered> entries_;
  std::uint64_t next_seq_ = 0;
  std::string line_before_ = kNoLineBefore;  ///< its hash
  std::uint64_t written_to_ = 0;             ///< the number after the newest in the file
  bool is_broken_ = false;                   ///< the file's end may not be what we wrote
  bool is_unsigned_ = false;                 ///< entries follow the last signature
  std::string json_ = "[]";
};

/// Before an entry's text, for people: "refused: ", "in part: "; empty where it was done.
[[nodiscard]] std::string_view outcome_word(const Audit::Entry& entry);

}  // namespace skein::groundstation
