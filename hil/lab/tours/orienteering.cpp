// SPDX-License-Identifier: Apache-2.0
#include "skein/tours/orienteering.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace skein::planning {
namespace {

/// Lines of numbers, each after the word that it must begin with.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : in_{std::string{text}}, name_{name} {}

  Result<double> named(const std::string& word) {
    std::istringstream line{next()};
    std::string said;
    double value = 0.0;
    if (!(line >> said >> value) || said != word || !std::isfinite(value) || value < 0.0) {
      return wrong("'" + word + " NUMBER' is expected here");
    }
    return value;
  }

  struct Place {
    Vec2 at{0.0, 0.0};
    double score = 0.0;
  };
  Result<Place> place() {
    std::istringstream line{next()};
    Place p;
    if (!(line >> p.at.x() >> p.at.y() >> p.score) || p.score < 0.0) {
      return wrong("a place is three numbers: x, y and score");
    }
    return p;
  }

 private:
  std::string next() {
    std::string line;
    while (std::getline(in_, line)) {
      ++number_;
      if (line.find_first_not_of(" \t\r") != std::string::npos) return line;
    }
    ++number_;
    return "";
  }
  [[nodiscard]] Error wrong(const std::string& what) const {
    return Error{name_ + ":" + std::to_string(number_) + ": " + what};
  }

  std::istringstream in_;
  std::string name_;
  int number_ = 0;
};

}  // namespace

Result<CoupledProblem> parse_orienteering(std::string_view text, const std::string& name) {
  Lines lines{text, name};
  const auto places = lines.named("n");
  if (!places) return places.error();
  const auto vehicles = lines.named("m");
  if (!vehicles) return vehicles.error();
  const auto time_s = lines.named("tmax");
  if (!time_s) return time_s.error();
  if (*places < 3.0 || *places > kCoupledTasksMax + 2.0 || *vehicles < 1.0 ||
      *vehicles > static_cast<double>(kCoupledVehiclesMax)) {
    return Error{name + ": 1 to " + std::to_string(kCoupledVehiclesMax) + " vehicles and 3 to " +
                 std::to_string(kCoupledTasksMax + 2) +
                 " places, start and end among them, can be "
                 "planned"};
  }
  std::vector<Lines::Place> read;
  for (int k = 0; k < static_cast<int>(*places); ++k) {
    const auto place = lines.place();
    if (!place) return place.error();
    read.push_back(*place);
  }
  CoupledProblem problem;
  for (int k = 0; k < static_cast<int>(*vehicles); ++k) {
    CoupledVehicle v;
    v.id = VehicleId{static_cast<std::uint16_t>(k + 1)};
    v.pose = {read.front().at.x(), read.front().at.y(), 0.0};
    v.speed_mps = 1.0;
    v.range_left_m = *time_s;
    v.capabilities.add(TaskKind::survey);
    v.home = read.back().at;
    problem.vehicles.push_back(v);
  }
  for (std::size_t k = 1; k + 1 < read.size(); ++k) {
    Site site;
    site.id = SiteId{static_cast<std::uint16_t>(k)};
    site.position = read[k].at;
    site.survey.dwell = {};
    site.reward = read[k].score;
    site.reward_decay_per_s = 0.0;
    problem.open_tasks.push_back({site.id, TaskKind::survey, 0});
    problem.optional_sites.push_back(site.id);
    problem.service_sites.push_back(site.id);
    problem.sites.push_back(site);
  }
  problem.weights = {1.0, 0.0};
  return problem;
}

double score_of(const CoupledProblem& problem) {
  double sum = 0.0;
  for (const Site& site : problem.sites) sum += site.reward;
  return sum;
}

double score_of(const CoupledProblem& problem, const CoupledPlan& plan) {
  double sum = 0.0;
  for (const CoupledTask& task : plan.tasks) {
    sum += std::ranges::find(problem.sites, task.task.site, &Site::id)->reward;
  }
  return sum;
}

}  // namespace skein::planning
