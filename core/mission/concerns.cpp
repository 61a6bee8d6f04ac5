// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/concerns.hpp"

#include <algorithm>
#include <variant>

#include "skein/base/overloaded.hpp"

namespace skein::mission {
namespace {

/// The members of a coalition, other leaders of its site and those who look for sites (SiteBook)
/// go by what is done.
bool says_what_is_over(const coalition::MemberStatus& status) {
  return std::ranges::any_of(status.tasks, [](const coalition::TaskStatus& task) {
    return task.state == coalition::TaskState::done || task.state == coalition::TaskState::unknown;
  });
}

bool concerns(const coalition::Message& message, VehicleId vehicle) {
  return std::visit(
      Overloaded{
          [&](const coalition::Bid& m) { return m.round.coalition.leader == vehicle; },
          [&](const coalition::Confirmation& m) { return m.round.coalition.leader == vehicle; },
          [&](const coalition::MemberStatus& m) {
            return m.round.coalition.leader == vehicle || says_what_is_over(m);
          },
          [&](const coalition::Allegiance& m) {
            return m.coalition.leader == vehicle || m.follows == vehicle;
          },
          [](const auto&) { return true; }},
      message);
}

}  // namespace

bool concerns(const Message& message, VehicleId vehicle) {
  const auto* joint = std::get_if<coalition::Message>(&message);
  return joint == nullptr || concerns(*joint, vehicle);
}

}  // namespace skein::mission
