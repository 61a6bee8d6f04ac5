// SPDX-License-Identifier: Apache-2.0
#include "alarm_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "news_delay.hpp"
#include "skein/mission/shown_state.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using mission::FleetEntry;
using mission::ShownState;
using Topic = AlarmNews::Topic;

/// After a start vehicles take a while to be heard.
constexpr Duration kStart = std::chrono::seconds{15};
/// What a vehicle says of others counts no more when it is silent for longer.
constexpr Duration kWordCounts = std::chrono::seconds{30};

std::string name_of(VehicleId vehicle) { return wording::text_of(vehicle); }

ShownState state_of(const FleetEntry& entry) { return mission::shown_state(entry); }
ShownState state_of(const mission::Telemetry& told) {
  return mission::shown_state(told.activity, told.detail);
}
bool is_heard(const FleetEntry& entry, const Scene& in) {
  return entry.telemetry && in.now < entry.heard_at + in.fleet.silence();
}
/// It may be switched off there.
bool is_down(ShownState state) { return state == ShownState::landed; }
bool is_on_ground(ShownState state) {
  return is_down(state) || state == ShownState::on_the_ground ||
         state == ShownState::waiting_for_the_start;
}
bool is_missed(const FleetEntry& entry) {
  return entry.expected && !entry.revoked &&
         !(entry.telemetry && is_down(state_of(*entry.telemetry)));
}

// --- of the fleet ---

void find_nobody(const Scene& in, std::vector<Found>& found) {
  Instant last = in.begun + kStart - in.fleet.silence();
  bool ever = false;
  bool missed = false;
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (is_heard(entry, in)) return;
    missed = missed || is_missed(entry);
    if (!entry.telemetry) continue;
    last = ever ? std::max(last, entry.heard_at) : entry.heard_at;
    ever = true;
  }
  const Instant since = last + in.fleet.silence();
  if (!missed || in.now < since) return;
  found.push_back({{AlarmKind::nobody_heard},
                   since,
                   ever ? fmt::format("nobody is heard any more, since {:.1f} s", to_seconds(last))
                        : "nobody has been heard yet"});
}

void find_silent(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.telemetry || !is_missed(entry) || is_heard(entry, in)) continue;
    const auto& told = *entry.telemetry;
    const bool flew = !is_on_ground(state_of(told));
    found.push_back(
        {{AlarmKind::vehicle_silent, id},
         entry.heard_at + in.fleet.silence(),
         fmt::format("{} is silent: heard last at {:.1f} s, {}, {}, at {:.0f} m", name_of(id),
                     to_seconds(entry.heard_at), mission::words_of(state_of(told)),
                     wording::place_text({told.state.x_m, told.state.y_m}), told.state.z_m),
         0,
         flew ? std::nullopt : std::optional{AlarmLevel::warning}});
  }
}

void find_missing(const Scene& in, std::vector<Found>& found) {
  if (in.now < in.begun + kStart) return;
  const auto heard = [](const auto& one) { return one.second.telemetry.has_value(); };
  if (std::ranges::none_of(in.fleet.vehicles(), heard)) return;
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.expected || entry.telemetry || entry.revoked) continue;
    found.push_back({{AlarmKind::vehicle_missing, id},
                     in.begun + kStart,
                     name_of(id) + " is of the fleet, and was never heard"});
  }
}

void find_held(const Scene& in, std::vector<Found>& found) {
  Instant since{Instant::min()};
  std::size_t held = 0;
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.expected || !is_heard(entry, in) || is_on_ground(state_of(entry))) continue;
    if (state_of(entry) != ShownState::holding_by_order) return;
    ++held;
    const auto picture = in.picture.vehicles().find(id);
    if (picture != in.picture.vehicles().end() && !picture->second.spans.empty()) {
      since = std::max(since, picture->second.spans.back().from);
    }
  }
  if (held == 0) return;
  found.push_back({{AlarmKind::all_held},
                   since == Instant::min() ? in.now : since,
                   held == 1 ? "the one vehicle in the air holds by order"
                             : fmt::format("all {} vehicles in the air hold by order", held)});
}

void find_reserve(const Scene& in, std::vector<Found>& found) {
  const auto [first, last] = in.news.of(Topic::range_spent);
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.telemetry) continue;
    const auto told =
        std::find_if(first, last, [v = id](const auto& one) { return one.first.vehicle == v; });
    const ShownState state = state_of(*entry.telemetry);
    if (told == last && state != ShownState::range_reserve) continue;
    const std::string is =
        state == ShownState::at_home ? "it orbits at home, to be landed" : mission::words_of(state);
    found.push_back(
        {{AlarmKind::range_reserve, id},
         told == last ? in.now : told->second.since,
         fmt::format("{} has only the range for its way home left: {}", name_of(id), is)});
  }
}

void find_overdrawn(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.telemetry || entry.telemetry->range_left_m >= 0.0) continue;
    const ShownState state = state_of(*entry.telemetry);
    if (state == ShownState::landing || is_on_ground(state)) continue;
    found.push_back(
        {{AlarmKind::range_overdrawn, id}, in.now, name_of(id) + ": its range is overdrawn"});
  }
}

void find_left_fence(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.telemetry || state_of(*entry.telemetry) != ShownState::back_into_its_fence) continue;
    found.push_back({{AlarmKind::left_fence, id},
                     in.now,
                     name_of(id) + " has left its fence, or would soon: it flies home"});
  }
}

void find_duplicates(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.duplicate) continue;
    found.push_back(
        {{AlarmKind::duplicate_id, id},
         in.now,
         "two programs call themselves " + name_of(id) + ": nothing is commanded to it"});
  }
}

void find_strangers(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (entry.expected || !is_heard(entry, in)) continue;
    found.push_back(
        {{AlarmKind::stranger, id}, in.now, name_of(id) + " is heard, and is not of this fleet"});
  }
}

void find_revoked(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    const bool flies = entry.telemetry && !is_on_ground(state_of(*entry.telemetry));
    if (!entry.revoked || !flies) continue;
    found.push_back({{AlarmKind::revoked, id},
                     in.now,
                     name_of(id) + " was put out of the mission in the air: nobody hears it"});
  }
}

/// Whatever else a vehicle's program finds wrong, where no other alarm is about it.
void find_problems(const Scene& in, std::vector<Found>& found) {
  for (const auto& [id, entry] : in.fleet.vehicles()) {
    if (!entry.health || entry.health->problems.empty() || !is_heard(entry, in)) continue;
    // It has said that before it has told that it is clear: no news.
    if (entry.health->time <= in.news.clear_since(id)) continue;
    const auto told_of = [v = id](const Found& other) {
      return other.key.vehicle == v || other.key.other == v;
    };
    if (std::ranges::any_of(found, told_of)) continue;
    found.push_back({{AlarmKind::vehicle_problem, id},
                     in.now,
                     name_of(id) + ": " + entry.health->problems.front()});
  }
}

// --- of decisions and orders ---

void find_runs_out(const Scene& in, std::vector<Found>& found) {
  for (const AuthorisationPicture& one : in.picture.authorisations()) {
    const auto& request = one.request;
    const Instant last_third = request.decide_by - (request.decide_by - one.asked_at) / 3;
    if (one.decision || one.replaced || in.now < last_third || in.now >= request.decide_by)
      continue;
    found.push_back(
        {{.kind = AlarmKind::decision_runs_out,
          .site = request.site,
          .detail = request.round.number},
         last_third,
         fmt::format("site {}: {} for your decision, until {:.1f} s", request.site.value,
                     request.deliveries.size() == 1
                         ? "a delivery waits"
                         : fmt::format("{} deliveries wait", request.deliveries.size()),
                     to_seconds(request.decide_by))});
  }
}

struct Lapses {
  std::uint32_t count = 0;
  Instant since{};
};

/// Of each site, since it was decided last.
std::map<SiteId, Lapses> lapses_of(const Picture& picture, Instant now) {
  std::map<SiteId, Lapses> all;
  const auto& requests = picture.authorisations();
  for (auto one = requests.begin(); one != requests.end(); ++one) {
    Lapses& site = all[one->request.site];
    if (one->decision) {
      site = {};
      continue;
    }
    const auto next = std::find_if(std::next(one), requests.end(), [&](const auto& later) {
      return later.request.site == one->request.site &&
             later.request.round.coalition == one->request.round.coalition;
    });
    const Instant until = one->replaced && next != requests.end() ? next->asked_at : now;
    if (until < one->request.decide_by) continue;
    if (site.count++ == 0) site.since = one->request.decide_by;
  }
  return all;
}

void find_lapsed(const Scene& in, std::vector<Found>& found) {
  for (const auto& [site, lapses] : lapses_of(in.picture, in.now)) {
    const auto known = in.picture.sites().find(site);
    const bool is_over = known != in.picture.sites().end() && known->second.over();
    if (lapses.count == 0 || is_over) continue;
    found.push_back(
        {{.kind = AlarmKind::decision_lapsed, .site = site},
         lapses.since,
         fmt::format("site {}: nobody has decided in time{}; its deliveries are not flown",
                     site.value, lapses.count == 1 ? "" : fmt::format(", {} times", lapses.count)),
         lapses.count});
  }
}

void find_no_answer(const Scene& in, std::vector<Found>& found) {
  for (const GivenOrder& order : in.orders.orders()) {
    const Instant since = order.given + OrderAnswers::kPatience;
    if (in.now < since) continue;
    for (const VehicleId vehicle : order.waiting) {
      found.push_back({{.kind = AlarmKind::no_answer, .vehicle = vehicle, .site = order.site},
                       since,
                       fmt::format("{} has not answered '{}', given at {:.1f} s", name_of(vehicle),
                                   line_of(order), to_seconds(order.given))});
    }
  }
}

void find_search(const Scene& in, std::vector<Found>& found) {
  if (!in.search) return;
  found.push_back({{AlarmKind::search_ended},
                   in.search->since,
                   in.search->what,
                   in.search->edition,
                   in.search->is_wanted ? std::optional{AlarmLevel::notice} : std::nullopt});
}

void find_proposals(const Scene& in, std::vector<Found>& found) {
  for (const auto& [number, proposal] : in.picture.proposals()) {
    found.push_back(
        {{.kind = AlarmKind::proposal_waits, .detail = number},
         proposal.at,
         fmt::format("proposal {} waits for you: {} at {}", number, to_string(proposal.said.kind),
                     wording::place_text({proposal.said.x_m, proposal.said.y_m}))});
  }
}

// --- of news ---

template <Topic Of, AlarmKind Kind>
void find_news(const Scene& in, std::vector<Found>& found) {
  const auto [first, last] = in.news.of(Of);
  for (auto one = first; one != last; ++one) {
    const auto& [key, item] = *one;
    found.push_back({{Kind, key.vehicle, key.other, key.site, key.detail}, item.since, item.what});
  }
}

/// Only those that somebody must act on, or only the others.
template <Topic Of, AlarmKind Kind, bool Grave>
void find_graded(const Scene& in, std::vector<Found>& found) {
  const auto [first, last] = in.news.of(Of);
  for (auto one = first; one != last; ++one) {
    const auto& [key, item] = *one;
    if (item.grave != Grave) continue;
    found.push_back({.key = {Kind, key.vehicle, key.other, key.site, key.detail},
                     .since = item.since,
                     .what = item.what,
                     .closest = item.closest});
  }
}

/// Of two that come too near to each other either may tell: the worse word counts.
template <AlarmKind Kind, bool Grave>
void find_separation(const Scene& in, std::vector<Found>& found) {
  const auto [first, last] = in.news.of(Topic::separation);
  std::map<std::pair<VehicleId, VehicleId>, const AlarmNews::Item*> pairs;
  for (auto one = first; one != last; ++one) {
    const auto [low, high] = std::minmax(one->first.vehicle, one->first.other);
    const auto [known, fresh] = pairs.try_emplace({low, high}, &one->second);
    if (!fresh && one->second.grave && !known->second->grave) known->second = &one->second;
  }
  for (const auto& [pair, item] : pairs) {
    if (item->grave != Grave) continue;
    found.push_back({.key = {.kind = Kind, .vehicle = pair.first, .other = pair.second},
                     .since = item->since,
                     .what = item->what,
                     .closest = item->closest});
  }
}

void find_trouble(const Scene& in, std::vector<Found>& found) {
  for (const Topic topic : {Topic::orders_unknown, Topic::id_in_use, Topic::landing_barred}) {
    const auto [first, last] = in.news.of(topic);
    for (auto one = first; one != last; ++one) {
      found.push_back({{.kind = AlarmKind::vehicle_trouble,
                        .vehicle = one->first.vehicle,
                        .detail = static_cast<std::uint64_t>(topic)},
                       one->second.since,
                       one->second.what});
    }
  }
}

constexpr Duration kAtOnce{};
constexpr Duration kSteady = std::chrono::seconds{2};
constexpr auto kNone = mission::CommandKind::count;
constexpr auto kHold = mission::CommandKind::hold;
constexpr auto kResume = mission::CommandKind::resume;
constexpr auto kReturn = mission::CommandKind::return_home;
constexpr auto kLand = mission::CommandKind::land;
constexpr auto kGiveBack = mission::CommandKind::give_back;

using enum AlarmKind;
constexpr auto kAlarm = AlarmLevel::alarm;
constexpr auto kWarning = AlarmLevel::warning;
constexpr auto kNotice = AlarmLevel::notice;

constexpr std::array<KindRow, static_cast<std::size_t>(AlarmKind::count)> kRows{{
    {nobody_heard,
     "nobody_heard",
     kAlarm,
     kSteady,
     "fleet",
     {kNone, kNone},
     "look at this station's radio and network; the vehicles fly on by themselves",
     &find_nobody},
    {nobody_commands,
     "nobody_commands",
     kAlarm,
     kAtOnce,
     "orders",
     {kNone, kNone},
     "take the command here, or see to the ground station that has it",
     &find_news<Topic::nobody_commands, nobody_commands>},
    {separation_no_room,
     "separation_no_room",
     kAlarm,
     kSteady,
     "fleet",
     {kHold, kReturn},
     "move one of them now: neither has room to give way by itself",
     &find_separation<separation_no_room, true>},
    {traffic_no_room,
     "traffic_no_room",
     kAlarm,
     kSteady,
     "fleet",
     {kHold, kReturn},
     "move it now: it has no room to give way by itself",
     &find_graded<Topic::traffic, traffic_no_room, true>},
    {left_fence,
     "left_fence",
     kAlarm,
     kSteady,
     "fleet",
     {kResume, kLand},
     "look why; 'resume' when it may go on, else land it at home",
     &find_left_fence},
    {vehicle_silent,
     "vehicle_silent",
     kAlarm,
     kSteady,
     "fleet",
     {kNone, kNone},
     "look for it from where it was heard last; the others take over its work",
     &find_silent},
    {decision_runs_out,
     "decision_runs_out",
     kAlarm,
     kAtOnce,
     "decisions",
     {kNone, kNone},
     "authorise or refuse it now",
     &find_runs_out},
    {decision_lapsed,
     "decision_lapsed",
     kAlarm,
     kAtOnce,
     "decisions",
     {kNone, kNone},
     "authorise or refuse it when it is asked again, or withdraw the site",
     &find_lapsed},
    {no_answer,
     "no_answer",
     kAlarm,
     kAtOnce,
     "fleet",
     {kHold, kReturn},
     "it may not have heard it: give the order again, and look whether it is heard",
     &find_no_answer},
    {range_reserve,
     "range_reserve",
     kAlarm,
     kSteady,
     "fleet",
     {kReturn, kLand},
     "land it at home, or have it recovered where it holds: at the end of its range it lands there",
     &find_reserve},
    {range_overdrawn,
     "range_overdrawn",
     kAlarm,
     kSteady,
     "fleet",
     {kReturn, kLand},
     "have it landed or recovered at once",
     &find_overdrawn},
    {autopilot_trouble,
     "autopilot_trouble",
     kAlarm,
     kSteady,
     "fleet",
     {kGiveBack, kReturn},
     "its pilot must take it, or look at its flight controller",
     &find_graded<Topic::autopilot, autopilot_trouble, true>},
    {vehicle_trouble,
     "vehicle_trouble",
     kAlarm,
     kSteady,
     "fleet",
     {kResume, kReturn},
     "see what it says, and order what it shall do",
     &find_trouble},
    {task_unknown,
     "task_unknown",
     kAlarm,
     kAtOnce,
     "mission",
     {kNone, kNone},
     "look whether it was delivered, then withdraw or change the site",
     &find_news<Topic::task_unknown, task_unknown>},
    {duplicate_id,
     "duplicate_id",
     kAlarm,
     kSteady,
     "fleet",
     {kNone, kNone},
     "stop or renumber one of them",
     &find_duplicates},
    {setup_differs,
     "setup_differs",
     kAlarm,
     kSteady,
     "preflight",
     {kNone, kNone},
     "give it what the ground station runs with, and start it anew",
     &find_news<Topic::setup_differs, setup_differs>},
    {formation_lost,
     "formation_lost",
     kAlarm,
     kSteady,
     "orders",
     {kHold, kNone},
     "the others keep clear of its way: look for it, or order the others to rally",
     &find_news<Topic::formation_lost, formation_lost>},
    {command_elsewhere,
     "command_elsewhere",
     kAlarm,
     kAtOnce,
     "orders",
     {kNone, kNone},
     "give no orders here: whoever has the command does",
     &find_news<Topic::command_elsewhere, command_elsewhere>},
    {separation,
     "separation",
     kWarning,
     kSteady,
     "fleet",
     {kHold, kReturn},
     "watch them: one gives way by its height",
     &find_separation<separation, false>},
    {traffic,
     "traffic",
     kWarning,
     kSteady,
     "fleet",
     {kHold, kReturn},
     "watch it: it gives way by its height",
     &find_graded<Topic::traffic, traffic, false>},
    {traffic_unseen,
     "traffic_unseen",
     kWarning,
     kSteady,
     "fleet",
     {kNone, kNone},
     "look after the receiver; until then nobody gives way to aircraft",
     &find_news<Topic::traffic_unseen, traffic_unseen>},
    {all_held,
     "all_held",
     kWarning,
     kSteady,
     "orders",
     {kResume, kReturn},
     "'resume all' when they may go on: nothing is searched or delivered meanwhile",
     &find_held},
    {formation_waits,
     "formation_waits",
     kWarning,
     kSteady,
     "orders",
     {kResume, kNone},
     "see whom it waits for",
     &find_news<Topic::change_waits, formation_waits>},
    {order_waits,
     "order_waits",
     kWarning,
     kSteady,
     "orders",
     {kNone, kNone},
     "see why it cannot be given",
     &find_news<Topic::order_waits, order_waits>},
    {task_lost,
     "task_lost",
     kWarning,
     kAtOnce,
     "mission",
     {kNone, kNone},
     "see whether another vehicle takes it up",
     &find_news<Topic::task_lost, task_lost>},
    {search_ended,
     "search_ended",
     kWarning,
     kAtOnce,
     "areas",
     {kNone, kNone},
     "have what was not seen shared out again ('search rest') when they are free; acknowledge to "
     "dismiss it",
     &find_search},
    {proposal_waits,
     "proposal_waits",
     kWarning,
     kAtOnce,
     "mission",
     {kNone, kNone},
     "accept or dismiss it",
     &find_proposals},
    {not_landed,
     "not_landed",
     kWarning,
     kAtOnce,
     "fleet",
     {kLand, kReturn},
     "look whether it is down; else order it to land again",
     &find_news<Topic::not_landed, not_landed>},
    {vehicle_missing,
     "vehicle_missing",
     kWarning,
     kSteady,
     "preflight",
     {kNone, kNone},
     "start it, or go on without it",
     &find_missing},
    {stranger,
     "stranger",
     kWarning,
     kSteady,
     "fleet",
     {kNone, kNone},
     "find out whose it is; the fleet works with it",
     &find_strangers},
    {revoked,
     "revoked",
     kWarning,
     kAtOnce,
     "fleet",
     {kNone, kNone},
     "have its pilot take it",
     &find_revoked},
    {autopilot_warning,
     "autopilot_warning",
     kWarning,
     kSteady,
     "fleet",
     {kGiveBack, kReturn},
     "see with its pilot",
     &find_graded<Topic::autopilot, autopilot_warning, false>},
    {vehicle_warning,
     "vehicle_warning",
     kWarning,
     kSteady,
     "orders",
     {kNone, kNone},
     "see why, and order anew",
     &find_news<Topic::change_refused, vehicle_warning>},
    {vehicle_problem,
     "vehicle_problem",
     kWarning,
     kSteady,
     "fleet",
     {kNone, kNone},
     "see what it says of itself in the fleet",
     &find_problems},
    {told, "told", kNotice, kAtOnce, "log", {kNone, kNone}, "", &find_news<Topic::told, told>},
}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (kRows[i].kind != static_cast<AlarmKind>(i)) return false;
  }
  return true;
}
static_assert(in_order());

// --- what ends by the picture ---

bool is_over(const AlarmNews::Key& key, const AlarmNews::Item& item, const Picture& picture) {
  const auto site = picture.sites().find(key.site);
  if (site == picture.sites().end()) return false;
  if (site->second.over()) return true;
  const auto task = site->second.tasks.find(item.task);
  if (task == site->second.tasks.end() || !task->second.state) return false;
  using coalition::TaskState;
  const TaskState state = *task->second.state;
  if (key.topic == Topic::task_unknown) return state == TaskState::done;
  return state == TaskState::planned || state == TaskState::started || state == TaskState::done;
}

bool is_over(Topic topic, ShownState state) {
  using enum ShownState;
  switch (topic) {
    case Topic::range_spent:
      return is_on_ground(state);
    case Topic::landing_barred:
      return state != at_home;
    case Topic::not_landed:
      return is_on_ground(state) || (state != landing && state != returning && state != at_home);
    default:
      return false;
  }
}

bool is_over(const AlarmNews::Key& key, const AlarmNews::Item& item, const Picture& picture,
             const mission::Fleet& fleet, Instant now) {
  if (key.topic == Topic::task_lost || key.topic == Topic::task_unknown) {
    return is_over(key, item, picture);
  }
  if (key.topic == Topic::told) return now >= item.since + AlarmNews::kTold;
  const auto known = fleet.vehicles().find(key.vehicle);
  if (known == fleet.vehicles().end() || !known->second.telemetry) return false;
  const FleetEntry& entry = known->second;
  if (key.topic == Topic::separation || key.topic == Topic::traffic) {
    return now >= entry.heard_at + kWordCounts;
  }
  const bool is_newer = entry.telemetry->state.time > item.since + kNewsMayTake;
  return is_newer && is_over(key.topic, state_of(*entry.telemetry));
}

}  // namespace

const std::array<KindRow, static_cast<std::size_t>(AlarmKind::count)>& alarm_kinds() {
  return kRows;
}

const KindRow& row_of(AlarmKind kind) { return kRows.at(static_cast<std::size_t>(kind)); }

void settle(AlarmNews& news, const Picture& picture, const mission::Fleet& fleet, Instant now) {
  std::vector<AlarmNews::Key> gone;
  for (const auto& [key, item] : news.items()) {
    if (is_over(key, item, picture, fleet, now)) gone.push_back(key);
  }
  for (const auto& key : gone) news.drop(key);
}

}  // namespace skein::console
