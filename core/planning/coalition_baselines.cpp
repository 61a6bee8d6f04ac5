// SPDX-License-Identifier: Apache-2.0
#include "coalition_baselines.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A growing choice: which vehicles are at hand, which tasks have theirs.
class Choice {
 public:
  Choice(const AllocationTable& table, bool everybody)
      : table_{table}, column_of_(table.rows(), -1), at_hand_(table.columns(), everybody ? 1 : 0) {}

  void set_at_hand(std::size_t column, bool at_hand) { at_hand_[column] = at_hand ? 1 : 0; }
  [[nodiscard]] bool at_hand(std::size_t column) const { return at_hand_[column] != 0; }
  [[nodiscard]] bool taken(std::size_t row) const { return column_of_[row] >= 0; }
  void give(std::size_t row, std::size_t column) {
    column_of_[row] = static_cast<int>(column);
    at_hand_[column] = 0;
  }
  void take_back(std::size_t row) {
    at_hand_[static_cast<std::size_t>(column_of_[row])] = 1;
    column_of_[row] = -1;
  }
  /// Can those at hand do all the tasks that are left?
  [[nodiscard]] bool suffices() {
    cost_.clear();
    std::size_t left = 0;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (taken(row)) continue;
      ++left;
      for (std::size_t c = 0; c < table_.columns(); ++c) {
        cost_.push_back(at_hand(c) && table_.possible(row, c) ? 0.0 : kInfinity);
      }
    }
    matched_.resize(left);
    return solver_.bottleneck(cost_, table_.columns(), matched_).has_value();
  }
  /// Gives the pair, unless that would leave others without.
  [[nodiscard]] bool try_give(std::size_t row, std::size_t column) {
    give(row, column);
    if (suffices()) return true;
    take_back(row);
    return false;
  }
  [[nodiscard]] const std::vector<int>& column_of() const { return column_of_; }

 private:
  const AllocationTable& table_;
  std::vector<int> column_of_;
  std::vector<char> at_hand_;
  std::vector<double> cost_;
  std::vector<int> matched_;
  AssignmentSolver solver_;
};

/// Time of arrival as in a bid: the shortest path with free final heading (Wang 2022, eq. 23).
std::vector<std::size_t> by_arrival(const AllocationTable& table) {
  std::vector<double> eta_s;
  eta_s.reserve(table.columns());
  for (std::size_t c = 0; c < table.columns(); ++c) {
    const Candidate& vehicle = table.candidate(c);
    const Path path =
        shortest_to_point(vehicle.pose, table.problem().site.position, vehicle.planning_radius_m);
    eta_s.push_back(path.length_m() / vehicle.speed_mps);
  }
  std::vector<std::size_t> order(table.columns());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return eta_s[a] < eta_s[b]; });
  return order;
}

/// The members of a coalition choose in order; the bearing that is soonest for each.
bool choose_tasks(const AllocationTable& table, std::span<const std::size_t> members,
                  Choice& choice) {
  std::vector<std::size_t> by_time(table.rows());
  for (const std::size_t member : members) {
    if (!choice.at_hand(member)) continue;
    std::iota(by_time.begin(), by_time.end(), std::size_t{0});
    std::stable_sort(by_time.begin(), by_time.end(), [&](std::size_t a, std::size_t b) {
      return table.least_s(a, member) < table.least_s(b, member);
    });
    for (const std::size_t row : by_time) {
      if (choice.taken(row) || !table.possible(row, member)) continue;
      if (choice.try_give(row, member)) break;
    }
  }
  const auto& column_of = choice.column_of();
  return std::all_of(column_of.begin(), column_of.end(), [](int column) { return column >= 0; });
}

/// The coalition of the first bidders by arrival that suffice, each of them needed.
bool form_coalition(std::span<const std::size_t> order, const std::vector<char>& banned,
                    Choice& choice) {
  std::size_t count = 0;
  bool suffices = false;
  while (count < order.size() && !suffices) {
    const std::size_t next = order[count++];
    if (banned[next] != 0) continue;
    choice.set_at_hand(next, true);
    suffices = choice.suffices();
  }
  if (!suffices) return false;
  for (std::size_t i = count; i-- > 0;) {
    if (!choice.at_hand(order[i])) continue;
    choice.set_at_hand(order[i], false);
    if (!choice.suffices()) choice.set_at_hand(order[i], true);
  }
  return true;
}

/// Each task to the free bidder that is there first.
bool tender_tasks(const AllocationTable& table, Choice& choice) {
  std::vector<std::size_t> bidders(table.columns());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::iota(bidders.begin(), bidders.end(), std::size_t{0});
    std::stable_sort(bidders.begin(), bidders.end(), [&](std::size_t a, std::size_t b) {
      return table.least_s(row, a) < table.least_s(row, b);
    });
    const bool given = std::any_of(bidders.begin(), bidders.end(), [&](std::size_t column) {
      return choice.at_hand(column) && table.possible(row, column) && choice.try_give(row, column);
    });
    if (!given) return false;
  }
  return true;
}

/// Neither method looks at the range that waiting for the others costs: whoever's range ends first
/// is left out and the choice is made again.
template <class Choose>
MethodResult with_enough_range(AllocationTable& table, const Choose& choose) {
  MethodResult result;
  std::vector<char> banned(table.columns(), 0);
  for (std::size_t attempt = 0; attempt < table.columns() && !result.plan; ++attempt) {
    const std::optional<std::vector<int>> column_of = choose(banned);
    if (!column_of) break;
    result.plan = table.timed(*column_of, true);
    std::size_t first_row = 0;
    const auto ends_s = [&](std::size_t row) {
      return table.greatest_s(row, static_cast<std::size_t>((*column_of)[row]));
    };
    for (std::size_t row = 1; row < table.rows(); ++row) {
      if (ends_s(row) < ends_s(first_row)) first_row = row;
    }
    banned[static_cast<std::size_t>((*column_of)[first_row])] = 1;
  }
  return result;
}

}  // namespace

MethodResult polynomial_allocation(AllocationTable& table) {
  table.measure_all();
  const std::vector<std::size_t> order = by_arrival(table);
  return with_enough_range(table,
                           [&](const std::vector<char>& banned) -> std::optional<std::vector<int>> {
                             Choice choice{table, false};
                             if (!form_coalition(order, banned, choice)) return std::nullopt;
                             if (!choose_tasks(table, order, choice)) return std::nullopt;
                             return choice.column_of();
                           });
}

MethodResult greedy_allocation(AllocationTable& table) {
  table.measure_all();
  return with_enough_range(table,
                           [&](const std::vector<char>& banned) -> std::optional<std::vector<int>> {
                             Choice choice{table, true};
                             for (std::size_t c = 0; c < table.columns(); ++c) {
                               if (banned[c] != 0) choice.set_at_hand(c, false);
                             }
                             if (!tender_tasks(table, choice)) return std::nullopt;
                             return choice.column_of();
                           });
}

}  // namespace skein::planning
