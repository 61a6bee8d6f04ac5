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

namespace {

bool is_there(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

}  // namespace

Result<std::vector<NodeFile>> open_node(const std::filesystem::path& folder) {
  auto newest = open_file(folder / kFileName);
  if (!newest) return newest.error();
  const InstanceId instance = newest->sessions.front().instance;
  std::vector<NodeFile> files;
  files.push_back(std::move(*newest));
  for (int age = 1; is_there(folder / older_file_name(age)); ++age) {
    // That of an earlier process is not this one's, whatever state it is in.
    auto older = open_file(folder / older_file_name(age));
    if (!older || older->sessions.front().instance != instance) break;
    files.push_back(std::move(*older));
  }
  std::ranges::reverse(files);
  return files;
}

std::vector<NodeFile> open_mission(const std::filesystem::path& folder, VehicleId node,
                                   std::optional<std::int64_t> epoch_unix_ns) {
  std::vector<NodeFile> files;
  const auto take = [&](const std::filesystem::path& path) {
    auto file = open_file(path);
    if (!file) return;
    const Session& session = file->sessions.front();
    if (session.node == node &&
        session.epoch_unix_ns == epoch_unix_ns.value_or(session.epoch_unix_ns)) {
      files.push_back(std::move(*file));
    }
  };
  take(folder / kFileName);
  for (int age = 1; is_there(folder / older_file_name(age)); ++age)
    take(folder / older_file_name(age));
  std::ranges::reverse(files);
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
