// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/load_book.hpp"

#include <fstream>
#include <system_error>

namespace skein::onboard {

LoadBook::LoadBook(const std::filesystem::path& folder, std::int64_t epoch_unix_ns)
    : file_{folder.empty() ? std::filesystem::path{} : folder / "loads-used"},
      epoch_unix_ns_{epoch_unix_ns} {
  std::int64_t epoch = 0;
  std::size_t used = 0;
  if (std::ifstream{file_} >> epoch >> used && epoch == epoch_unix_ns_) used_ = used;
}

Result<void> LoadBook::use() {
  ++used_;
  if (file_.empty()) return {};
  // Beside it first: who is killed meanwhile leaves the one or the other.
  std::filesystem::path beside = file_;
  beside += ".new";
  std::ofstream out{beside};
  out << epoch_unix_ns_ << ' ' << used_ << '\n';
  out.close();
  if (!out) return Error{beside.string() + ": cannot be written"};
  std::error_code failed;
  std::filesystem::rename(beside, file_, failed);
  if (failed) return Error{file_.string() + ": cannot be written: " + failed.message()};
  return {};
}

}  // namespace skein::onboard
