// SPDX-License-Identifier: Apache-2.0
#include "airspace_judge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skein::hil {

namespace {

std::string name(const SeenBody& body) { return fmt::format("U{}", body.vehicle.value); }

}  // namespace

void AirspaceJudge::step(const std::vector<SeenBody>& bodies, Instant now) {
  since_.resize(bodies.size());
  const auto note = [now](std::optional<Instant>& since, bool is_so) {
    if (!is_so) since.reset();
    if (is_so && !since) since = now;
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    note(since_[i].unled, bodies[i].unled);
    note(since_[i].adrift, bodies[i].adrift);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const SeenBody& body = bodies[i];
    farthest_m_ = std::max(farthest_m_, body.off_m);
    if (body.position_m.z() > limits_.ceiling_m + limits_.tracking_m &&
        told_.insert({i, i}).second) {
      violations_.push_back({now, "ceiling",
                             fmt::format("{} is {:.2f} m high; the ceiling is {:g} m", name(body),
                                         body.position_m.z(), limits_.ceiling_m)});
    }
    for (std::size_t k = 0; k < i && !before_.empty(); ++k) see_pair(k, i, bodies, now);
  }
  before_ = bodies;
}

void AirspaceJudge::see_pair(std::size_t a, std::size_t b, const std::vector<SeenBody>& bodies,
                             Instant now) {
  if (!bodies[a].airborne || !bodies[b].airborne) return;
  const Vec3 stretch{1.0, 1.0, height_factor(limits_.separation)};
  const Vec3 begin = (before_[a].position_m - before_[b].position_m).cwiseProduct(stretch);
  const Vec3 end = (bodies[a].position_m - bodies[b].position_m).cwiseProduct(stretch);
  const Vec3 way = end - begin;
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
  const double apart = (begin + share * way).norm();
  const bool near = apart < limits_.separation.horizontal_m;
  // Nobody could do anything about it; nor a program that comes when they are near already.
  if (!near) met_unled_.erase({a, b});
  if (near && (comes_down_on(a, b) || comes_down_on(b, a))) met_unled_.insert({a, b});
  if (met_unled_.contains({a, b})) return;
  least_m_ = std::min(least_m_, apart);
  if (!near || !told_.insert({a, b}).second) return;
  violations_.push_back(
      {now, "separation",
       fmt::format("{} at ({:.2f} {:.2f} {:.2f}) and {} at ({:.2f} {:.2f} {:.2f}) are {:.2f} m "
                   "apart; {:g} m are wanted",
                   name(bodies[a]), bodies[a].position_m.x(), bodies[a].position_m.y(),
                   bodies[a].position_m.z(), name(bodies[b]), bodies[b].position_m.x(),
                   bodies[b].position_m.y(), bodies[b].position_m.z(), apart,
                   limits_.separation.horizontal_m)});
}

}  // namespace skein::hil
