// SPDX-License-Identifier: Apache-2.0
//
// Any text as what a client of the ground station says; its first letter says of which kind. What
// is accepted has what its reader relies on.
#include <string>
#include <string_view>

#include "foxglove.hpp"
#include "fuzz_input.hpp"
#include "gate.hpp"
#include "page_text.hpp"
#include "skein/console/users.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/groundstation/replay_process.hpp"

namespace skein::fuzz {
namespace {

void run(std::string_view text) {
  if (text.empty()) return;
  const char kind = text.front();
  text.remove_prefix(1);
  const std::string all{text};
  switch (kind) {
    case 'p':
      if (const auto said = console::parse_page_text(all)) {
        if (const auto* line = std::get_if<console::LineText>(&*said)) {
          SKEIN_ASSERT(line->line.empty() || line->order.empty());
          if (const auto order = groundstation::read_order(line->order)) {
            static_cast<void>(groundstation::line_of(*order));
          }
        }
      }
      return;
    case 'f': {
      console::FoxgloveSession session;
      static_cast<void>(session.on_text(all));
      const std::uint8_t byte = 7;
      if (const auto record = session.record(1, 2, {&byte, 1})) SKEIN_ASSERT(record->size() == 14);
      return;
    }
    case 'l':
      if (const auto input = groundstation::parse_input(text); !input) {
        SKEIN_ASSERT(!input.error().message.empty());
      }
      if (const auto order = groundstation::parse_replay_order(all)) {
        SKEIN_ASSERT(order->value == order->value);  // a number
      }
      return;
    case 'u':
      if (const auto users = console::Users::parse(text, "fuzzed"); !users) {
        SKEIN_ASSERT(!users.error().message.empty());
      }
      return;
    case 'c': {
      const console::Gate gate{false, "", false};
      const auto half = text.size() / 2;
      if (gate.is_own_origin(text.substr(0, half), text.substr(half)) && half > 0) {
        SKEIN_ASSERT(text.substr(0, 7) == "http://");
      }
      static_cast<void>(gate.is_own_host(text));
      static_cast<void>(gate.identify(text, console::Gate::Time{}));
      return;
    }
    default:
      return;
  }
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
