// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace {

/// The console's own table, and after it ours / peer for every question that both answered.
class Ratios : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      // Of repetitions only the median counts.
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      const bool alone = run.run_type == Run::RT_Iteration && run.repetitions <= 1;
      if (!run.error_occurred && (median || alone)) add(run);
    }
  }

  void Finalize() override {
    ConsoleReporter::Finalize();
    for (const auto& [question, answers] : times_ns_) {
      const auto ours = answers.find("skein");
      if (ours == answers.end()) continue;
      for (const auto& [who, time_ns] : answers) {
        if (who == "skein") continue;
        if (!titled_) std::printf("\n%-44s %12s %12s %12s\n", "", "skein ns", "peer ns", "ratio");
        titled_ = true;
        std::string title = question;
        title.append(", ").append(who);
        std::printf("%-44s %12.1f %12.1f %12.3f\n", title.c_str(), ours->second, time_ns,
                    ours->second / time_ns);
      }
    }
  }

 private:
  void add(const Run& run) {
    const std::string& what = run.run_name.function_name;
    const auto first = what.find('/');
    if (first == std::string::npos) return;
    const auto second = what.find('/', first + 1);
    const std::string who = what.substr(first + 1, second - first - 1);
    std::string question = what.substr(0, first);
    if (second != std::string::npos) question += what.substr(second);
    if (!run.run_name.args.empty()) question += "/" + run.run_name.args;
    const auto rate = run.counters.find("items_per_second");
    const double each_ns =
        rate != run.counters.end()
            ? 1e9 / rate->second.value
            : run.GetAdjustedCPUTime() * 1e9 / benchmark::GetTimeUnitMultiplier(run.time_unit);
    times_ns_[question][who] = each_ns;
  }

  std::map<std::string, std::map<std::string, double>> times_ns_;  ///< of one item
  bool titled_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Ratios ratios;
  benchmark::RunSpecifiedBenchmarks(&ratios);
  benchmark::Shutdown();
  return 0;
}
