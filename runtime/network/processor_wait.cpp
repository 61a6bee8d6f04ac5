// SPDX-License-Identifier: Apache-2.0
#include "processor_wait.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

namespace skein::network {

bool is_machine_overloaded() {
  struct sysinfo now {};
  cpu_set_t processors;
  if (sysinfo(&now) != 0 || sched_getaffinity(0, sizeof processors, &processors) != 0) return false;
  return now.loads[0] >> SI_LOAD_SHIFT >= 2 * static_cast<unsigned long>(CPU_COUNT(&processors));
}

ProcessorWait::ProcessorWait() : file_{open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)} {}

ProcessorWait::~ProcessorWait() {
  if (file_ >= 0) close(file_);
}

Duration ProcessorWait::since_last() {
  std::array<char, 96> text{};  // "computed waited slices", in ns
  const ssize_t size = pread(file_, text.data(), text.size(), 0);
  if (size <= 0) return {};
  const std::string_view all{text.data(), static_cast<std::size_t>(size)};
  const auto second = std::min(all.find(' '), all.size() - 1) + 1;
  std::int64_t waited = 0;
  (void)std::from_chars(all.data() + second, all.data() + all.size(), waited);
  return Duration{waited} - std::exchange(before_, Duration{waited});
}

}  // namespace skein::network
