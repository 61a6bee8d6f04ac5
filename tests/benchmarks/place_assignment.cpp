// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/place_assignment.hpp"

#include <benchmark/benchmark.h>
#include <time.h>  // NOLINT(modernize-deprecated-headers): the thread's clock is POSIX

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace {

using skein::Vec3;
using skein::formation::PlaceAssignment;
using skein::formation::PlaceMethod;
using skein::formation::PlaceSolver;

struct Problem {
  std::vector<Vec3> vehicles;
  std::vector<Vec3> places;
};

/// Uniform in a square of 100 m (plane) or in a cube.
std::vector<Problem> random_problems(std::size_t count, double height_m) {
  skein::Random random{1};
  std::vector<Problem> problems(count < 1000 ? 41 : 7);
  for (Problem& problem : problems) {
    for (std::vector<Vec3>* points : {&problem.vehicles, &problem.places}) {
      for (std::size_t i = 0; i < count; ++i) {
        const double x = random.uniform(0.0, 100.0);
        const double y = random.uniform(0.0, 100.0);
        points->emplace_back(x, y, random.uniform(0.0, height_m));
      }
    }
  }
  return problems;
}

/// Blocks of vehicles 5 m apart that move on by 1 km and become wider.
std::vector<Problem> far_grids(std::size_t count) {
  const auto block = [count](double east_m, double north_m, double share) {
    const auto width =
        static_cast<std::size_t>(std::ceil(share * std::sqrt(static_cast<double>(count))));
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
      points.emplace_back(east_m + 5.0 * static_cast<double>(i % width),
                          north_m + 5.0 * static_cast<double>(i / width), 0.0);
    }
    return points;
  };
  std::vector<Problem> problems;
  for (const double wider : {1.0, 1.25, 1.5}) {
    problems.push_back({block(0.0, 0.0, 1.0), block(1000.0, 300.0, wider)});
  }
  return problems;
}

/// Shortest augmenting paths, row by row, without initialisation, as in D. F. Crouse, "On
/// implementing 2D rectangular assignment algorithms", IEEE Trans. Aerosp. Electron. Syst. 52(4),
/// 2016, section II.B: the peer. It keeps its buffers as well.
class Crouse {
 public:
  const std::vector<int>& solve(const std::vector<double>& cost, std::size_t count) {
    u_.assign(count, 0.0);
    v_.assign(count, 0.0);
    column_of_.assign(count, -1);
    row_of_.assign(count, -1);
    remaining_.resize(count);
    for (std::size_t current = 0; current < count; ++current) augment(cost, count, current);
    return column_of_;
  }

 private:
  void augment(const std::vector<double>& cost, std::size_t count, std::size_t current) {
    shortest_.assign(count, std::numeric_limits<double>::infinity());
    predecessor_.assign(count, -1);
    row_scanned_.assign(count, 0);
    column_scanned_.assign(count, 0);
    for (std::size_t j = 0; j < count; ++j) remaining_[j] = count - j - 1;
    std::size_t left = count;
    std::size_t row = current;
    double least = 0.0;
    int sink = -1;
    while (sink < 0) {
      row_scanned_[row] = 1;
      double lowest = std::numeric_limits<double>::infinity();
      std::size_t at = 0;
      for (std::size_t k = 0; k < left; ++k) {
        const std::size_t j = remaining_[k];
        const double reduced = least + cost[row * count + j] - u_[row] - v_[j];
        if (reduced < shortest_[j]) {
          predecessor_[j] = static_cast<int>(row);
          shortest_[j] = reduced;
        }
        if (shortest_[j] < lowest || (shortest_[j] == lowest && row_of_[j] < 0)) {
          lowest = shortest_[j];
          at = k;
        }
      }
      least = lowest;
      const std::size_t column = remaining_[at];
      column_scanned_[column] = 1;
      remaining_[at] = remaining_[--left];
      if (row_of_[column] < 0) {
        sink = static_cast<int>(column);
      } else {
        row = static_cast<std::size_t>(row_of_[column]);
      }
    }
    u_[current] += least;
    for (std::size_t i = 0; i < count; ++i) {
      if (row_scanned_[i] == 0 || i == current) continue;
      u_[i] += least - shortest_[static_cast<std::size_t>(column_of_[i])];
    }
    for (std::size_t j = 0; j < count; ++j) {
      if (column_scanned_[j] != 0) v_[j] -= least - shortest_[j];
    }
    for (int column = sink;;) {
      const auto j = static_cast<std::size_t>(column);
      const auto i = static_cast<std::size_t>(predecessor_[j]);
      row_of_[j] = static_cast<int>(i);
      std::swap(column, column_of_[i]);
      if (i == current) return;
    }
  }

  std::vector<double> u_;
  std::vector<double> v_;
  std::vector<double> shortest_;
  std::vector<int> column_of_;
  std::vector<int> row_of_;
  std::vector<int> predecessor_;
  std::vector<char> row_scanned_;
  std::vector<char> column_scanned_;
  std::vector<std::size_t> remaining_;
};

/// Of this thread, so that other work on the machine does not count.
double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The median problem's time per call; each problem is called often enough to be timed.
template <typename Call>
void median_of_problems(benchmark::State& state, const std::vector<Problem>& problems,
                        const Call& call) {
  const std::size_t count = problems.front().vehicles.size();
  const std::size_t calls = std::max<std::size_t>(1, 40'000 / (count * count));
  while (state.KeepRunning()) {
    std::vector<double> times_s;
    for (const Problem& problem : problems) {
      call(problem);
      const double start_s = processor_s();
      for (std::size_t i = 0; i < calls; ++i) call(problem);
      times_s.push_back((processor_s() - start_s) / static_cast<double>(calls));
    }
    const auto median = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
    std::nth_element(times_s.begin(), median, times_s.end());
    state.SetIterationTime(*median);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

/// Where the height is kFar, far grids.
constexpr double kFar = -1.0;
std::vector<Problem> problems_of(benchmark::State& state, double height_m) {
  const auto count = static_cast<std::size_t>(state.range(0));
  return height_m == kFar ? far_grids(count) : random_problems(count, height_m);
}

/// From positions to places and prices.
void ours(benchmark::State& state, PlaceMethod method, double height_m) {
  const auto problems = problems_of(state, height_m);
  PlaceSolver solver;
  PlaceAssignment result;
  median_of_problems(state, problems, [&](const Problem& problem) {
    if (!solver.solve(method, problem.vehicles, problem.places, result)) {
      state.SkipWithError("not solved");
    }
    benchmark::DoNotOptimize(result.place_of.data());
  });
}

/// The same with the peer: its table of costs from positions, and its assignment.
void crouse(benchmark::State& state, PlaceMethod method, double height_m) {
  const auto problems = problems_of(state, height_m);
  Crouse solver;
  std::vector<double> cost;
  median_of_problems(state, problems, [&](const Problem& problem) {
    const std::size_t count = problem.vehicles.size();
    cost.resize(count * count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        const double square = (problem.vehicles[i] - problem.places[j]).squaredNorm();
        cost[i * count + j] = method == PlaceMethod::least_sum ? std::sqrt(square) : square;
      }
    }
    benchmark::DoNotOptimize(solver.solve(cost, count).data());
  });
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(5)->Arg(32)->Arg(100)->Arg(1000)->UseManualTime();
  benchmark->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
}

void large(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(1000)->UseManualTime();
  benchmark->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
}

constexpr double kFlat = 0.0;
constexpr double kCube = 100.0;

BENCHMARK_CAPTURE(ours, plane, PlaceMethod::least_squares, kFlat)
    ->Name("least_squares/skein/plane")
    ->Apply(sizes);
BENCHMARK_CAPTURE(crouse, plane, PlaceMethod::least_squares, kFlat)
    ->Name("least_squares/crouse/plane")
    ->Apply(sizes);
BENCHMARK_CAPTURE(ours, cube, PlaceMethod::least_squares, kCube)
    ->Name("least_squares/skein/cube")
    ->Apply(sizes);
BENCHMARK_CAPTURE(crouse, cube, PlaceMethod::least_squares, kCube)
    ->Name("least_squares/crouse/cube")
    ->Apply(sizes);
BENCHMARK_CAPTURE(ours, sum, PlaceMethod::least_sum, kFlat)
    ->Name("least_sum/skein/plane")
    ->Apply(sizes);
BENCHMARK_CAPTURE(crouse, sum, PlaceMethod::least_sum, kFlat)
    ->Name("least_sum/crouse/plane")
    ->Apply(sizes);
BENCHMARK_CAPTURE(ours, longest, PlaceMethod::least_longest, kFlat)
    ->Name("least_longest/skein/plane")
    ->Apply(sizes);
BENCHMARK_CAPTURE(ours, far, PlaceMethod::least_squares, kFar)
    ->Name("least_squares/skein/far_grid")
    ->Apply(large);
BENCHMARK_CAPTURE(ours, far_sum, PlaceMethod::least_sum, kFar)
    ->Name("least_sum/skein/far_grid")
    ->Apply(large);
BENCHMARK_CAPTURE(crouse, far_sum, PlaceMethod::least_sum, kFar)
    ->Name("least_sum/crouse/far_grid")
    ->Apply(large);
BENCHMARK_CAPTURE(ours, far_longest, PlaceMethod::least_longest, kFar)
    ->Name("least_longest/skein/far_grid")
    ->Apply(large);

}  // namespace
