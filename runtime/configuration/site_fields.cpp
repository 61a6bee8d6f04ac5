// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "process_fields.hpp"
#include "skein/configuration/site_config.hpp"

namespace skein::configuration {
namespace {

constexpr std::array<std::string_view, 2> kDeliveryModes{"simultaneous", "sequential"};
constexpr std::array<std::string_view, static_cast<std::size_t>(DetectionMode::count)>
    kDetectionModes{"propose", "take"};

constexpr Range in_seconds(const SiteLimit& limit) { return {limit.low, limit.high, "s"}; }

void delivery_fields(FieldVisitor& v, std::vector<DeliveryRequirement>& deliveries) {
  Duration interval{};
  std::vector<double> bearings;
  bearings.reserve(kTasksPerKindMax);
  for (const DeliveryRequirement& d : deliveries) bearings.push_back(d.bearing_rad);
  if (deliveries.size() > 1) interval = deliveries[1].offset;
  std::size_t mode = interval == Duration{} ? 0 : 1;
  v.choice({"mode", "all at one time, or one after the other", kRequired}, kDeliveryModes, mode);
  v.list(
      {"bearings_deg", "compass direction of travel on arrival, one for each delivery", kRequired},
      list_of(bearings, kTasksPerKindMax,
              [](FieldVisitor& inner, double& bearing) { compass(inner, {}, bearing); }));
  seconds(v, {"interval_s", "from one delivery to the next, when sequential"},
          in_seconds(kDeliveryInterval_s), interval);
  v.require((mode == 1) == (interval > Duration{}), "interval_s",
            "must be above 0 s when the mode is sequential, and is left out when simultaneous");
  deliveries.clear();
  for (const double bearing : bearings) {
    deliveries.push_back({bearing, static_cast<Duration::rep>(deliveries.size()) * interval});
  }
}

void assessment_fields(FieldVisitor& v, Site& site) {
  std::int64_t count = static_cast<std::int64_t>(site.assessments.size());
  Duration dwell = site.assessments.empty() ? from_seconds(1.0) : site.assessments.front().dwell;
  std::vector<double> angles;
  for (const ArcRequirement& arc : site.assessments) {
    if (arc.start_angle_rad) angles.push_back(*arc.start_angle_rad);
  }
  v.integer({"count", "of assessments", kRequired}, {0.0, static_cast<double>(kTasksPerKindMax)},
            count);
  seconds(v, {"wait_s", "from the last delivery to their start"}, in_seconds(kAssessmentWait_s),
          site.assess_wait);
  seconds(v, {"dwell_s", "length of each", kRequired}, in_seconds(kAssessmentDwell_s), dwell);
  v.list({"start_angles_deg",
          "compass direction of the vehicle as seen from the site when it starts, one for each "
          "assessment; without any the vehicles choose"},
         list_of(angles, kTasksPerKindMax,
                 [](FieldVisitor& inner, double& angle_rad) { compass(inner, {}, angle_rad); }));
  v.require(angles.empty() || angles.size() == static_cast<std::size_t>(count), "start_angles_deg",
            "must have one angle for each assessment, or none; compare with count");
  site.assessments.assign(static_cast<std::size_t>(count), {std::nullopt, dwell});
  for (std::size_t i = 0; i < std::min(angles.size(), site.assessments.size()); ++i) {
    site.assessments[i].start_angle_rad = angles[i];
  }
}

void place_fields(FieldVisitor& v, Site& site) {
  v.number({"east_m", "position", kRequired}, kMetres, site.position.x());
  v.number({"north_m", "position", kRequired}, kMetres, site.position.y());
}

void task_fields(FieldVisitor& v, Site& site) {
  v.section({"survey", "an arc of the sensor radius around the site", kRequired},
            [&site](FieldVisitor& inner) {
              compass(inner,
                      {"start_angle_deg",
                       "compass direction of the vehicle as seen from the site when it starts; "
                       "without it the vehicle chooses"},
                      site.survey.start_angle_rad);
              seconds(inner, {"dwell_s", "length of the survey", kRequired},
                      in_seconds(kSurveyDwell_s), site.survey.dwell);
            });
  v.section({"deliveries", "overflights of the site; left out: none"},
            [&site](FieldVisitor& inner) { delivery_fields(inner, site.deliveries); });
  v.section({"assessments", "arcs of the assess radius, after the last delivery; left out: none"},
            [&site](FieldVisitor& inner) { assessment_fields(inner, site); });
  v.number({"reward", "of each task, when done at once"}, {kSiteReward.low, kSiteReward.high},
           site.reward);
  v.number({"reward_decay_per_s", "exponential decay of the reward"},
           {kRewardDecay_per_s.low, kRewardDecay_per_s.high, "1/s"}, site.reward_decay_per_s);
}

}  // namespace

void site_fields(FieldVisitor& v, Site& site) {
  id(v, {"id", "number of the site, its own", kRequired}, site.id);
  place_fields(v, site);
  task_fields(v, site);
}

void site_templates_list(FieldVisitor& v, std::vector<SiteTemplate>& templates) {
  v.list({"site_templates",
          "what is to be done at sites that the operator adds, by name; one of the name of an "
          "incident (fire, smoke, flood, spill, landslide, damage) is for detections of it"},
         groups_of(templates, kListMax, [](FieldVisitor& inner, SiteTemplate& kind) {
           inner.text({"name", "as in `site like NAME at EAST NORTH`", kRequired}, kind.name);
           task_fields(inner, kind.site);
         }));
}

void detections_fields(FieldVisitor& v, DetectionsConfig& config) {
  auto mode = static_cast<std::size_t>(config.mode);
  v.choice({"mode",
            "what becomes of what detectors on board have seen: it is proposed to the operator, or "
            "taken as a site at once"},
           kDetectionModes, mode);
  config.mode = static_cast<DetectionMode>(mode);
  v.number({"same_site_m", "nearer to each other two reports are of one site"}, {0.0, 1e5, "m"},
           config.same_site_m);
}

void fields(FieldVisitor& v, SitesFile& file) {
  version_field(v);
  v.text({"title", "one line"}, file.title);
  v.list({"sites", "in the order in which they are given numbers", kRequired},
         groups_of(file.sites, kListMax, [](FieldVisitor& inner, Site& site) {
           place_fields(inner, site);
           task_fields(inner, site);
         }));
  v.require(!file.sites.empty(), "sites", "is empty; give it one site at least");
}

}  // namespace skein::configuration
