// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "skein/shards/csv.hpp"

namespace skein::shards {
namespace {

constexpr const char* kFile = "series.txt";

/// A line a value; joined() keeps a value on its line.
std::string written(const Series& series) {
  std::string text;
  const auto line = [&](std::string_view key, const std::string& value) {
    text += fmt::format("{}: {}\n", key, joined({value}));
  };
  line("kind", series.kind);
  line("program", series.program);
  line("file", series.file);
  line("faults", series.faults);
  if (!series.plan.empty()) line("plan", series.plan);
  line("first_seed", std::to_string(series.first_seed));
  line("runs", std::to_string(series.runs));
  if (!series.shard.whole()) line("shard", to_string(series.shard));
  if (series.separation_m > 0.0) line("separation_m", fmt::format("{}", series.separation_m));
  return text;
}

std::optional<Series> parse(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    const auto colon = line.find(": ");
    if (colon == std::string::npos) return {};
    values[line.substr(0, colon)] = parted(line.substr(colon + 2)).front();
  }
  Series series;
  const auto first_seed = number_of<std::uint64_t>(values["first_seed"]);
  const auto runs = number_of<std::size_t>(values["runs"]);
  const auto shard = parse_shard(values.contains("shard") ? values["shard"] : "1/1");
  const auto separation =
      values.contains("separation_m") ? number_of<double>(values["separation_m"]) : 0.0;
  if (!first_seed || !runs || !shard || !separation || values["kind"].empty()) return {};
  series.kind = values["kind"];
  series.program = values["program"];
  series.file = values["file"];
  series.faults = values["faults"];
  series.plan = values["plan"];
  series.first_seed = *first_seed;
  series.runs = *runs;
  series.shard = *shard;
  series.separation_m = *separation;
  return series;
}

/// One program at a time: with a file system that cannot lock, nobody is refused.
Result<int> lock(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor);
    return Error{folder.string() +
                 ": another program writes runs into it; let it end, or name another folder with "
                 "--out"};
  }
  return descriptor;
}

/// The whole may take up the folder of a shard, and a shard that of the whole.
Result<void> same_shard(const Shard& shard, const Shard& before,
                        const std::filesystem::path& folder) {
  if (shard.whole() || before.whole() || shard == before) return {};
  return Error{
      fmt::format("{}: its runs are of shard {}, and this command's of {}; name a folder for "
                  "each with --out",
                  folder.string(), to_string(before), to_string(shard))};
}

}  // namespace

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

Result<void> put_text(const std::filesystem::path& file, const std::string& text) {
  auto fresh = file;
  fresh += ".new";
  {
    std::ofstream out{fresh, std::ios::binary};
    out << text << std::flush;
    if (!out) return not_written(file.string());
  }
  std::error_code error;
  std::filesystem::rename(fresh, file, error);
  if (error) return Error{file.string() + ": cannot be written: " + error.message()};
  return {};
}

Error has_changed(const std::filesystem::path& file, std::string_view what) {
  return Error{
      fmt::format("{}: the {} has changed since the runs in this folder were flown; name "
                  "another folder with --out, or remove this one to begin anew",
                  file.string(), what)};
}

Result<void> keep_text(const std::filesystem::path& file, const std::string& text,
                       std::string_view what) {
  if (!std::filesystem::exists(file)) return put_text(file, text);
  if (text_of(file) == text) return {};
  return has_changed(file, what);
}

std::string options_of(const Series& series) {
  std::string options;
  if (series.faults != "none") options += " --faults " + series.faults;
  if (!series.plan.empty()) options += " --routes " + series.plan;
  return options;
}

Result<void> same_series(const Series& series, const std::string& here, const Series& other,
                         const std::string& there) {
  const auto same = [&](std::string_view what, const std::string& one,
                        const std::string& two) -> Result<void> {
    if (one == two) return {};
    return Error{
        fmt::format("{}: its runs are of the {} {}, and those of {} of {}; name another "
                    "folder with --out, or remove the one that is wrong",
                    there, what, two, here, one)};
  };
  if (auto kind = same("kind", series.kind, other.kind); !kind) return kind;
  if (auto program = same("program", series.program, other.program); !program) return program;
  if (auto faults = same("faults", series.faults, other.faults); !faults) return faults;
  // Which one, its folder's scenario tells.
  const auto planned = [](const Series& s) { return s.plan.empty() ? "none" : "a plan"; };
  if (auto plan = same("plan (--routes)", planned(series), planned(other)); !plan) return plan;
  return same("first seed", std::to_string(series.first_seed), std::to_string(other.first_seed));
}

Result<Series> read_series(const std::filesystem::path& folder) {
  const auto file = folder / kFile;
  if (!std::filesystem::exists(file)) {
    return Error{
        fmt::format("{}: there is none, so this is no folder of `simulate --out` or "
                    "`sweep`; of an older release's sweep, let it go on once",
                    file.string())};
  }
  const auto series = parse(text_of(file));
  if (!series) return Error{file.string() + ": is not what this program writes"};
  return *series;
}

Result<RunFolder> RunFolder::open(const std::filesystem::path& folder, const Series& series) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{folder.string() + ": cannot be made: " + error.message() +
                 "; name another folder with --out"};
  }
  const auto locked = lock(folder);
  if (!locked) return locked.error();
  RunFolder opened{*locked};
  if (std::filesystem::exists(folder / kFile)) {
    const auto before = read_series(folder);
    if (!before) return before.error();
    if (auto same = same_series(series, "this command", *before, folder.string()); !same)
      return same.error();
    if (auto same = same_shard(series.shard, before->shard, folder); !same) return same.error();
  }
  return opened;
}

Result<void> keep_series(const std::filesystem::path& folder, const Series& series) {
  return put_text(folder / kFile, written(series));
}

RunFolder::RunFolder(RunFolder&& other) noexcept : lock_{std::exchange(other.lock_, -1)} {}
RunFolder& RunFolder::operator=(RunFolder&& other) noexcept {
  std::swap(lock_, other.lock_);
  return *this;
}
RunFolder::~RunFolder() {
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace skein::shards
