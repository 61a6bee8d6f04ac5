// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/messages.hpp"

#include <algorithm>
#include <array>

namespace skein::mavlink {
namespace {

template <class... Message>
consteval std::array<MessageInfo, sizeof...(Message)> table_of(std::tuple<Message...>* /*list*/) {
  return {kMessageInfo<Message>...};
}
constexpr auto kTable = table_of(static_cast<Messages*>(nullptr));

static_assert(std::is_sorted(kTable.begin(), kTable.end(),
                             [](const MessageInfo& a, const MessageInfo& b) {
                               return a.id < b.id;
                             }),
              "the list of messages is looked up by halves");

}  // namespace

std::span<const MessageInfo> messages() { return kTable; }

const MessageInfo* find_message(std::uint32_t id) {
  const auto* found =
      std::lower_bound(kTable.begin(), kTable.end(), id,
                       [](const MessageInfo& info, std::uint32_t key) { return info.id < key; });
  return found != kTable.end() && found->id == id ? found : nullptr;
}

}  // namespace skein::mavlink
