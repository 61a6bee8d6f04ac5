// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

namespace skein {

/// What a vehicle can do at a site. There are no other kinds (docs/scope.md).
enum class TaskKind : std::uint8_t { survey, deliver, assess, count };
[[nodiscard]] std::string_view to_string(TaskKind kind);

/// A set of task kinds.
class Capabilities {
 public:
  constexpr Capabilities() = default;
  [[nodiscard]] constexpr bool has(TaskKind kind) const { return (bits_ & bit(kind)) != 0; }
  constexpr Capabilities& add(TaskKind kind) {
    bits_ = static_cast<std::uint8_t>(bits_ | bit(kind));
    return *this;
  }
  [[nodiscard]] constexpr std::uint8_t bits() const { return bits_; }
  [[nodiscard]] static constexpr Capabilities from_bits(std::uint8_t bits) {
    Capabilities c;
    c.bits_ = bits & 0x7U;
    return c;
  }
  friend constexpr bool operator==(Capabilities, Capabilities) = default;

 private:
  [[nodiscard]] static constexpr std::uint8_t bit(TaskKind kind) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(kind));
  }
  std::uint8_t bits_ = 0;
};

/// One task: the index counts within the site's requirement of that kind (Site::deliveries[index]).
struct TaskId {
  SiteId site;
  TaskKind kind = TaskKind::survey;
  std::uint8_t index = 0;
  friend constexpr auto operator<=>(const TaskId&, const TaskId&) = default;
};
/// "site 1 deliver 3"
[[nodiscard]] std::string to_string(const TaskId& task);

/// A task given to a vehicle. `time` is when the task's requirement refers to: for a delivery the
/// moment over the site, for survey and assess the start of the arc.
struct TaskAssignment {
  TaskId task;
  VehicleId vehicle;
  Instant time{};
};

}  // namespace skein
