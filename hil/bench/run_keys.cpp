// SPDX-License-Identifier: Apache-2.0
#include "run_keys.hpp"

#include <chrono>
#include <span>
#include <system_error>

#include "skein/identity/team.hpp"

namespace skein::hil {
namespace {

std::filesystem::path folder_of(const std::filesystem::path& run_folder) {
  return run_folder / "keys";
}

}  // namespace

Result<void> make_run_keys(const std::filesystem::path& run_folder,
                           const std::vector<VehicleId>& nodes) {
  const auto now = std::chrono::duration_cast<std::chrono::seconds>(
      std::chrono::system_clock::now().time_since_epoch());
  remove_run_keys(run_folder);  // of a run that died
  return identity::make_team(folder_of(run_folder), std::span{nodes}.subspan(1), now.count());
}

void use_run_keys(configuration::Deployment& deployment, const std::filesystem::path& run_folder,
                  const std::vector<VehicleId>& nodes) {
  const auto keys = std::filesystem::absolute(folder_of(run_folder));
  for (const VehicleId node : nodes) {
    deployment.keys[node] = identity::node_folder(keys, node).string();
  }
  deployment.op = {identity::kBenchOperator,
                   deployment.keys.at(kGroundStation) + "/" + identity::kBenchPasswordFile};
}

void remove_run_keys(const std::filesystem::path& run_folder) {
  std::error_code ignored;
  std::filesystem::remove_all(folder_of(run_folder), ignored);
}

}  // namespace skein::hil
