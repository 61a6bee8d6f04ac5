// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"

/// What a person must know of a request for authorisation besides what it says: who of those that
/// it names is silent, late or low on range, what it lacks and why, and what has changed since the
/// request before it.
namespace skein::console {

struct Mark {
  bool alarm = false;  ///< else a warning
  std::string text;
};

struct AuthorisationCard {
  std::vector<std::vector<Mark>> deliveries;  ///< of each, in the request's order
  std::vector<Mark> leader;
  struct Missing {
    TaskId task;
    double bearing_rad = 0.0;
    std::string why;
  };
  std::vector<Missing> missing;  ///< that the site wants, and nobody has flown or flies
  struct DidNotBid {
    VehicleId vehicle;
    std::string why;
  };
  std::vector<DidNotBid> did_not_bid;  ///< of those that can deliver; where something is missing
  std::vector<std::string> changes;    ///< since the site's request before; none: it is the first
  std::vector<VehicleId> silent = {};  ///< it is granted only by who passes over their silence
};

[[nodiscard]] AuthorisationCard card_of(const mission::AuthorisationRequest& request,
                                        const Picture& picture, const mission::Fleet& fleet,
                                        Instant now);

/// Of a delivery that was granted: it has not begun, as far as is known.
[[nodiscard]] bool may_be_before_gate(const mission::Delivery& delivery, const Picture& picture,
                                      Instant now);

}  // namespace skein::console
