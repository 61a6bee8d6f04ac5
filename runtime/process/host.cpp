// SPDX-License-Identifier: Apache-2.0
#include "skein/process/host.hpp"

#include <sys/timex.h>

#include <system_error>

namespace skein::process {

std::optional<ClockState> clock_state() {
  timex now{};
  now.modes = 0;  // looks only, which asks for no right
  const int state = ::adjtimex(&now);
  if (state < 0) return std::nullopt;
  return ClockState{state != TIME_ERROR && (now.status & STA_UNSYNC) == 0,
                    std::chrono::microseconds{now.maxerror}};
}

std::optional<std::uint64_t> free_bytes(const std::filesystem::path& folder) {
  std::error_code failed;
  const auto space = std::filesystem::space(folder, failed);
  if (failed) return std::nullopt;
  return space.available;
}

std::uint64_t bytes_in(const std::filesystem::path& folder) {
  std::uint64_t sum = 0;
  std::error_code failed;
  for (std::filesystem::directory_iterator file{folder, failed}, end; !failed && file != end;
       file.increment(failed)) {
    std::error_code gone;
    const auto size = file->is_regular_file(gone) ? file->file_size(gone) : 0;
    if (!gone) sum += size;
  }
  return sum;
}

}  // namespace skein::process
