// SPDX-License-Identifier: Apache-2.0
#include "skein/version/version.hpp"

namespace skein {
namespace {

constexpr const char* kCommit =
#include "commit.inc"
    ;

std::string made() {
  std::string text = SKEIN_VERSION;
  if (*kCommit != '\0') text.append("+").append(kCommit);
  return text;
}

}  // namespace

const std::string& version() {
  static const std::string text = made();
  return text;
}

}  // namespace skein
