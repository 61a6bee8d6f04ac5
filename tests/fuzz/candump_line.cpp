// SPDX-License-Identifier: Apache-2.0
//
// Any line as one of a candump log. What is read must be the same after writing and reading it.
#include <string>

#include "fuzz_input.hpp"
#include "skein/can/candump.hpp"

namespace skein::fuzz {
namespace {

void run(const std::string& line) {
  const auto entry = can::parse_candump(line);
  if (!entry) {
    SKEIN_ASSERT(!entry.error().message.empty());
    return;
  }
  SKEIN_ASSERT(can::is_valid(entry->frame));
  const auto back = can::parse_candump(can::to_candump(entry->interface, entry->frame));
  SKEIN_ASSERT(back.ok());
  SKEIN_ASSERT(back->interface == entry->interface);
  SKEIN_ASSERT(can::same_content(back->frame, entry->frame));
  using std::chrono::microseconds;
  SKEIN_ASSERT(std::chrono::duration_cast<microseconds>(back->frame.timestamp) ==
               std::chrono::duration_cast<microseconds>(entry->frame.timestamp));
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, data + size});
  return 0;
}
