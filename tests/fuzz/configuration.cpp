// SPDX-License-Identifier: Apache-2.0
//
// Any text as a configuration file; its first letter says of which kind. What is refused says why;
// what is accepted is the same after writing and reading it.
#include <string>
#include <string_view>

#include "fuzz_input.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/shape_file.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::fuzz {
namespace {

template <class Config>
void read_and_write(Result<Config> (*parse)(std::string_view, const std::string&),
                    std::string_view text) {
  const auto config = parse(text, "fuzzed");
  if (!config) {
    SKEIN_ASSERT(!config.error().message.empty());
    return;
  }
  const std::string written = to_yaml(*config);
  const auto back = parse(written, "written");
  SKEIN_ASSERT(back.ok());
  SKEIN_ASSERT(to_yaml(*back) == written);
}

void run(std::string_view text) {
  if (text.empty()) return;
  const char kind = text.front();
  text.remove_prefix(1);
  switch (kind) {
    case 'v':
      return read_and_write(&configuration::parse_vehicle_config, text);
    case 'g':
      return read_and_write(&configuration::parse_ground_config, text);
    case 'e':
      return read_and_write(&configuration::parse_experiment, text);
    case 'f':
      return read_and_write(&configuration::parse_shape, text);
    default: {
      read_and_write(&configuration::parse_scenario, text);
      const auto scenario = configuration::parse_scenario(text, "fuzzed");
      if (scenario) (void)configuration::check(*scenario);
    }
  }
}

}  // namespace
}  // namespace skein::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text{data, data + size};
  skein::fuzz::run(text);
  return 0;
}
