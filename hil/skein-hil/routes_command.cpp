// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "progress_line.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/route_figures/route_figures.hpp"

namespace skein::hil {
namespace {

bool write(const std::filesystem::path& file, const std::string& text) {
  return (std::ofstream{file, std::ios::binary} << text).flush().good();
}

}  // namespace

int routes(const RoutesArguments& arguments) {
  const auto experiments = route_figures::find_experiments(arguments.what);
  if (!experiments) return complain(experiments.error().message);
  std::error_code failed;
  std::filesystem::create_directories(arguments.folder, failed);
  if (failed) {
    return complain(arguments.folder.string() + ": cannot be made: " + failed.message() +
                    "; name another folder with --out");
  }
  route_figures::Options options;
  if (arguments.paper) options.runs = route_figures::paper_runs();
  if (arguments.runs) options.runs = route_figures::runs_of(*arguments.runs);
  options.seed = arguments.seed;
  options.jobs = jobs_of(arguments.jobs);
  for (const auto experiment : *experiments) {
    ProgressLine progress{route_figures::steps_of(experiment, options.runs),
                          std::string{route_figures::to_string(experiment)} + ": "};
    options.on_done = [&progress] { progress.count(true); };
    const auto figures = route_figures::draw(experiment, options);
    progress.clear();
    if (!figures) return complain(figures.error().message);
    std::string names;
    for (const route_figures::File& file : figures->files) {
      if (!write(arguments.folder / file.name, file.text)) {
        return complain((arguments.folder / file.name).string() +
                        ": cannot be written; make room or name another folder with --out");
      }
      names += " " + file.name;
    }
    fmt::print("{}->{}\n\n", figures->text, names);
    std::fflush(stdout);
  }
  fmt::print("tables and figures: {}\n", arguments.folder.string());
  return kExitHeld;
}

}  // namespace skein::hil
