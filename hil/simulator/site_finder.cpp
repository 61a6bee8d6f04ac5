// SPDX-License-Identifier: Apache-2.0
#include "site_finder.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace skein::hil {
namespace {

std::vector<VehicleSpec> specs(const TeamMission& mission) {
  std::vector<VehicleSpec> all;
  for (const auto& v : mission.vehicles) all.push_back(v.spec);
  return all;
}

std::vector<Site> sites(const TeamMission& mission, bool reported) {
  std::vector<Site> some;
  std::copy_if(mission.sites.begin(), mission.sites.end(), std::back_inserter(some),
               [&](const Site& site) { return mission.reported.contains(site.id) == reported; });
  return some;
}

bool can_be_told(const Aircraft& vehicle) {
  return vehicle.takes_part() && !vehicle.battery_fell() &&
         vehicle.spec().capabilities.has(TaskKind::survey);
}

}  // namespace

SiteFinder::SiteFinder(const TeamMission& mission)
    : mission_{mission},
      specs_{specs(mission)},
      sensors_{sites(mission, false), specs_},
      to_report_{sites(mission, true)} {}

SiteFinder::Found SiteFinder::found(std::size_t vehicle, const Site& site) {
  known_.on_told(site.id, specs_[vehicle].id);
  return {vehicle, {mission_.vehicles[vehicle].number(), site}};
}

std::vector<SiteFinder::Found> SiteFinder::look(const std::vector<Aircraft>& vehicles) {
  std::vector<Found> all;
  if (sensors_.hidden().empty()) return all;
  std::map<VehicleId, Vec2> positions;
  for (const auto& v : vehicles) {
    if (v.running()) positions[v.spec().id] = v.state().position().horizontal();
  }
  for (const auto& report : sensors_.update(positions)) {
    const auto finder = std::find_if(specs_.begin(), specs_.end(),
                                     [&](const auto& spec) { return spec.id == report.finder; });
    all.push_back(found(static_cast<std::size_t>(finder - specs_.begin()), report.site));
    std::erase_if(to_report_, [&](const Site& site) { return site.id == report.site.id; });
  }
  return all;
}

std::vector<SiteFinder::Found> SiteFinder::report_due(const std::vector<Aircraft>& vehicles,
                                                      Instant now) {
  std::vector<Found> all;
  std::set<std::size_t> told;
  std::erase_if(to_report_, [&](const Site& site) {
    const auto from = mission_.reported.find(site.id);
    if (from != mission_.reported.end() && from->second > now) return false;
    std::optional<std::size_t> nearest;
    const auto distance = [&](std::size_t i) {
      return (vehicles[i].state().position().horizontal() - site.position).squaredNorm();
    };
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      if (!can_be_told(vehicles[i]) || told.contains(i)) continue;
      const auto activity = vehicles[i].activity();
      const bool free =
          activity == mission::Activity::searching || activity == mission::Activity::standing_by;
      if (free && (!nearest || distance(i) < distance(*nearest))) nearest = i;
    }
    if (!nearest) return false;
    told.insert(*nearest);
    all.push_back(found(*nearest, site));
    return true;
  });
  return all;
}

/// What nobody has found, or only vehicles that do not work with the others, or fly home.
std::vector<Site> SiteFinder::unattended(const std::vector<Aircraft>& vehicles) const {
  std::vector<Site> all = sensors_.hidden();
  const auto leaves_it = [&](VehicleId id) {
    const auto v = std::find_if(vehicles.begin(), vehicles.end(),
                                [id](const Aircraft& a) { return a.spec().id == id; });
    return v != vehicles.end() && ((v->running() && !v->takes_part()) || v->battery_fell());
  };
  for (const Site& site : mission_.sites) {
    const auto knowing = known_.knowing(site.id);
    if (knowing.empty() || known_.done(site.id)) continue;
    if (std::ranges::all_of(knowing, leaves_it)) all.push_back(site);
  }
  return all;
}

std::vector<SiteFinder::Found> SiteFinder::report_all(const std::vector<Aircraft>& vehicles) {
  std::vector<Found> all;
  std::vector<Site> nobody;
  std::set<std::size_t> busy;
  for (const Site& site : unattended(vehicles)) {
    std::optional<std::size_t> nearest;
    const auto distance = [&](std::size_t i) {
      return (vehicles[i].state().position().horizontal() - site.position).squaredNorm();
    };
    const auto consider = [&](bool also_busy) {
      for (std::size_t i = 0; i < vehicles.size(); ++i) {
        const bool can = can_be_told(vehicles[i]) && (also_busy || !busy.contains(i));
        if (can && (!nearest || distance(i) < distance(*nearest))) nearest = i;
      }
    };
    consider(false);
    if (!nearest) consider(true);
    if (nearest) {
      busy.insert(*nearest);
      all.push_back(found(*nearest, site));
    } else {
      nobody.push_back(site);
    }
  }
  sensors_ = SurveySensors{nobody, specs_};
  to_report_.insert(to_report_.end(), nobody.begin(), nobody.end());
  return all;
}

void SiteFinder::on_agent_end(std::size_t vehicle) {
  sensors_.hide(known_.on_program_end(specs_[vehicle].id, mission_.sites));
}

}  // namespace skein::hil
