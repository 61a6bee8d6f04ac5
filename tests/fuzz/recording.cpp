// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a recording: what can be read is read, in both orders; all else is passed over.
#include "fuzz_input.hpp"
#include "skein/recording/log.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto log = skein::recording::Log::of_bytes({data, size}, "fuzzed");
  if (!log) {
    SKEIN_ASSERT(!log.error().message.empty());
    return 0;
  }
  log->seek(log->begin());
  std::size_t by_time = 0;
  while (log->next()) ++by_time;
  std::size_t written = 0;
  log->for_each_written([&](const skein::recording::Entry& entry) {
    SKEIN_ASSERT(!entry.topic.empty());
    SKEIN_ASSERT(!skein::recording::text_of(entry.content).empty());
    ++written;
    return true;
  });
  SKEIN_ASSERT(by_time == written);
  (void)log->topics();
  return 0;
}
