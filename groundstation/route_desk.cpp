// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/route_desk.hpp"

#include <fmt/format.h>

#include <iterator>

#include "skein/configuration/routes_config.hpp"
#include "skein/routes/fly_by.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

using Routes = mission::GroundRoutes::Routes;

Answer refusal(const Error& error) { return {false, error.message + "\n"}; }

Result<Routes> routes_of(const configuration::RoutePlan& plan, Instant begins) {
  Routes routes;
  for (const auto& planned : plan.routes) {
    const configuration::FlightRoute& route = planned.route;
    const auto path = routes::fly_by_path(route.waypoints, route.turn_radius_m);
    if (!path) {
      return Error{fmt::format("the route of {}: {}", wording::text_of(planned.vehicle),
                               path.error().message)};
    }
    TimedPath timed;
    timed.start_time = begins;
    timed.speed_mps = route.speed_mps;
    timed.tail_curvature_per_m = 1.0 / route.turn_radius_m;
    timed.path = *path;
    if (!routes.emplace(planned.vehicle, timed).second) {
      return Error{wording::text_of(planned.vehicle) + " has two routes"};
    }
  }
  return routes;
}

std::string text_of(const Routes& routes) {
  std::string text;
  for (const auto& [id, timed] : routes) {
    fmt::format_to(std::back_inserter(text),
                   "{}: {:.0f} m at {:.1f} m/s, begins at {:.1f} s, {:.0f} east {:.0f} north, ends "
                   "at {:.1f} s\n",
                   wording::text_of(id), timed.path.length_m(), timed.speed_mps,
                   to_seconds(timed.start_time), timed.path.start.x_m, timed.path.start.y_m,
                   to_seconds(timed.end_time()));
  }
  return text;
}

std::string state_text(const mission::GivenRoute& route) {
  return route.answer ? wording::text_of(*route.answer, route.why) : "has not answered";
}

std::string headline(const mission::GivenRoutes& plan, Instant now) {
  const double until_s = to_seconds(plan.begins - now);
  const auto when = until_s > 0.0 ? fmt::format("begins in {:.0f} s", until_s)
                                  : fmt::format("began {:.0f} s ago", -until_s);
  switch (plan.step) {
    case mission::RouteStep::offer:
      return fmt::format("routes of plan {}, offered: {}", plan.plan, when);
    case mission::RouteStep::fly:
      return fmt::format("routes of plan {}, taken by all: {}{}", plan.plan, when,
                         plan.over ? "; over" : "");
    case mission::RouteStep::call_off:
    case mission::RouteStep::count:
      break;
  }
  return fmt::format("routes of plan {}: called off", plan.plan);
}

}  // namespace

Answer RouteDesk::answer(const RoutesFromFile& order, Instant now) {
  const auto file = configuration::load_route_plan(order.file);
  if (!file) return refusal(file.error());
  const auto routes = routes_of(*file, order.in_s ? now + from_seconds(*order.in_s) : Instant{});
  if (!routes) return refusal(routes.error());
  if (order.preview) {
    const auto good = node_->check_routes(*routes, now);
    return {good.ok(), text_of(*routes) + (good ? "the vehicles judge turns, speed and range "
                                                  "themselves when they are asked\n"
                                                : "but " + good.error().message + "\n")};
  }
  const auto given = node_->give_routes(*routes, now);
  if (!given) return refusal(given.error());
  return {true,
          fmt::format("plan {} is offered to {} vehicles; they fly when all have taken theirs\n{}",
                      *given, routes->size(), text_of(*routes))};
}

Answer RouteDesk::answer(const CallOffRoutes& /*order*/, Instant now) {
  if (const auto off = node_->call_off_routes(now); !off) return refusal(off.error());
  return {true, "the routes are called off\n"};
}

std::string RouteDesk::status_text(Instant now) const {
  const auto& given = node_->routes().given();
  if (!given) return "";
  std::string text = headline(*given, now) + "\n";
  for (const auto& [id, route] : given->routes) {
    text += fmt::format("{:>7}  {}\n", id.value, state_text(route));
  }
  return text;
}

std::string RouteDesk::text(Instant now) const {
  const std::string status = status_text(now);
  return status.empty() ? "no routes are given\n" : status;
}

}  // namespace skein::groundstation
