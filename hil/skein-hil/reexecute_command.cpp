// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "skein/hil/reexecution.hpp"
#include "skein/recording/recording.hpp"

namespace skein::hil {
namespace {

/// The folders of vehicles in that of a run, by name; a vehicle's own stands for itself.
std::vector<std::filesystem::path> vehicle_folders(const std::filesystem::path& folder) {
  std::error_code failure;
  if (std::filesystem::exists(folder / recording::kFileName, failure)) return {folder};
  std::vector<std::filesystem::path> folders;
  for (std::filesystem::directory_iterator it{folder, failure}, end; !failure && it != end;
       it.increment(failure)) {
    if (it->path().filename().string().starts_with("vehicle-") && it->is_directory()) {
      folders.push_back(it->path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace

int reexecute(const ReexecuteArguments& arguments) {
  auto folders =
      arguments.vehicle
          ? std::vector{arguments.run / recording::folder_name(VehicleId{*arguments.vehicle})}
          : vehicle_folders(arguments.run);
  if (folders.empty()) {
    fmt::print(stderr, "{}: no vehicle has a folder there; name the folder of a run\n",
               arguments.run.string());
    return kExitBadInput;
  }
  bool same = true;
  for (const auto& folder : folders) {
    const auto result = reexecute(folder);
    if (!result) {
      fmt::print(stderr, "{}\n", result.error().message);
      return kExitBadInput;
    }
    fmt::print("vehicle {}: {} inputs, {} allocations; {} plans and {} messages",
               result->vehicle.value, result->inputs, result->allocations, result->plans,
               result->messages);
    if (result->difference.empty()) {
      fmt::print(" are the same, until {:.3f} s\n", to_seconds(result->until));
    } else {
      same = false;
      fmt::print(" compared; the first difference is at {:.9f} s:\n{}\n",
                 to_seconds(result->differs_at), result->difference);
    }
    if (result->gap) {
      fmt::print("  after {:.1f} s the recording has a gap: not compared\n",
                 to_seconds(*result->gap));
    }
    if (result->damaged > 0) {
      fmt::print("  {} parts of the recording are damaged and left out\n", result->damaged);
    }
    if (!result->complete) {
      fmt::print("  the recording was not closed by its process: its end may be missing\n");
    }
    std::fflush(stdout);
  }
  return same ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
