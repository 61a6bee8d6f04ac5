// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/row_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>

#include "skein/shards/csv.hpp"

namespace skein::shards {
namespace {

Error bad_line(const std::string& file, std::size_t number, std::string_view what) {
  return Error{fmt::format("{}:{}: {}; remove the line", file, number, what)};
}

}  // namespace

Result<std::uint64_t> RowFile::lines(
    const std::filesystem::path& file,
    const std::function<Result<void>(const std::string& line, std::uint64_t offset,
                                     std::size_t number)>& line) {
  std::ifstream in{file, std::ios::binary};
  if (!in) return Error{file.string() + ": cannot be read"};
  std::string text;
  std::uint64_t offset = 0;
  // What ends without a line's end was cut off.
  for (std::size_t number = 1; std::getline(in, text) && !in.eof(); ++number) {
    if (auto taken = line(text, offset, number); !taken) return taken.error();
    offset += text.size() + 1;
  }
  if (in.bad()) return Error{file.string() + ": cannot be read to its end"};
  return offset;
}

Result<void> RowFile::header(const std::filesystem::path& file, const std::string& line,
                             std::string_view advice) const {
  if (line + "\n" == header_) return {};
  return Error{
      fmt::format("{}:1: has other columns than this program writes; {}", file.string(), advice)};
}

Result<RowKey> RowFile::key_of(const std::filesystem::path& file, const std::string& line,
                               std::size_t number, const Reader& reader) const {
  const auto fields = csv_fields(line);
  if (fields.size() != columns_)
    return bad_line(file.string(), number, "has not one field a column");
  auto key = reader(fields);
  if (!key) return bad_line(file.string(), number, key.error().message);
  return key;
}

Error RowFile::differs(const RowKey& key, const std::string& other, std::size_t number) const {
  const std::uint64_t offset = at_.at(key);
  const auto later =
      std::upper_bound(sources_.begin(), sources_.end(), offset,
                       [](std::uint64_t at, const auto& source) { return at < source.first; });
  const std::string here = later == sources_.begin() ? file_.string() : std::prev(later)->second;
  return Error{fmt::format(
      "{}:{}: the run of seed {} is not what {} says of it:\n  {}\nThe same run has the same "
      "values "
      "on every machine: one of them had another program, scenario or processor's mathematics; "
      "remove the folder that is wrong, and fly its shard again",
      other, number, key.seed, here, line_at(offset))};
}

Result<RowFile> RowFile::open(const std::filesystem::path& file,
                              const std::vector<std::string>& columns, const Reader& reader) {
  RowFile table;
  table.file_ = file;
  table.header_ = csv_line(columns);
  table.columns_ = columns.size();
  if (std::filesystem::exists(file)) {
    const auto row = [&](const std::string& line, std::uint64_t offset,
                         std::size_t number) -> Result<void> {
      if (number == 1) return table.header(file, line, "name another folder with --out");
      const auto key = table.key_of(file, line, number, reader);
      if (!key) return key.error();
      const bool added = table.at_.emplace(*key, offset).second;
      if (!added && table.line_at(table.at_.at(*key)) != line)
        return table.differs(*key, file.string(), number);
      return {};
    };
    const auto end = lines(file, row);
    if (!end) return end.error();
    table.end_ = *end;
    std::error_code error;
    std::filesystem::resize_file(file, table.end_, error);
    if (error) return Error{file.string() + ": cannot be written: " + error.message()};
  }
  table.out_.open(file, std::ios::binary | std::ios::app);
  if (table.end_ == 0) {
    table.out_ << table.header_;
    table.end_ = table.header_.size();
  }
  if (auto written = table.flush(); !written) return written.error();
  return table;
}

void RowFile::add(const RowKey& key, const std::string& line) {
  at_.emplace(key, end_);
  out_ << line;
  end_ += line.size();
}

Result<void> RowFile::flush() {
  out_.flush();
  if (!out_) return not_written(file_.string());
  return {};
}

Result<void> RowFile::append(const RowKey& key, const std::vector<std::string>& fields) {
  add(key, csv_line(fields));
  return flush();
}

Result<void> RowFile::take_over(const std::filesystem::path& file, const Reader& reader) {
  sources_.emplace_back(end_, file.string());
  const auto row = [&](const std::string& line, std::uint64_t, std::size_t number) -> Result<void> {
    if (number == 1) return header(file, line, "fly its shard again in another folder");
    const auto key = key_of(file, line, number, reader);
    if (!key) return key.error();
    if (!has(*key)) {
      add(*key, line + "\n");
      return {};
    }
    if (auto flushed = flush(); !flushed) return flushed;  // to be read
    return line_at(at_.at(*key)) == line ? Result<void>{} : differs(*key, file.string(), number);
  };
  const auto end = lines(file, row);
  if (auto flushed = flush(); !flushed) return flushed;
  return end ? Result<void>{} : end.error();
}

std::string RowFile::line_at(std::uint64_t offset) const {
  if (!again_.is_open()) again_.open(file_, std::ios::binary);
  again_.clear();
  again_.seekg(static_cast<std::streamoff>(offset));
  std::string line;
  std::getline(again_, line);
  return line;
}

Result<void> RowFile::each_line(
    const std::function<Result<void>(const std::string& line)>& line) const {
  std::ifstream in{file_, std::ios::binary};
  std::string text;
  std::uint64_t at = 0;
  for (const auto& [key, offset] : at_) {
    if (offset != at) in.seekg(static_cast<std::streamoff>(offset));
    if (!std::getline(in, text)) return Error{file_.string() + ": cannot be read"};
    at = offset + text.size() + 1;
    if (auto taken = line(text); !taken) return taken;
  }
  return {};
}

Result<void> RowFile::each(
    const std::function<Result<void>(const std::vector<std::string>& fields)>& row) const {
  return each_line([&](const std::string& line) { return row(csv_fields(line)); });
}

Result<void> RowFile::sort() {
  const auto before = [](const auto& one, const auto& next) { return one.second > next.second; };
  if (std::adjacent_find(at_.begin(), at_.end(), before) == at_.end()) return {};
  auto sorted = file_;
  sorted += ".new";
  std::vector<std::uint64_t> offsets;
  std::uint64_t end = header_.size();
  {
    std::ofstream out{sorted, std::ios::binary};
    out << header_;
    auto copied = each_line([&](const std::string& line) -> Result<void> {
      out << line << '\n';
      offsets.push_back(end);
      end += line.size() + 1;
      return {};
    });
    if (!copied) return copied;
    out.flush();
    if (!out) return not_written(sorted.string());
  }
  std::error_code error;
  std::filesystem::rename(sorted, file_, error);
  if (error) return Error{file_.string() + ": cannot be written: " + error.message()};
  again_.close();
  out_.close();
  out_.open(file_, std::ios::binary | std::ios::app);
  if (!out_) return not_written(file_.string());
  auto offset = offsets.begin();
  for (auto& [key, at] : at_) at = *offset++;
  end_ = end;
  sources_.clear();
  return {};
}

}  // namespace skein::shards
