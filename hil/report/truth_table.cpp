// SPDX-License-Identifier: Apache-2.0
#include "truth_table.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/checks/truth.hpp"
#include "skein/report/report.hpp"

namespace skein::report {
namespace {

std::string metres(const checks::Spread& spread) {
  return fmt::format("{:.2f} / {:.2f} m", spread.rms, spread.most);
}

TruthTable::Row row_of(std::string who, std::string which, const checks::PlanErrors& errors) {
  if (errors.points == 0) {
    return {std::move(who), std::move(which),
            fmt::format("never within {:.0f} m of its plan", checks::kJoined_m), "", ""};
  }
  return {std::move(who), std::move(which), metres(errors.cross_m), metres(errors.along_m),
          metres(errors.height_m)};
}

TruthTable::Row row_of(std::string who, std::string which, const checks::DeliveryFlown& flown) {
  return {std::move(who), std::move(which), fmt::format("{:+.2f} s", flown.time_error_s()),
          fmt::format("{:.1f} m", flown.miss_m),
          fmt::format("{:+.1f} deg", degrees(flown.bearing_error_rad))};
}

void add_rows(TruthTable& table, std::string who, const checks::OffPlace& off) {
  const auto add = [&](const char* which, const std::optional<checks::Spread>& spread) {
    if (!spread) return;
    table.rows.push_back(
        {std::exchange(who, ""), which, metres(*spread) + " from its place", "", ""});
  };
  add("in place", off.in_place);
  add("level", off.level);
  add("climbing", off.climbing);
}

}  // namespace

TruthTable truth_table(const checks::RunRecord& record, const checks::Limits& limits) {
  TruthTable table;
  for (const auto& flown : checks::flown_truly(record, limits)) {
    const std::string who = fmt::format("vehicle {}", flown.vehicle.value);
    if (flown.off_place_m.known()) {
      add_rows(table, who, flown.off_place_m);
    } else {
      table.rows.push_back(row_of(who, "believed", flown.believed));
      table.rows.push_back(row_of("", "true", flown.truly));
    }
    table.rows.push_back({"", "apart", metres(flown.apart_m), "", ""});
  }
  for (const auto& delivery : checks::deliveries_truly(record, limits)) {
    const auto& run = delivery.believed.run;
    table.rows.push_back(row_of(fmt::format("delivery {}.{} of vehicle {}", run.task.site.value,
                                            run.task.index + 1, run.vehicle.value),
                                "believed", delivery.believed));
    table.rows.push_back(row_of("", "true", delivery.truly));
  }
  return table;
}

std::string truth_text(const checks::RunRecord& record, const checks::Limits& limits) {
  const TruthTable table = truth_table(record, limits);
  if (table.rows.empty()) return "";
  std::string text;
  const auto add = [&text](const TruthTable::Row& row) {
    std::string line =
        fmt::format("{:<27} {:<9} {:<18} {:<18} {}", row[0], row[1], row[2], row[3], row[4]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add(table.head);
  for (const auto& row : table.rows) add(row);
  return text + "\n";
}

}  // namespace skein::report
