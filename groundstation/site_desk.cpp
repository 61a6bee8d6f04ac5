// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/site_desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "search_words.hpp"
#include "skein/base/angles.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

constexpr double kSameRegion_deg = 1.0;
constexpr Duration kSurvey = std::chrono::seconds{5};
constexpr Duration kAssessment = std::chrono::seconds{6};

/// Where nothing is asked for: it is looked at.
Site plain_site() {
  Site site;
  site.survey.dwell = kSurvey;
  return site;
}

Answer refusal(const Error& error) { return {false, error.message + "\n"}; }

std::map<std::string, Site> templates_of(const configuration::GroundConfig& config) {
  std::map<std::string, Site> templates;
  for (const auto& [name, site] : config.site_templates) templates.emplace(name, site);
  return templates;
}

void set_deliveries(Site& site, const SiteWishes& wishes) {
  Duration interval = site.deliveries.size() > 1 ? site.deliveries[1].offset : Duration{};
  std::vector<double> bearings;
  for (const auto& delivery : site.deliveries) bearings.push_back(delivery.bearing_rad);
  if (wishes.interval_s) interval = from_seconds(*wishes.interval_s);
  if (wishes.bearings_rad) bearings = *wishes.bearings_rad;
  site.deliveries.clear();
  for (const double bearing_rad : bearings) {
    site.deliveries.push_back(
        {bearing_rad, static_cast<Duration::rep>(site.deliveries.size()) * interval});
  }
}

void set_assessments(Site& site, const SiteWishes& wishes) {
  if (wishes.assessment_wait_s) site.assess_wait = from_seconds(*wishes.assessment_wait_s);
  const ArcRequirement one =
      site.assessments.empty() ? ArcRequirement{{}, kAssessment} : site.assessments.front();
  if (wishes.assessments) {
    site.assessments.resize(static_cast<std::size_t>(*wishes.assessments),
                            ArcRequirement{{}, one.dwell});
  }
  if (!wishes.assessment_dwell_s) return;
  for (auto& assessment : site.assessments) {
    assessment.dwell = from_seconds(*wishes.assessment_dwell_s);
  }
}

}  // namespace

mission::GroundDetectionsConfig detections_config(const configuration::GroundConfig& config) {
  mission::GroundDetectionsConfig made;
  made.take = config.detections.mode == configuration::DetectionMode::take;
  made.same_site_m = config.detections.same_site_m;
  made.otherwise = plain_site();
  const auto templates = templates_of(config);
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::IncidentKind::count); ++i) {
    const auto kind = static_cast<mission::IncidentKind>(i);
    const auto known = templates.find(std::string{to_string(kind)});
    if (known != templates.end()) made.sites.emplace(kind, known->second);
  }
  return made;
}

SiteDesk::SiteDesk(const configuration::GroundConfig& config, const MissionOrigin& origin,
                   mission::GroundNode& node)
    : origin_{origin},
      templates_{templates_of(config)},
      same_site_m_{config.detections.same_site_m},
      node_{&node} {}

Result<Vec2> SiteDesk::place_of(const SiteWishes& wishes) const {
  if (wishes.place_m) return *wishes.place_m;
  const Vec2 place = origin_
                         .to_enu({wishes.place->latitude_deg, wishes.place->longitude_deg,
                                  origin_.origin().height_m})
                         .horizontal();
  if (!kCoordinate_m.has(place.x()) || !kCoordinate_m.has(place.y())) {
    return Error{
        fmt::format("that place is {:.0f} km from the mission's origin; check the latitude "
                    "and the longitude",
                    place.norm() / 1000.0)};
  }
  return place;
}

Result<Site> SiteDesk::completed(const NewSite& order) const {
  Site site = plain_site();
  const SiteWishes& wishes = order.wishes;
  if (order.changes) {
    const auto& sites = node_->sites().sites();
    const auto known = sites.find(*order.changes);
    if (known == sites.end() || !known->second.placed) {
      return Error{fmt::format("there is no site {} to be changed; 'sites' lists them",
                               order.changes->value)};
    }
    site = known->second.site;
  }
  if (!wishes.like.empty()) {
    const auto known = templates_.find(wishes.like);
    if (known == templates_.end()) {
      std::string names;
      for (const auto& [name, like] : templates_)
        names.append(names.empty() ? "" : ", ").append(name);
      return Error{
          fmt::format("there is no template '{}'; the configuration's site_templates has {}",
                      wishes.like, names.empty() ? "none" : names)};
    }
    const Vec2 place = site.position;
    site = known->second;
    site.position = place;
  }
  if (wishes.place_m || wishes.place) {
    const auto place = place_of(wishes);
    if (!place) return place.error();
    site.position = *place;
  }
  if (wishes.survey_dwell_s) site.survey.dwell = from_seconds(*wishes.survey_dwell_s);
  set_deliveries(site, wishes);
  set_assessments(site, wishes);
  if (wishes.reward) site.reward = *wishes.reward;
  if (wishes.reward_decay_per_s) site.reward_decay_per_s = *wishes.reward_decay_per_s;
  return site;
}

std::string SiteDesk::why_not_at(const Vec2& place, std::optional<SiteId> but_for) const {
  for (const Hazard& hazard : node_->hazards().known()) {
    if ((hazard.centre - place).norm() > hazard.radius_m) continue;
    return fmt::format("the place is inside hazard {}, where nobody flies; withdraw that",
                       hazard.id.value);
  }
  const auto* known = node_->sites().open_near(place, same_site_m_);
  if (known == nullptr || known->site.id == but_for) return "";
  return fmt::format("site {} is {:.0f} m from there; change or withdraw that one",
                     known->site.id.value, (known->site.position - place).norm());
}

/// Two metres that are the latitude and longitude of this very region are hardly meant as metres.
std::string SiteDesk::why_no_metres(const SiteWishes& wishes) const {
  if (!wishes.place_m) return "";
  const Vec2& place = *wishes.place_m;
  const Wgs84& here = origin_.origin();
  const bool whole = place.x() == std::round(place.x()) && place.y() == std::round(place.y());
  const bool near = std::abs(place.x() - here.latitude_deg) < kSameRegion_deg &&
                    std::abs(place.y() - here.longitude_deg) < kSameRegion_deg;
  if (whole || !near) return "";
  return fmt::format(
      "{0} {1} looks like a latitude and a longitude, but without letters it is "
      "metres; say 'site {0}N {1}E' (S and W for negative ones)",
      place.x(), place.y());
}

/// Why nobody can be told of a site there.
std::string SiteDesk::nobody_text() const {
  bool heard = false;
  bool can = false;
  bool free = false;
  for (const auto& [vehicle, known] : node_->fleet().vehicles()) {
    if (!known.telemetry || known.silent) continue;
    heard = true;
    if (!known.telemetry->capabilities.has(TaskKind::survey)) continue;
    can = true;
    using enum mission::Activity;
    const auto activity = known.telemetry->activity;
    const bool works = activity != holding && activity != landing && activity != landed;
    free = free || (works && !known.differs && !known.duplicate);
  }
  if (!heard) return "no vehicle is heard";
  if (!can) return "no vehicle that is heard can survey";
  if (!free) return "the vehicles that can survey hold or land; 'status' says why";
  return "no vehicle that can survey has the range for it";
}

std::string SiteDesk::surveyor_text(SiteId site) const {
  const auto& known = node_->sites().sites().at(site);
  return known.surveyor ? "told to " + wording::text_of(*known.surveyor)
                        : "told to nobody yet: " + nobody_text();
}

/// Whose search it ends: who surveys leaves its share, and so does who takes up its tasks.
std::string SiteDesk::ends_text(const std::optional<VehicleId>& surveyor, const Site& site) const {
  const auto& search = node_->searches();
  std::string text = surveyor ? ends_search_text(search, {*surveyor}) : "";
  const std::size_t tasks = tasks_after_survey(site).size();
  if (tasks > 0 && !search.searching().empty()) {
    text += fmt::format("its {} {} that of whoever takes {} up\n", tasks,
                        tasks == 1 ? "task ends" : "tasks end", tasks == 1 ? "it" : "them");
  }
  return text;
}

Answer SiteDesk::answer(const NewSite& order, const std::string& by, Instant now) {
  auto site = completed(order);
  if (!site) return refusal(site.error());
  std::string twice;
  if (!order.wishes.anyway) twice = why_no_metres(order.wishes);
  const bool is_moved = !order.changes || order.wishes.place_m || order.wishes.place;
  if (twice.empty() && is_moved && !order.wishes.anyway) {
    twice = why_not_at(site->position, order.changes);
  }
  if (!twice.empty()) twice += ", or say 'anyway'";
  const std::string what =
      fmt::format("{}; {}", place_text(site->position, origin_), tasks_text(*site));
  if (order.preview) {
    const auto surveyor = order.wishes.surveyor
                              ? order.wishes.surveyor
                              : node_->sites().nearest_surveyor(site->position, node_->fleet());
    return {true,
            fmt::format("{}\n{}\n{}{}", what,
                        surveyor ? wording::text_of(*surveyor) + " would survey it"
                                 : "nobody would be told now: " + nobody_text(),
                        twice.empty() ? "" : "but " + twice + "\n", ends_text(surveyor, *site))};
  }
  if (!twice.empty()) return {false, twice + "\n"};
  const Site told = *site;
  const auto given = order.changes ? node_->change_site(*order.changes, *std::move(site),
                                                        order.wishes.surveyor, by, now)
                                   : node_->add_site(*std::move(site), order.wishes.surveyor, now);
  if (!given) return refusal(given.error());
  const std::string instead =
      order.changes ? fmt::format(" in place of site {}, which is withdrawn", order.changes->value)
                    : "";
  return {true, fmt::format("site {}{}, {}\n{}\n{}", given->value, instead, surveyor_text(*given),
                            what, ends_text(node_->sites().sites().at(*given).surveyor, told))};
}

Answer SiteDesk::answer(const SitesFromFile& order, Instant now) {
  const auto file = configuration::load_sites(order.file);
  if (!file) return refusal(file.error());
  std::string text;
  bool all = true;
  for (const Site& site : file->sites) {
    const std::string twice = why_not_at(site.position, std::nullopt);
    const auto given =
        twice.empty() ? node_->add_site(site, std::nullopt, now) : Result<SiteId>{Error{twice}};
    all = all && given.ok();
    text += given ? fmt::format("site {}, {}\n", given->value, surveyor_text(*given))
                  : fmt::format("not the one at {}: {}\n", wording::place_text(site.position),
                                given.error().message);
  }
  return {all, std::move(text)};
}

Answer SiteDesk::answer(const WithdrawSite& order, const std::string& by, Instant now) {
  const auto flown_on = node_->withdraw_site(order.site, by, now);
  if (!flown_on) return refusal(flown_on.error());
  std::string text = fmt::format("site {} is withdrawn\n", order.site.value);
  for (const TaskId& task : *flown_on) {
    text += to_string(task) + " has begun and is flown to its end\n";
  }
  return {true, std::move(text)};
}

Answer SiteDesk::answer(const ProposalAnswer& order, const std::string& by, Instant now) {
  const auto given = node_->answer_proposal(order.number, order.accept, by, now);
  if (!given) return refusal(given.error());
  if (!order.accept) return {true, fmt::format("proposal {} is dismissed\n", order.number)};
  const Vec2& place = node_->sites().sites().at(*given).site.position;
  const std::string but = why_not_at(place, *given);
  return {true, fmt::format("proposal {} is site {}, {}\n{}", order.number, given->value,
                            surveyor_text(*given), but.empty() ? "" : "but " + but + "\n")};
}

std::string SiteDesk::proposals_text() const {
  std::string text;
  for (const auto& [number, proposal] : node_->detections().proposals()) {
    if (proposal.state != mission::Proposal::State::open) continue;
    const mission::Detection& seen = proposal.detection;
    fmt::format_to(
        std::back_inserter(text),
        "proposal {}: {}, {:.0f} %, {} of {}\n  {}\n  accept {}    or    dismiss {}\n", number,
        to_string(seen.kind), 100.0 * seen.confidence,
        seen.detector.empty() ? "a detector" : seen.detector,
        seen.vehicle == kGroundStation ? "another agency" : wording::text_of(seen.vehicle),
        place_text(seen.position, origin_), number, number);
  }
  return text.empty() ? "detectors have proposed nothing that waits for you\n" : text;
}

std::string tasks_text(const Site& site) {
  std::string text = fmt::format("survey of {} s", to_seconds(site.survey.dwell));
  auto out = std::back_inserter(text);
  const char* between = "; deliveries towards ";
  for (const auto& delivery : site.deliveries) {
    fmt::format_to(out, "{}{}", between, wording::bearing_text(delivery.bearing_rad));
    between = ", ";
  }
  if (site.deliveries.size() > 1) {
    const double interval_s = to_seconds(site.deliveries[1].offset);
    text += interval_s > 0.0 ? fmt::format(", one every {} s", interval_s) : " at one time";
  }
  if (!site.assessments.empty()) {
    fmt::format_to(out, "; {} of {} s",
                   site.assessments.size() == 1
                       ? "an assessment"
                       : std::to_string(site.assessments.size()) + " assessments",
                   to_seconds(site.assessments.front().dwell));
  }
  fmt::format_to(out, "; reward {}", site.reward);
  return text;
}

}  // namespace skein::groundstation
