// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as an MCAP file: no chunk is read that is not whole, and a cursor gives the messages in
// the order of time.
#include "fuzz_input.hpp"
#include "skein/mcap/cursor.hpp"
#include "skein/mcap/reader.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto reader = skein::mcap::Reader::of_bytes({data, size}, "fuzzed");
  if (!reader) return 0;
  std::size_t messages = 0;
  reader->for_each([&](const skein::mcap::Message&) {
    ++messages;
    return true;
  });
  skein::mcap::Cursor cursor{{&*reader}};
  std::size_t by_time = 0;
  while (cursor.next()) ++by_time;
  SKEIN_ASSERT(by_time == messages);
  return 0;
}
