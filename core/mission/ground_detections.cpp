// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_detections.hpp"

#include <algorithm>

namespace skein::mission {

void GroundDetections::recall(const Message& message, VehicleId sender) {
  const auto* event = std::get_if<MissionEvent>(&message);
  if (event == nullptr || sender != kGroundStation) return;
  if (const auto* said = std::get_if<event::SiteProposed>(&event->body)) {
    if (proposals_.contains(said->number) || !make_room()) return;
    newest_ = std::max(newest_, said->number);
    proposals_[said->number].detection = {
        said->seen_by, 0, said->kind, {said->x_m, said->y_m}, said->confidence, said->detector};
    recalled_ = true;
  } else if (const auto* answer = std::get_if<event::ProposalAnswered>(&event->body)) {
    const auto known = proposals_.find(answer->number);
    if (known == proposals_.end()) return;
    known->second.state = answer->accepted ? Proposal::State::taken : Proposal::State::dismissed;
  }
}

std::optional<Site> GroundDetections::on_message(const Message& message, const GroundSites& sites,
                                                 Instant now) {
  const auto* detection = std::get_if<Detection>(&message);
  if (detection == nullptr || is_known(detection->position, sites)) return std::nullopt;
  if (config_.take) return site_of(*detection);
  if (is_proposed(detection->position)) return std::nullopt;
  const std::uint32_t number = propose(*detection);
  if (number > 0) report(number, now);
  return std::nullopt;
}

bool GroundDetections::propose_from_outside(Detection detection, const GroundSites& sites,
                                            Instant now) {
  detection.vehicle = kGroundStation;
  if (is_known(detection.position, sites) || is_proposed(detection.position)) return false;
  const auto waiting = std::ranges::count_if(proposals_, [](const auto& known) {
    return known.second.state == Proposal::State::open &&
           known.second.detection.vehicle == kGroundStation;
  });
  const bool full = static_cast<std::size_t>(waiting) >= kOutsideMax;
  const std::uint32_t number = full ? 0 : propose(detection);
  if (number > 0) report(number, now);
  return number > 0;
}

void GroundDetections::on_timeout(Instant now) {
  if (!recalled_) return;
  recalled_ = false;
  for (const auto& [number, proposal] : proposals_) {
    if (proposal.state == Proposal::State::open) report(number, now);
  }
}

void GroundDetections::report(std::uint32_t number, Instant now) {
  const Detection& seen = proposals_.at(number).detection;
  events_.push({kGroundStation,
                now,
                {},
                {},
                event::SiteProposed{number, seen.vehicle, seen.kind, seen.position.x(),
                                    seen.position.y(), seen.detector, seen.confidence}});
}

/// 0 where there is no room.
std::uint32_t GroundDetections::propose(const Detection& detection) {
  if (!make_room()) {
    ++left_out_;
    return 0;
  }
  proposals_.emplace(++newest_, Proposal{detection});
  return newest_;
}

/// Of those that are answered the oldest is forgotten.
bool GroundDetections::make_room() {
  if (proposals_.size() < kProposalsMax) return true;
  const auto answered = std::ranges::find_if(
      proposals_, [](const auto& one) { return one.second.state != Proposal::State::open; });
  if (answered == proposals_.end()) return false;
  proposals_.erase(answered);
  return true;
}

bool GroundDetections::is_known(const Vec2& place, const GroundSites& sites) const {
  return std::ranges::any_of(sites.sites(), [&](const auto& known) {
    const GroundSite& entry = known.second;
    return entry.placed && (entry.site.position - place).norm() <= config_.same_site_m;
  });
}

bool GroundDetections::is_proposed(const Vec2& place) const {
  return std::ranges::any_of(proposals_, [&](const auto& known) {
    return (known.second.detection.position - place).norm() <= config_.same_site_m;
  });
}

Site GroundDetections::site_of(const Detection& detection) const {
  const auto known = config_.sites.find(detection.kind);
  Site site = known == config_.sites.end() ? config_.otherwise : known->second;
  site.position = detection.position;
  return site;
}

Result<Site> GroundDetections::proposed(std::uint32_t number) const {
  const auto known = proposals_.find(number);
  if (known == proposals_.end()) {
    return Error{"there is no proposal " + std::to_string(number) + "; 'proposals' lists them"};
  }
  if (known->second.state != Proposal::State::open) {
    return Error{"proposal " + std::to_string(number) + " is answered already"};
  }
  return site_of(known->second.detection);
}

Result<Site> GroundDetections::answer(std::uint32_t number, bool accepted, const std::string& by,
                                      Instant now) {
  auto site = proposed(number);
  if (!site) return site;
  proposals_.at(number).state = accepted ? Proposal::State::taken : Proposal::State::dismissed;
  events_.push({kGroundStation, now, {}, {}, event::ProposalAnswered{number, accepted, by}});
  return site;
}

}  // namespace skein::mission
