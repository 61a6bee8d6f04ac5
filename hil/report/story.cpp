// SPDX-License-Identifier: Apache-2.0
#include "story.hpp"

#include <algorithm>

#include "skein/checks/task_runs.hpp"

namespace skein::report {
namespace {

using mission::EventKind;
using mission::MissionEvent;

constexpr std::size_t kColours = 6;
// A bid of which no answer was recorded.
constexpr Duration kBidUnanswered = std::chrono::seconds{2};

bool answers_bid(EventKind kind) {
  return kind == EventKind::lease_granted || kind == EventKind::released ||
         kind == EventKind::cancelled || kind == EventKind::refused || kind == EventKind::bid_sent;
}

void add_bids(const std::vector<MissionEvent>& events, Story& story) {
  for (auto bid = events.begin(); bid != events.end(); ++bid) {
    if (bid->kind() != EventKind::bid_sent) continue;
    const auto answer = std::find_if(bid + 1, events.end(),
                                     [](const MissionEvent& e) { return answers_bid(e.kind()); });
    const Instant until = answer == events.end() ? bid->time + kBidUnanswered : answer->time;
    story.spans.push_back({Doing::bidding, bid->time, until, bid->task.site});
  }
}

/// From the survey's end until the coalition stands, monitoring included.
void add_leading(const std::vector<MissionEvent>& events, Instant end, Story& story) {
  for (auto done = events.begin(); done != events.end(); ++done) {
    if (done->kind() != EventKind::survey_done) continue;
    const auto formed = std::find_if(done + 1, events.end(), [&](const MissionEvent& e) {
      return e.task.site == done->task.site &&
             (e.kind() == EventKind::coalition_formed || e.kind() == EventKind::site_done);
    });
    story.spans.push_back(
        {Doing::leading, done->time, formed == events.end() ? end : formed->time, done->task.site});
  }
}

Doing doing_of(TaskKind kind) {
  switch (kind) {
    case TaskKind::survey:
      return Doing::surveying;
    case TaskKind::deliver:
      return Doing::delivering;
    case TaskKind::assess:
      return Doing::assessing;
    case TaskKind::count:
      break;
  }
  return Doing::flying;
}

}  // namespace

std::vector<Story> stories(const checks::RunRecord& record) {
  const auto leases = checks::leases(record);
  const auto runs = checks::task_runs(record);
  std::vector<Story> all;
  for (const auto& recorded : record.recordings) {
    if (recorded.track.empty()) continue;
    const Instant end = recorded.track.back().state.time;
    Story story{recorded.vehicle,
                {{Doing::searching, recorded.track.front().state.time, end, std::nullopt}}};
    add_leading(recorded.events, end, story);
    add_bids(recorded.events, story);
    for (const auto& lease : leases) {
      if (lease.vehicle != recorded.vehicle) continue;
      story.spans.push_back({Doing::flying, lease.from, lease.until, lease.task.site});
    }
    for (const auto& run : runs) {
      if (run.vehicle != recorded.vehicle || !run.started || !run.done) continue;
      story.spans.push_back({doing_of(run.task.kind), *run.started, *run.done, run.task.site});
    }
    for (Span& span : story.spans) span.until = std::min(span.until, end);
    std::erase_if(story.spans, [](const Span& span) { return span.until <= span.from; });
    all.push_back(std::move(story));
  }
  return all;
}

std::optional<SiteId> site_at(const Story& story, Instant time) {
  std::optional<SiteId> site;
  for (const Span& span : story.spans) {
    if (span.doing == Doing::bidding || time < span.from || time >= span.until) continue;
    site = span.site;
  }
  return site;
}

std::size_t colour_of(const checks::RunRecord& record, std::optional<SiteId> site) {
  if (!site) return 0;
  for (std::size_t i = 0; i < record.sites.size(); ++i) {
    if (record.sites[i].id == *site) return i % kColours + 1;
  }
  return 0;
}

std::size_t colour_of(VehicleId vehicle) { return (vehicle.value - 1U) % kColours + 1; }

}  // namespace skein::report
