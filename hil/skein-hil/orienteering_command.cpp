// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "commands.hpp"
#include "skein/tours/orienteering.hpp"

namespace skein::hil {

int orienteering(const OrienteeringArguments& arguments) {
  fmt::print("file,places,vehicles,score,bound,proven,seconds\n");
  for (const std::filesystem::path& file : arguments.files) {
    std::ifstream in{file, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};
    if (!in) return complain(file.string() + ": cannot be read");
    const auto problem = planning::parse_orienteering(text, file.string());
    if (!problem) return complain(problem.error());
    const auto begun = std::chrono::steady_clock::now();
    const auto tree = planning::branch_and_bound(*problem, {arguments.nodes, {}});
    if (!tree) return complain(file.string() + ": " + tree.error().message);
    const double all = planning::score_of(*problem);
    double score = planning::score_of(*problem, *tree);
    const double bound = tree->bound.value_or(1.0) * all;
    if (!tree->proven) {
      Random random{arguments.seed};
      const auto searched = planning::ruin_and_recreate(*problem, random, {arguments.steps, {}});
      if (searched) score = std::max(score, planning::score_of(*problem, *searched));
    }
    if (score > bound * (1.0 + 1e-9)) {
      fmt::print(stderr, "{}: a plan of {:g} is above its own bound of {:g}\n", file.string(),
                 score, bound);
      return kExitViolated;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    fmt::print("{},{},{},{:g},{:.1f},{},{:.2f}\n", file.filename().string(), problem->sites.size(),
               problem->vehicles.size(), score, bound, tree->proven ? "yes" : "no", took.count());
    std::fflush(stdout);
  }
  return kExitHeld;
}

}  // namespace skein::hil
