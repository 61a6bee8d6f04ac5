// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/proposals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/agencies/cot_event.hpp"
#include "skein/mission/messages.hpp"
#include "skein/ros2/cdr.hpp"

namespace skein::ros2 {
namespace {

constexpr std::int64_t kStale_ns = 3600LL * 1'000'000'000;

// The numbers of the .msg file are those of the mission's own messages.
using Proposal = skein_msgs::SiteProposal;
using mission::IncidentKind;
static_assert(Proposal::FIRE == static_cast<int>(IncidentKind::fire));
static_assert(Proposal::SMOKE == static_cast<int>(IncidentKind::smoke));
static_assert(Proposal::FLOOD == static_cast<int>(IncidentKind::flood));
static_assert(Proposal::SPILL == static_cast<int>(IncidentKind::spill));
static_assert(Proposal::LANDSLIDE == static_cast<int>(IncidentKind::landslide));
static_assert(Proposal::DAMAGE == static_cast<int>(IncidentKind::damage));
static_assert(Proposal::DAMAGE + 1 == static_cast<int>(IncidentKind::count));

std::string plain(const std::string& text) {
  std::string made = text.substr(0, kProposalNameMax);
  std::ranges::replace_if(
      made, [](char c) { return c < ' ' || c > '~'; }, '?');
  return made;
}

}  // namespace

Result<std::string> marker_of(const Proposal& proposal, const std::string& uid,
                              std::int64_t unix_ns) {
  const bool on_earth =
      std::abs(proposal.latitude) <= 90.0 && std::abs(proposal.longitude) <= 180.0;
  if (!on_earth) return Error{"its latitude and longitude are to be WGS84 degrees"};
  if (proposal.kind >= static_cast<std::uint8_t>(IncidentKind::count)) {
    return Error{"there is no kind " + std::to_string(proposal.kind)};
  }
  agencies::CotEvent event;
  event.uid = uid;
  event.type = "b-m-p-s-m";
  event.how = "h-g-i-g-o";
  event.time_unix_ns = unix_ns;
  event.stale_unix_ns = unix_ns + kStale_ns;
  event.place = {proposal.latitude, proposal.longitude, 0.0};
  // The kind that is named first counts.
  event.callsign = std::string{to_string(static_cast<IncidentKind>(proposal.kind))} +
                   ", ROS 2: " + plain(proposal.name);
  return agencies::to_xml(event);
}

std::optional<std::string> ProposalIntake::take(std::span<const std::uint8_t> bytes, Instant now,
                                                std::int64_t unix_ns) {
  const auto proposal =
      bytes.size() <= kProposalBytesMax ? from_cdr<Proposal>(bytes) : std::nullopt;
  auto marker = proposal
                    ? marker_of(*proposal, "ros2-" + run_ + "-" + std::to_string(next_), unix_ns)
                    : Result<std::string>{Error{"it is no SiteProposal in plain CDR"}};
  if (!marker) {
    ++unreadable_;
    trouble_ = marker.error().message;
    return std::nullopt;
  }
  if (!has_room(now)) {
    ++too_many_;
    trouble_ = "there are too many: 20 at once, then one in 2 s";
    return std::nullopt;
  }
  ++next_;
  return *std::move(marker);
}

/// A bucket that fills at kRate_per_s.
bool ProposalIntake::has_room(Instant now) {
  room_ = std::min(room_ + kRate_per_s * to_seconds(now - room_at_), static_cast<double>(kBurst));
  room_at_ = now;
  if (room_ < 1.0) return false;
  room_ -= 1.0;
  return true;
}

std::optional<std::string> ProposalIntake::poll_trouble() { return std::exchange(trouble_, {}); }

}  // namespace skein::ros2
