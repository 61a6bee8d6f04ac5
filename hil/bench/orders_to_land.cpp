// SPDX-License-Identifier: Apache-2.0
#include "orders_to_land.hpp"

#include <array>
#include <chrono>

#include "skein/groundstation/control_socket.hpp"

namespace skein::hil {
namespace {

constexpr std::array kOrders{"return all", "land all"};
constexpr auto kAnswerWithin = std::chrono::milliseconds{500};
constexpr Duration kAgain = std::chrono::seconds{2};

}  // namespace

std::optional<std::string> OrdersToLand::give(const std::string& control_socket, Instant now) {
  if (next_ == kOrders.size() || now < again_at_) return std::nullopt;
  const std::string order = kOrders.at(next_);
  const auto answer = groundstation::ask(control_socket, order, kAnswerWithin);
  if (answer && answer->done) {
    ++next_;
    return "the bench orders '" + order + "'";
  }
  again_at_ = now + kAgain;
  return "'" + order + "' was refused: " + (answer ? answer->text : answer.error().message);
}

}  // namespace skein::hil
