// SPDX-License-Identifier: Apache-2.0
#include "skein/console/alarms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "alarm_kinds.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using codec::Json;

/// So many looks are made up for where none was taken for long.
constexpr std::int64_t kLooksMax = 50;

Instant floor_of(Instant now) {
  const auto since = now.time_since_epoch();
  const auto rest = since % Alarms::kPeriod;
  return now - (rest < Duration{} ? rest + Alarms::kPeriod : rest);
}

/// Of what stands.
auto urgency(const Alarm& alarm) {
  return std::tuple{alarm.acknowledged.has_value(), alarm.level, alarm.key.kind, alarm.since,
                    alarm.number};
}

Json seconds(Instant t) { return std::round(to_seconds(t) * 1000.0) / 1000.0; }
template <class Id>
Json id_or_null(Id id) {
  return id == Id{} ? Json(nullptr) : Json(id.value);
}

Json alarm_json(const Alarm& alarm) {
  const KindRow& row = row_of(alarm.key.kind);
  Json offers = Json::array();
  for (const auto kind : row.offers) {
    if (kind != mission::CommandKind::count) offers.push_back(to_string(kind));
  }
  Json acknowledged = nullptr;
  if (const auto& a = alarm.acknowledged) {
    acknowledged = {{"by", a->by}, {"at_s", seconds(a->at)}};
  }
  return {{"number", alarm.number},
          {"key", text_of(alarm.key)},
          {"kind", row.name},
          {"level", to_string(alarm.level)},
          {"since_s", seconds(alarm.since)},
          {"over_s", alarm.over ? seconds(*alarm.over) : Json(nullptr)},
          {"what", alarm.what},
          {"remedy", alarm.remedy},
          {"closest_s", alarm.closest && !alarm.over ? seconds(*alarm.closest) : Json(nullptr)},
          {"times", alarm.times},
          {"vehicle", id_or_null(alarm.key.vehicle)},
          {"other", id_or_null(alarm.key.other)},
          {"site", id_or_null(alarm.key.site)},
          {"panel", row.panel},
          {"offers", std::move(offers)},
          {"acknowledged", std::move(acknowledged)}};
}

Json order_json(const GivenOrder& order) {
  Json answered = Json::array();
  for (const auto& [vehicle, after] : order.answered) {
    answered.push_back(
        {{"vehicle", vehicle.value}, {"after_s", std::round(to_seconds(after) * 1000.0) / 1000.0}});
  }
  Json waiting = Json::array();
  for (const VehicleId vehicle : order.waiting) waiting.push_back(vehicle.value);
  Json to = Json::array();
  for (const VehicleId vehicle : order.to) to.push_back(vehicle.value);
  return {{"kind", order.kind},
          {"line", line_of(order)},
          {"vehicles", order.decision ? Json(nullptr) : std::move(to)},
          {"site", id_or_null(order.site)},
          {"given_s", seconds(order.given)},
          {"answered", std::move(answered)},
          {"waiting", std::move(waiting)}};
}

std::string order_text(const GivenOrder& order) {
  std::string text = fmt::format("'{}' at {:.1f} s:", line_of(order), to_seconds(order.given));
  if (!order.answered.empty()) {
    const auto slowest = std::ranges::max_element(
        order.answered, [](const auto& a, const auto& b) { return a.second < b.second; });
    text += fmt::format(" {} answered, the last ({}) after {:.1f} s", order.answered.size(),
                        slowest->first.value, to_seconds(slowest->second));
  }
  std::string waiting;
  for (const VehicleId vehicle : order.waiting) {
    waiting += (waiting.empty() ? " not yet " : ", ") + std::to_string(vehicle.value);
  }
  return text + (order.answered.empty() || waiting.empty() ? "" : ";") + waiting + "\n";
}

}  // namespace

std::string_view to_string(AlarmLevel level) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(AlarmLevel::count)> kNames{
      "alarm", "warning", "notice"};
  return kNames.at(static_cast<std::size_t>(level));
}

std::string_view to_string(AlarmKind kind) { return row_of(kind).name; }

std::string text_of(const AlarmKey& key) {
  std::string text{to_string(key.kind)};
  if (key.vehicle != VehicleId{}) text += fmt::format("-{}", key.vehicle.value);
  if (key.other != VehicleId{}) text += fmt::format("-{}", key.other.value);
  if (key.site != SiteId{}) text += fmt::format("-site-{}", key.site.value);
  if (const auto more = key.detail; more != 0) text += fmt::format("-{:x}", key.detail);
  return text;
}

void Alarms::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  orders_.on_message(message, sender, now);
}

void Alarms::on_event(const mission::MissionEvent& event, Instant now) {
  news_.on_event(event, now);
  orders_.on_event(event, now);
}

void Alarms::recall(const mission::MissionEvent& event, Instant at) { news_.on_event(event, at); }

void Alarms::on_timeout(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  const Instant to = floor_of(now);
  if (!begun_) begun_ = to;
  const Instant from = looked_at_ ? *looked_at_ + kPeriod : to;
  for (Instant at = std::max(from, to - kLooksMax * kPeriod); at <= to; at += kPeriod) {
    look(picture, fleet, at);
  }
  looked_at_ = std::max(looked_at_.value_or(to), to);
}

void Alarms::look(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  settle(news_, picture, fleet, now);
  orders_.on_timeout(picture, fleet, now);
  std::vector<Found> all;
  const bool is_read = search_ && read_search_ && search_->begun == read_search_->begun &&
                       search_->edition <= read_search_->edition;
  const std::optional<EndedSearch> search = is_read ? std::nullopt : search_;
  const Scene scene{picture, fleet, news_, orders_, search, *begun_, now};
  for (const KindRow& row : alarm_kinds()) row.find(scene, all);
  for (auto& [key, alarm] : standing_) {
    if (!alarm.gone_since) alarm.gone_since = now;
  }
  for (Found& found : all) take(std::move(found));
  for (auto one = standing_.begin(); one != standing_.end();) {
    Alarm& alarm = one->second;
    if (!alarm.gone_since || now - *alarm.gone_since < row_of(alarm.key.kind).steady) {
      ++one;
      continue;
    }
    // Of a search another one has been ordered, or it was never to be told.
    const bool stays =
        alarm.level != AlarmLevel::notice && one->first.kind != AlarmKind::search_ended;
    if (!alarm.acknowledged && stays) {
      alarm.over = alarm.gone_since;
      over_.insert_or_assign(one->first, std::move(alarm));
    }
    one = standing_.erase(one);
  }
  while (over_.size() > kOverMax) {
    over_.erase(std::ranges::min_element(
        over_, [](const auto& a, const auto& b) { return a.second.number < b.second.number; }));
  }
}

void Alarms::take(Found found) {
  const KindRow& row = row_of(found.key.kind);
  auto [at, is_new] = standing_.try_emplace(found.key);
  Alarm& alarm = at->second;
  const bool is_worse = !is_new && found.edition > alarm.edition;
  if (is_new) {
    alarm.key = found.key;
    alarm.since = found.since;
    // It is back before anybody has seen that it was over.
    if (const auto before = over_.find(found.key); before != over_.end()) {
      alarm.times = before->second.times + 1;
      over_.erase(before);
    }
  }
  if (is_new || is_worse) {
    alarm.number = ++last_number_;
    alarm.acknowledged.reset();
  }
  alarm.edition = found.edition;
  alarm.level = found.level.value_or(row.level);
  alarm.what = std::move(found.what);
  alarm.remedy = row.remedy;
  alarm.closest = found.closest;
  alarm.gone_since.reset();
}

Result<std::vector<Alarm>> Alarms::acknowledge(const std::vector<std::uint32_t>& numbers,
                                               const std::string& by, Instant now) {
  std::vector<Alarm> done;
  const auto is_meant = [&](const Alarm& alarm) {
    return numbers.empty() || std::ranges::find(numbers, alarm.number) != numbers.end();
  };
  for (auto& [key, alarm] : standing_) {
    if (alarm.acknowledged || !is_meant(alarm)) continue;
    alarm.acknowledged = Acknowledgement{by, now};
    done.push_back(alarm);
    if (key.kind == AlarmKind::search_ended) read_search_ = search_;
    // What is told once is read now.
    if (key.kind == AlarmKind::told) {
      news_.drop({AlarmNews::Topic::told, key.vehicle, {}, {}, key.detail});
    }
  }
  for (auto one = over_.begin(); one != over_.end();) {
    if (!is_meant(one->second)) {
      ++one;
      continue;
    }
    done.push_back(std::move(one->second));
    one = over_.erase(one);
  }
  if (!done.empty()) return done;
  return Error{numbers.empty() ? "no alarm waits to be acknowledged"
                               : "no such alarm waits to be acknowledged; 'alarms' lists them"};
}

std::vector<const Alarm*> Alarms::list() const {
  std::vector<const Alarm*> all;
  for (const auto& [key, alarm] : standing_) all.push_back(&alarm);
  std::ranges::sort(all, [](const Alarm* a, const Alarm* b) { return urgency(*a) < urgency(*b); });
  const auto standing = static_cast<std::ptrdiff_t>(all.size());
  for (const auto& [key, alarm] : over_) all.push_back(&alarm);
  std::sort(all.begin() + standing, all.end(),
            [](const Alarm* a, const Alarm* b) { return urgency(*a) < urgency(*b); });
  return all;
}

AlarmCounts Alarms::counts() const {
  AlarmCounts counts;
  for (const auto& [key, alarm] : standing_) {
    counts.alarms += alarm.level == AlarmLevel::alarm ? 1 : 0;
    counts.warnings += alarm.level == AlarmLevel::warning ? 1 : 0;
    counts.notices += alarm.level == AlarmLevel::notice ? 1 : 0;
    counts.unacknowledged += alarm.acknowledged ? 0 : 1;
  }
  return counts;
}

std::string alarms_json(const Alarms& alarms) {
  const AlarmCounts counts = alarms.counts();
  Json json{{"counts",
             {{"alarm", counts.alarms},
              {"warning", counts.warnings},
              {"notice", counts.notices},
              {"unacknowledged", counts.unacknowledged}}},
            {"list", Json::array()},
            {"orders", Json::array()}};
  for (const Alarm* alarm : alarms.list()) json["list"].push_back(alarm_json(*alarm));
  for (const GivenOrder& order : alarms.orders().orders()) {
    json["orders"].push_back(order_json(order));
  }
  return codec::json_text(json);
}

std::string alarms_text(const Alarms& alarms, Instant now) {
  std::string text;
  for (const Alarm* alarm : alarms.list()) {
    const bool is_closing = alarm->closest && !alarm->over;
    text += fmt::format("{:>4}  {:<8} {:>7.1f} s  {}{}{}{}\n", alarm->number,
                        alarm->over ? "over" : to_string(alarm->level),
                        to_seconds((alarm->over ? *alarm->over : now) - alarm->since), alarm->what,
                        is_closing ? "; " + wording::closest_text(*alarm->closest, now) : "",
                        alarm->times > 1 ? fmt::format(" ({} times)", alarm->times) : "",
                        alarm->acknowledged ? "; acknowledged by " + alarm->acknowledged->by : "");
    if (!alarm->remedy.empty() && !alarm->over) text += "      what to do: " + alarm->remedy + "\n";
  }
  if (text.empty()) text = "no alarms\n";
  for (const GivenOrder& order : alarms.orders().orders()) text += order_text(order);
  return text;
}

}  // namespace skein::console
