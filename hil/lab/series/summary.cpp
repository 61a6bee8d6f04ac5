// SPDX-License-Identifier: Apache-2.0
#include "skein/series/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace skein::series {
namespace {

/// Failing seeds that are told of in full, and excused ones that are named.
constexpr std::size_t kShown = 20;

std::string who(VehicleId vehicle) {
  return vehicle == kGroundStation ? "-" : fmt::format("U{}", vehicle.value);
}

/// Numbers taken out: what differs only in them is one reason.
std::string kind_of(const std::string& reason) {
  std::string text;
  for (const char c : reason) {
    const bool digit = (c >= '0' && c <= '9') || c == '.';
    if (!digit) text += c;
    if (digit && (text.empty() || text.back() != '#')) text += '#';
  }
  return text;
}

}  // namespace

std::string broken_lines(const RunRow& row, bool formation) {
  std::string text;
  for (const Broken& check : row.broken) {
    text += fmt::format("  {}: {:.2f} s, ", check.check, check.first_s);
    if (!formation) text += who(check.vehicle) + ": ";
    text += check.sentence;
    if (check.violations > 1) text += fmt::format(" (and {} more)", check.violations - 1);
    text += '\n';
  }
  return text;
}

Summary::Summary(shards::Series series, std::string program)
    : series_{std::move(series)},
      program_{std::move(program)},
      formation_{series_.kind == kFormation} {}

std::string Summary::again(const RunRow& row) const {
  return fmt::format("  again: {} simulate {} --seed {}{} --trace\n", program_, series_.file,
                     row.seed, shards::options_of(series_));
}

void Summary::add(const RunRow& row) {
  if (runs_++ == 0) first_seed_ = row.seed;
  last_seed_ = row.seed;
  if (!row.held() && ++violated_ <= kShown) {
    failures_ +=
        fmt::format("seed {} VIOLATED\n", row.seed) + broken_lines(row, formation_) + again(row);
  }
  std::set<std::string> checks;
  for (const Broken& check : row.broken) checks.insert(check.check);
  for (const std::string& check : checks) ++checks_[check];
  if (row.excused > 0) {
    excused_ += row.excused;
    if (++excused_runs_ <= kShown)
      excused_seeds_ += fmt::format("{} {}", excused_runs_ == 1 ? " seeds" : ",", row.seed);
    if (excused_runs_ == kShown + 1) excused_seeds_ += ", ...";
  }
  all_s_ += row.ended_s;
  least_m_ = std::min(least_m_, row.least_m);
  lost_ += row.lost;
  if (!row.done) {
    ++reasons_[kind_of(row.reason)];
    return;
  }
  least_s_ = done_ == 0 ? row.ended_s : std::min(least_s_, row.ended_s);
  most_s_ = std::max(most_s_, row.ended_s);
  done_s_ += row.ended_s;
  ++done_;
}

std::string Summary::of_sites() const {
  std::string text = fmt::format("runs       {}, seeds {} to {}\n", runs_, first_seed_, last_seed_);
  text += fmt::format("violated   {}", violated_);
  for (const auto& [check, runs] : checks_) text += fmt::format("; {} {}", check, runs);
  if (excused_runs_ > 0) {
    text += fmt::format("\nexcused    {} in {} runs, proven unavoidable:{}", excused_,
                        excused_runs_, excused_seeds_);
  }
  text += fmt::format("\nall sites  done in {} runs", done_);
  if (done_ > 0) {
    text += fmt::format(", after {:.1f} s at least, {:.1f} s on average, {:.1f} s at most",
                        least_s_, done_s_ / static_cast<double>(done_), most_s_);
  }
  return text + "\n";
}

std::string Summary::of_formation() const {
  std::string text =
      fmt::format("runs       {}, seeds {} to {}, {:.0f} s of mission time each on average\n",
                  runs_, first_seed_, last_seed_, all_s_ / static_cast<double>(runs_));
  text += fmt::format("violated   {}\n", violated_);
  text += fmt::format("separation {:.2f} m at least; {:g} m are wanted\n", least_m_,
                      series_.separation_m);
  text += fmt::format("lost       {} vehicles\n", lost_);
  text += fmt::format("script     done in {} runs\n", done_);
  for (const auto& [reason, count] : reasons_)
    text += fmt::format("held       {}: {}\n", count, reason);
  return text;
}

std::string Summary::text() const {
  std::string text = failures_;
  if (violated_ > kShown) text += fmt::format("... and {} seeds more\n", violated_ - kShown);
  return text + (formation_ ? of_formation() : of_sites()) + (held() ? "PASS\n" : "FAIL\n");
}

}  // namespace skein::series
