// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/host_watch.hpp"

namespace skein::mission {

std::vector<std::string> host_problems(const HostFacts& facts) {
  constexpr std::uint64_t kMega = 1'000'000;
  std::vector<std::string> all;
  if (facts.disk_free_bytes && *facts.disk_free_bytes < kDiskFreeMinBytes) {
    all.push_back(std::to_string(*facts.disk_free_bytes / kMega));
    all.back().append(" MB are left on the disk of its recording");
  }
  if (facts.clock && (!facts.clock->synchronised || facts.clock->error_max > kClockErrorMax)) {
    all.emplace_back("its clock is not synchronised");
  }
  if (facts.network_restarts > 0) {
    all.emplace_back("its network was started again, so far ");
    all.back().append(std::to_string(facts.network_restarts));
    all.back().append(facts.network_restarts == 1 ? " time" : " times");
  }
  return all;
}

}  // namespace skein::mission
