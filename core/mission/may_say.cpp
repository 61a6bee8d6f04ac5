// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/may_say.hpp"

#include <variant>

namespace skein::mission {
namespace {

struct MaySay {
  VehicleId sender;

  [[nodiscard]] bool ground() const { return sender == kGroundStation; }
  [[nodiscard]] bool leads(const coalition::Round& round) const {
    return round.coalition.leader == sender;
  }

  bool operator()(const coalition::Message& m) const { return std::visit(*this, m); }
  bool operator()(const coalition::Announcement& m) const { return leads(m.round) || ground(); }
  bool operator()(const coalition::Bid& m) const { return m.bidder == sender; }
  bool operator()(const coalition::Award& m) const { return leads(m.round); }
  bool operator()(const coalition::Confirmation& m) const { return m.member == sender; }
  bool operator()(const coalition::Cancel& m) const { return leads(m.round); }
  bool operator()(const coalition::LeaseRenewal& m) const { return leads(m.round) || ground(); }
  bool operator()(const coalition::MemberStatus& m) const { return m.member == sender; }
  bool operator()(const coalition::LeadershipClaim& m) const { return m.claimant == sender; }
  bool operator()(const coalition::Allegiance& m) const { return m.elector == sender; }

  bool operator()(const Telemetry& m) const { return m.vehicle == sender; }
  bool operator()(const AuthorisationRequest& m) const { return leads(m.round); }
  bool operator()(const Authorisation&) const { return ground(); }
  bool operator()(const MissionEvent& m) const { return m.vehicle == sender; }
  bool operator()(const Command&) const { return ground(); }
  bool operator()(const SiteReport&) const { return true; }
  bool operator()(const HazardReport&) const { return true; }
  bool operator()(const formation::Change&) const { return ground(); }
  bool operator()(const FormationStatus& m) const { return m.vehicle == sender; }
  bool operator()(const PlanReport& m) const { return m.vehicle == sender; }
  bool operator()(const Health& m) const { return m.vehicle == sender; }
};

}  // namespace

bool may_say(const Message& message, VehicleId sender) {
  return std::visit(MaySay{sender}, message);
}

}  // namespace skein::mission
