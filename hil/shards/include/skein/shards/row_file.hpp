// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::shards {

/// Which run a row is of. Ascending keys are the order in which one machine flies them.
struct RowKey {
  std::uint64_t seed = 0;
  std::size_t cell = 0;  ///< of a grid; 0 where there is none
  auto operator<=>(const RowKey&) const = default;
};

/// A table on disk, a row a run, which grows as runs end and survives a kill at any moment. In
/// memory there is only where each row stands, some 70 bytes.
class RowFile {
 public:
  /// Which run the fields are of, or what is wrong with them, such as "has no seed".
  using Reader = std::function<Result<RowKey>(const std::vector<std::string>& fields)>;

  /// Opens the file or begins one, and reads every row. A last row that was cut off is removed.
  /// Fails where the file has other columns, a row that is none, or a run twice that differs.
  [[nodiscard]] static Result<RowFile> open(const std::filesystem::path& file,
                                            const std::vector<std::string>& columns,
                                            const Reader& reader);

  [[nodiscard]] bool has(const RowKey& key) const { return at_.contains(key); }
  [[nodiscard]] std::size_t size() const { return at_.size(); }

  /// Appends a row and hands it to the system. Precondition: !has(key). Fails when the disk is
  /// full.
  [[nodiscard]] Result<void> append(const RowKey& key, const std::vector<std::string>& fields);

  /// Takes over the rows of another such file, which may be one that is being written: a last row
  /// without its end is none. Fails where a run is there already with other values; the sentence
  /// names both files.
  [[nodiscard]] Result<void> take_over(const std::filesystem::path& file, const Reader& reader);

  /// Brings the rows into the order of their keys, at once or not at all.
  [[nodiscard]] Result<void> sort();

  /// Every row's fields, in the order of their keys, until `row` fails.
  [[nodiscard]] Result<void> each(
      const std::function<Result<void>(const std::vector<std::string>& fields)>& row) const;

 private:
  RowFile() = default;
  /// Calls `line` with every whole line, its offset and its number, and gives where they end.
  static Result<std::uint64_t> lines(
      const std::filesystem::path& file,
      const std::function<Result<void>(const std::string& line, std::uint64_t offset,
                                       std::size_t number)>& line);
  [[nodiscard]] Result<void> header(const std::filesystem::path& file, const std::string& line,
                                    std::string_view advice) const;
  /// Which run a line after the first is of.
  [[nodiscard]] Result<RowKey> key_of(const std::filesystem::path& file, const std::string& line,
                                      std::size_t number, const Reader& reader) const;
  [[nodiscard]] Error differs(const RowKey& key, const std::string& other,
                              std::size_t number) const;
  [[nodiscard]] std::string line_at(std::uint64_t offset) const;
  /// In the order of keys, with the lines' ends.
  [[nodiscard]] Result<void> each_line(
      const std::function<Result<void>(const std::string& line)>& line) const;
  /// Appends a line with its end, which the system has after flush().
  void add(const RowKey& key, const std::string& line);
  [[nodiscard]] Result<void> flush();

  std::filesystem::path file_;
  std::string header_;
  std::size_t columns_ = 0;
  std::map<RowKey, std::uint64_t> at_;
  std::uint64_t end_ = 0;
  /// From which offset on the rows are those of another file.
  std::vector<std::pair<std::uint64_t, std::string>> sources_;
  std::ofstream out_;
  mutable std::ifstream again_;  ///< the same file, for rows that come twice
};

}  // namespace skein::shards
