// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.hpp"
#include "skein/groundstation/route_planning.hpp"

namespace skein::hil {

Result<void> give_routes(configuration::Scenario& scenario, const std::filesystem::path& plan) {
  if (!scenario.flies_routes()) {
    if (plan.empty()) return {};
    if (scenario.sites.empty()) {
      return Error{
          "--routes: the mission has neither routes nor sites; name vehicles under "
          "routes.approaches, or sites"};
    }
    const auto loaded = configuration::load_tasking_plan(plan);
    if (!loaded) return loaded.error();
    return configuration::give_tasks(*loaded, scenario);
  }
  if (!plan.empty()) {
    const auto loaded = configuration::load_route_plan(plan);
    if (!loaded) return loaded.error();
    return configuration::give_routes(*loaded, scenario);
  }
  const auto planned = groundstation::plan_routes(scenario);
  if (!planned) return planned.error();
  fmt::print("{}\n", groundstation::routes_text(*planned));
  if (!planned->check.ok()) return Error{"the plan breaks a rule; nothing is flown"};
  return configuration::give_routes(planned->file, scenario);
}

}  // namespace skein::hil
