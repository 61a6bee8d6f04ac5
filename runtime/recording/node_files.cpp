// SPDX-License-Identifier: Apache-2.0
#include "node_files.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace skein::recording {

Result<NodeFile> known_file(mcap::Reader reader) {
  NodeFile file{std::move(reader), {}, {}};
  for (const auto& metadata : file.reader.metadata()) {
    if (auto session = session_of(metadata)) file.sessions.push_back(std::move(*session));
  }
  if (file.sessions.empty()) {
    return Error{file.reader.name() + " is no recording of Skein: it does not say of which node"};
  }
  for (const auto& [number, channel] : file.reader.channels()) {
    const auto known = known_channel(file.reader, channel);
    if (!known) return known.error();
    if (*known) file.channels.emplace(number, **known);
  }
  return file;
}

Result<NodeFile> open_file(const std::filesystem::path& path) {
  auto reader = mcap::Reader::open(path);
  if (!reader) return reader.error();
  return known_file(std::move(*reader));
}

Result<std::vector<NodeFile>> open_node(const std::filesystem::path& folder) {
  auto newest = open_file(folder / kFileName);
  if (!newest) return newest.error();
  std::vector<NodeFile> files;
  std::error_code none;
  if (std::filesystem::exists(folder / kOlderFileName, none)) {
    // That of an earlier process is not this one's, whatever state it is in.
    auto older = open_file(folder / kOlderFileName);
    if (older && older->sessions.front().instance == newest->sessions.front().instance) {
      files.push_back(std::move(*older));
    }
  }
  files.push_back(std::move(*newest));
  return files;
}

Result<std::vector<std::filesystem::path>> node_folders(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> folders;
  std::error_code failure;
  for (std::filesystem::directory_iterator it{run, failure}, end; !failure && it != end;
       it.increment(failure)) {
    std::error_code none;
    if (std::filesystem::exists(it->path() / kFileName, none)) folders.push_back(it->path());
  }
  if (failure) return Error{"cannot read " + run.string() + ": " + failure.message()};
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace skein::recording
