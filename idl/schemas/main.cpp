// SPDX-License-Identifier: Apache-2.0
//
// skein_schema_generator OUTPUT.cpp FILE.idl...: each file after those that it includes.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "ros2msg.hpp"

namespace {

skein::Result<std::string> source_of(const std::vector<std::string>& files) {
  skein::schemas::Definitions definitions;
  for (const std::string& name : files) {
    std::ifstream file{name};
    if (!file) return skein::Error{"cannot read " + name};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    if (const auto parsed = skein::schemas::parse(text, name, definitions); !parsed) {
      return parsed.error();
    }
  }
  const auto schemas = skein::schemas::ros2msg_schemas(definitions);
  if (!schemas) return schemas.error();
  return skein::schemas::cpp_source(*schemas);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments{argv + 1, argv + argc};
  if (arguments.size() < 2) {
    std::cerr << "skein_schema_generator OUTPUT.cpp FILE.idl...\n";
    return 2;
  }
  const auto source = source_of({arguments.begin() + 1, arguments.end()});
  if (!source) {
    std::cerr << source.error().message << '\n';
    return 1;
  }
  std::ofstream out{arguments.front()};
  out << *source;
  return out.flush() ? 0 : 1;
}
