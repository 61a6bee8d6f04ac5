// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/checks/run_record.hpp"

namespace skein::report {

enum class Doing : std::uint8_t {
  searching,
  leading,
  bidding,
  flying,
  surveying,
  delivering,
  assessing,
  count
};

struct Span {
  Doing doing = Doing::searching;
  Instant from{};
  Instant until{};
  std::optional<SiteId> site;
};

/// What one vehicle did, as its events tell. Later spans lie over earlier ones.
struct Story {
  VehicleId vehicle;
  std::vector<Span> spans;
};

/// One a recording with a track, in its order.
[[nodiscard]] std::vector<Story> stories(const checks::RunRecord& record);

/// The site that the vehicle worked for at a time.
[[nodiscard]] std::optional<SiteId> site_at(const Story& story, Instant time);

/// The place of a site among the record's, from 1: the number of its colour. 0 for none.
[[nodiscard]] std::size_t colour_of(const checks::RunRecord& record, std::optional<SiteId> site);
/// That of a vehicle, where vehicles are told apart and not sites. From 1.
[[nodiscard]] std::size_t colour_of(VehicleId vehicle);

}  // namespace skein::report
