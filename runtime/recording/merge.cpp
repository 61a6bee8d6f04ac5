// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/merge.hpp"

#include <set>
#include <utility>
#include <vector>

#include "channel_book.hpp"
#include "node_files.hpp"
#include "records.hpp"
#include "skein/mcap/cursor.hpp"

namespace skein::recording {

Result<std::uint64_t> merge_run(const std::filesystem::path& folder) {
  const auto folders = node_folders(folder);
  if (!folders) return folders.error();
  if (folders->empty()) return Error{folder.string() + " has no recordings"};
  std::vector<NodeFile> files;
  for (const auto& node : *folders) {
    auto opened = open_node(node);
    if (!opened) return opened.error();
    for (NodeFile& file : *opened) files.push_back(std::move(file));
  }

  mcap::WriterOptions options;
  options.profile = kProfile;
  options.library = "skein " + files.front().sessions.front().version;
  auto merged = mcap::Writer::open(folder / kRunFileName, options);
  if (!merged) return merged.error();
  std::vector<mcap::Reader*> readers;
  std::set<std::pair<VehicleId, InstanceId>> told;
  for (NodeFile& file : files) {
    readers.push_back(&file.reader);
    const Session& session = file.sessions.front();
    if (told.emplace(session.node, session.instance).second) merged->add(metadata_of(session));
  }

  const auto is_own = [&files](std::size_t file, std::uint16_t channel) {
    const auto known = files[file].channels.find(channel);
    return known != files[file].channels.end() &&
           known->second.sender == files[file].sessions.front().node;
  };
  mcap::Cursor cursor{readers, is_own};
  ChannelBook channels;
  std::uint64_t records = 0;
  while (auto item = cursor.next()) {
    const KnownChannel& from = files[item->file].channels.at(item->message.channel);
    const auto whose = vehicle_of_event(*from.kind, item->message.data);
    if (whose && *whose != from.sender) continue;  // a copy of what that node noted itself
    item->message.channel = channels.channel(*merged, from.sender, *from.kind, from.schema);
    merged->write(item->message);
    ++records;
  }
  if (const auto closed = merged->close(); !closed) return closed.error();
  return records;
}

}  // namespace skein::recording
