// SPDX-License-Identifier: Apache-2.0
#include "bytes.hpp"

#include <fmt/format.h>

namespace skein::identity {

Result<void> ByteReader::finish() const {
  if (wrong_ != nullptr) return Error{fmt::format("{}: its {} is no good", what_, wrong_)};
  if (!left_.empty()) return Error{fmt::format("{}: something follows it", what_)};
  return {};
}

}  // namespace skein::identity
