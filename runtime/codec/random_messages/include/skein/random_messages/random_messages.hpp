// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "skein/base/random.hpp"
#include "skein/codec/describe.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

/// Of mission::Message, each member of a topic's union for itself.
template <class T>
struct KindsOf {
  static constexpr std::size_t kCount = 1;
};
template <class... Members>
struct KindsOf<std::variant<Members...>> {
  static constexpr std::size_t kCount = (KindsOf<Members>::kCount + ...);
};
template <Union T>
struct KindsOf<T> : KindsOf<VariantOf<T>> {};
inline constexpr std::size_t kMessageKinds = KindsOf<mission::Message>::kCount;

/// "lease_renewal"
[[nodiscard]] std::string name_of_kind(std::size_t kind);

/// A message of that kind (modulo their number) with every field random within its limits, for
/// tests.
[[nodiscard]] mission::Message random_message(std::size_t kind, Random& random);

}  // namespace skein::codec
