// SPDX-License-Identifier: Apache-2.0
#include "site_book.hpp"

#include <algorithm>

#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {
constexpr std::size_t kSitesMax = 64;  ///< what a flood from the network can make us remember
}

void SiteBook::on_leader(const Site& site, Instant said_at) {
  if (closed_.contains(site.id)) return;
  if (!entries_.contains(site.id) && entries_.size() >= kSitesMax) {
    const auto over = std::ranges::find_if(entries_, [](const auto& e) { return e.second.closed; });
    if (over == entries_.end()) return;
    closed_.insert(over->first);
    entries_.erase(over);
  }
  Entry& entry = entries_[site.id];
  entry.site = site;
  entry.heard_at = std::max(entry.heard_at, said_at);
}

void SiteBook::on_renewal(const coalition::LeaseRenewal& message, Instant now) {
  const auto known = entries_.find(message.site);
  if (known == entries_.end()) return;
  known->second.heard_at = now;
  known->second.closed = known->second.closed || message.closed;
  for (const auto& task : message.done) note_over(known->second, task);
  for (const auto& task : message.unknown) note_over(known->second, task);
}

void SiteBook::on_status(const coalition::MemberStatus& message) {
  for (const auto& entry : message.tasks) {
    const auto known = entries_.find(entry.task.site);
    const bool over = entry.state == coalition::TaskState::done;
    if (known != entries_.end() && over) note_over(known->second, entry.task);
  }
}

void SiteBook::note_over(Entry& entry, const TaskId& task) {
  if (task.site != entry.site.id || task.kind == TaskKind::survey) return;
  if (task.index >= task_count(entry.site, task.kind)) return;
  if (contains(entry.over, task)) return;
  entry.over.push_back(task);
}

void SiteBook::close(SiteId site) {
  const auto known = entries_.find(site);
  if (known != entries_.end()) known->second.closed = true;
}

void SiteBook::forget(SiteId site) {
  entries_.erase(site);
  closed_.insert(site);
}

std::vector<const SiteBook::Entry*> SiteBook::lost(Instant before) const {
  std::vector<const Entry*> all;
  for (const auto& [site, entry] : entries_) {
    if (!entry.closed && entry.heard_at < before) all.push_back(&entry);
  }
  return all;
}

const SiteBook::Entry* SiteBook::lost(SiteId site, Instant before) const {
  const auto known = entries_.find(site);
  if (known == entries_.end() || known->second.closed || known->second.heard_at >= before) {
    return nullptr;
  }
  return &known->second;
}

std::vector<TaskId> SiteBook::over(SiteId site) const {
  const auto known = entries_.find(site);
  return known == entries_.end() ? std::vector<TaskId>{} : known->second.over;
}

bool SiteBook::led(SiteId site, Instant since) const {
  const auto known = entries_.find(site);
  if (known == entries_.end()) return closed_.contains(site);
  return known->second.closed || known->second.heard_at >= since;
}

}  // namespace skein::mission
