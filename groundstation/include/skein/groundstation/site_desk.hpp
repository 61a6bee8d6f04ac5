// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// What the ground station is told of detections by its configuration.
[[nodiscard]] mission::GroundDetectionsConfig detections_config(
    const configuration::GroundConfig& config);

/// Where the operator adds, changes and withdraws sites: completes what was asked with the
/// configuration's templates, and tells the node. Without I/O but for files of sites.
class SiteDesk {
 public:
  /// The node must outlive it.
  SiteDesk(const configuration::GroundConfig& config, const MissionOrigin& origin,
           mission::GroundNode& node);

  // What came of it, for the operator; `by` gave the order.
  [[nodiscard]] Answer answer(const NewSite& order, const std::string& by, Instant now);
  [[nodiscard]] Answer answer(const SitesFromFile& order, Instant now);
  [[nodiscard]] Answer answer(const WithdrawSite& order, const std::string& by, Instant now);
  [[nodiscard]] Answer answer(const ProposalAnswer& order, const std::string& by, Instant now);
  /// What detectors have seen and nobody has answered.
  [[nodiscard]] std::string proposals_text() const;
  [[nodiscard]] const std::map<std::string, Site>& templates() const { return templates_; }

 private:
  /// The site as asked for. Fails where a template, or the site that it changes, is not known.
  [[nodiscard]] Result<Site> completed(const NewSite& order) const;
  [[nodiscard]] Result<Vec2> place_of(const SiteWishes& wishes) const;
  /// Why there is no other site to be added there; nothing where there may.
  [[nodiscard]] std::string why_not_at(const Vec2& place, std::optional<SiteId> but_for) const;
  [[nodiscard]] std::string why_no_metres(const SiteWishes& wishes) const;
  [[nodiscard]] std::string nobody_text() const;
  [[nodiscard]] std::string surveyor_text(SiteId site) const;
  [[nodiscard]] std::string ends_text(const std::optional<VehicleId>& surveyor,
                                      const Site& site) const;

  MissionOrigin origin_;
  std::map<std::string, Site> templates_;
  double same_site_m_;
  mission::GroundNode* node_;
};

/// "deliveries towards 090, 180 at one time; 2 assessments; reward 3".
[[nodiscard]] std::string tasks_text(const Site& site);

}  // namespace skein::groundstation
