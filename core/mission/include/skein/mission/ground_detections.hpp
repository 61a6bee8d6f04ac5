// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/ground_sites.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

struct GroundDetectionsConfig {
  bool take = false;          ///< at once; otherwise they are proposed to the operator
  double same_site_m = 30.0;  ///< nearer to each other two detections are of one site
  std::map<IncidentKind, Site> sites = {};  ///< what is to be done; the position is the detection's
  Site otherwise = {};                      ///< of kinds without one
};

/// A detection that the operator has been, or may be, asked about.
struct Proposal {
  Detection detection;
  enum class State : std::uint8_t { open, taken, dismissed } state = State::open;
};

/// What detectors of the vehicles have seen. One place is proposed, or taken, once: whatever is
/// seen nearer than GroundDetectionsConfig::same_site_m to a site of this mission, be it done or
/// withdrawn, or to an earlier proposal, is that one.
class GroundDetections {
 public:
  static constexpr std::size_t kProposalsMax = 200;  ///< that wait for an answer
  static constexpr std::size_t kOutsideMax = 50;     ///< of these, from outside the team

  explicit GroundDetections(GroundDetectionsConfig config) : config_{std::move(config)} {}

  void recall(const Message& message, VehicleId sender);
  /// Tells the operator again of what an earlier process had proposed.
  void on_timeout(Instant now);
  /// The site that is to be added now, if any.
  [[nodiscard]] std::optional<Site> on_message(const Message& message, const GroundSites& sites,
                                               Instant now);
  /// What somebody outside the team has seen (`vehicle` 0): proposed to the operator in every mode.
  /// False where it is known already, or kOutsideMax of these wait.
  bool propose_from_outside(Detection detection, const GroundSites& sites, Instant now);
  /// The site of that proposal, which the operator takes or dismisses. Fails where it is not open.
  Result<Site> answer(std::uint32_t number, bool accepted, const std::string& by, Instant now);
  /// As it would be taken. Fails where it is not open.
  [[nodiscard]] Result<Site> proposed(std::uint32_t number) const;

  [[nodiscard]] const std::map<std::uint32_t, Proposal>& proposals() const { return proposals_; }
  [[nodiscard]] const GroundDetectionsConfig& config() const { return config_; }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] std::uint64_t dropped() const { return events_.dropped() + left_out_; }

 private:
  [[nodiscard]] bool is_known(const Vec2& place, const GroundSites& sites) const;
  [[nodiscard]] bool is_proposed(const Vec2& place) const;
  [[nodiscard]] Site site_of(const Detection& detection) const;
  void report(std::uint32_t number, Instant now);
  std::uint32_t propose(const Detection& detection);
  bool make_room();

  GroundDetectionsConfig config_;
  std::map<std::uint32_t, Proposal> proposals_;
  std::uint32_t newest_ = 0;
  bool recalled_ = false;  ///< something was, and is told again
  std::uint64_t left_out_ = 0;
  BoundedQueue<MissionEvent> events_{64};
};

}  // namespace skein::mission
