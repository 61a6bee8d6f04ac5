// SPDX-License-Identifier: Apache-2.0
#include "picture_watch_test.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "skein/groundstation/views.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::hil {
namespace {

using Json = nlohmann::json;
using mission::CommandKind;
using mission::EventKind;

constexpr Duration kSilence = std::chrono::seconds{5};
/// Between two moments at which agents are asked what they are about.
constexpr Duration kStep = std::chrono::milliseconds{100};

std::string text_of(const TaskId& task) { return task.site == SiteId{} ? "" : to_string(task); }

TaskKind kind_of(const std::string& name) {
  if (name == "survey") return TaskKind::survey;
  return name == "deliver" ? TaskKind::deliver : TaskKind::assess;
}

TaskId task_of(SiteId site, const Json& task) {
  return {site, kind_of(task["kind"]), task["index"].get<std::uint8_t>()};
}

console::PictureParams params_of(const TeamMission& team) {
  console::PictureParams params;
  for (const auto& v : team.vehicles) {
    if (!v.flies_as) params.expected.push_back(v.spec.id);
  }
  return params;
}

/// The state in the second column of the table of `status`, "" without that vehicle.
std::string state_in(const std::string& table, VehicleId id) {
  constexpr std::size_t kFrom = 9;
  constexpr std::size_t kWidth = 26;
  std::istringstream lines{table};
  for (std::string line; std::getline(lines, line);) {
    if (std::strtol(line.c_str(), nullptr, 10) != id.value || line.size() < kFrom + kWidth)
      continue;
    std::string state = line.substr(kFrom, kWidth);
    state.erase(state.find_last_not_of(' ') + 1);
    std::ranges::replace(state, ' ', '_');
    return state;
  }
  return "";
}

}  // namespace

PictureWatch::PictureWatch(const TeamMission& team, Lateness late)
    : late_{late},
      ground_clock_{clock_offset(team.faults, kGroundStation)},
      origin_{*MissionOrigin::make({47.0, 8.0, 500.0})},
      picture_{params_of(team)} {
  for (const auto& v : team.vehicles) {
    own_[v.spec.id].clock = clock_offset(team.faults, v.spec.id);
    if (v.flies_as) used_twice_.insert(*v.flies_as);
  }
}

PictureWatch::~PictureWatch() = default;

TeamObserver PictureWatch::observer() {
  TeamObserver observer;
  observer.event = [this](const mission::MissionEvent& e) { note(e); };
  observer.message = [this](const mission::Message& m) { note_said(m); };
  observer.ground_message = [this](const mission::Message& m, VehicleId sender, Instant now) {
    note_heard(m, sender, now - ground_clock_);
    picture_.on_message(m, sender, now);
  };
  observer.ground_event = [this](const mission::MissionEvent& e) { picture_.on_event(e); };
  observer.fault = [this](const FaultEvent& e) {
    using Kind = FaultEvent::Kind;
    if (e.kind != Kind::ended && e.kind != Kind::gone && e.kind != Kind::restarted) return;
    Facts& facts = facts_[e.vehicle];
    facts = {};
    facts.changed_at = e.time;
    if (e.vehicle != kGroundStation || e.kind != Kind::restarted) return;
    for (auto& [id, own] : own_) own.heard_at.reset();  // it knows of nobody yet
  };
  observer.moment = [this](Instant now, const mission::GroundNode& node,
                           const std::vector<OwnWord>& words) {
    remember(words, now);
    if (now.time_since_epoch() % late_.every == Duration::zero()) look(now, node);
  };
  return observer;
}

void PictureWatch::remember(const std::vector<OwnWord>& words, Instant now) {
  for (const OwnWord& word : words) {
    Own& own = own_[word.vehicle];
    if (!word.telemetry) {
      if (!own.ended && !own.lately.empty()) own.ended = now;
      continue;
    }
    own.ended.reset();
    const mission::Telemetry& told = *word.telemetry;
    Moment moment{now + own.clock,
                  std::string{to_string(mission::shown_state(told.activity, told.detail))},
                  text_of(told.task)};
    const Moment* const before = own.now();
    const bool same =
        before != nullptr && before->state == moment.state && before->task == moment.task;
    if (!same) own.lately.push_back(std::move(moment));
    // What was over before the newest word that was heard need not be known any more.
    while (own.lately.size() > 1 && own.heard_sent &&
           own.lately[1].from < *own.heard_sent - std::chrono::seconds{2}) {
      own.lately.pop_front();
    }
  }
}

/// It was so, by its own word, at some moment since it sent what was heard of it last.
template <class Has>
bool PictureWatch::lately(const Own& own, Has has) const {
  const Instant since = own.heard_sent ? *own.heard_sent - kStep : Instant::min();
  for (std::size_t i = 0; i < own.lately.size(); ++i) {
    const bool over = i + 1 < own.lately.size() && own.lately[i + 1].from < since;
    if (!over && has(own.lately[i])) return true;
  }
  return false;
}

bool PictureWatch::is_fresh(const Own& own, Instant now) const {
  return own.heard_sent && !own.ended && now + own.clock - *own.heard_sent < late_.telemetry;
}

bool PictureWatch::is_silent(const Own& own, Instant now) const {
  return !own.heard_at || now - *own.heard_at >= kSilence;
}

void PictureWatch::note(const mission::MissionEvent& e) {
  events.push_back(e);
  if (e.kind() == EventKind::survey_done) surveyed_.insert(e.task.site);
  if (e.kind() == EventKind::site_done) done_.insert(e.task.site);
  if (e.kind() == EventKind::coalition_formed) coalitions_[e.round.coalition].formed = true;
  if (e.vehicle == kGroundStation) {
    if (e.kind() == EventKind::authorisation_refused) refused_at = e.time;
    return;
  }
  Facts& facts = facts_[e.vehicle];
  const Facts before = facts;
  if (const auto* order = std::get_if<mission::event::Commanded>(&e.body)) {
    facts.order = order->command;
    if (order->command == CommandKind::resume) facts.order.reset();
  }
  facts.range_spent = facts.range_spent || e.kind() == EventKind::range_spent;
  // Also who leads without a delivery waits for the operator.
  if (e.kind() == EventKind::confirmed || e.kind() == EventKind::authorisation_requested) {
    facts.authorised = false;
  }
  if (e.kind() == EventKind::authorised) facts.authorised = true;
  const bool changed = facts.order != before.order || facts.range_spent != before.range_spent ||
                       facts.authorised != before.authorised;
  if (changed) facts.changed_at = e.time;
}

/// Of leaders, the moment they say it.
void PictureWatch::note_said(const mission::Message& message) {
  const auto* said = std::get_if<coalition::Message>(&message);
  if (said == nullptr) return;
  if (const auto* award = std::get_if<coalition::Award>(said)) {
    std::set<VehicleId> members;
    for (const TaskAssignment& one : award->assignments) members.insert(one.vehicle);
    coalitions_[award->round.coalition].said.push_back(
        {award->awarded_at, {members.begin(), members.end()}});
  } else if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(said)) {
    Coalition& known = coalitions_[renewal->round.coalition];
    known.closed = known.closed || renewal->closed;
    if (renewal->closed || renewal->members.empty() || !coalition::stands(*renewal)) return;
    known.formed = true;
    known.said.push_back({renewal->sent_at, renewal->members});
  } else if (const auto* cancel = std::get_if<coalition::Cancel>(said)) {
    coalitions_[cancel->round.coalition].cancelled = true;
  }
}

void PictureWatch::note_heard(const mission::Message& message, VehicleId sender, Instant now) {
  if (const auto* told = std::get_if<mission::Telemetry>(&message)) {
    Own& own = own_[sender];
    own.heard_at = now;
    if (own.heard_instance != told->instance) own.heard_sent.reset();
    own.heard_instance = told->instance;
    own.heard_sent = std::max(own.heard_sent.value_or(Instant::min()), told->state.time);
    return;
  }
  const auto* said = std::get_if<coalition::Message>(&message);
  if (said == nullptr || sender == kGroundStation) return;
  const auto hear = [this](const coalition::CoalitionId& id, Instant at) {
    auto& heard = coalitions_[id].heard;
    heard = std::max(heard.value_or(Instant::min()), at);
  };
  if (const auto* award = std::get_if<coalition::Award>(said)) {
    hear(award->round.coalition, award->awarded_at);
  } else if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(said)) {
    if (!renewal->closed && !renewal->members.empty() && coalition::stands(*renewal))
      hear(renewal->round.coalition, renewal->sent_at);
  }
}

void PictureWatch::expect(bool so, const std::string& kind, const std::string& what, Instant now,
                          Duration for_long) {
  ++judged[kind];
  const std::pair key{kind, what};
  if (so) {
    wrong_since_.erase(key);
    return;
  }
  looked_.insert(key);
  const Instant since = wrong_since_.emplace(key, now).first->second;
  if (now - since < for_long || !told_.insert(kind).second) return;
  differences_.push_back(fmt::format("{}: {} at {:.2f} s, since {:.2f} s", kind, what,
                                     to_seconds(now), to_seconds(since)));
}

std::string PictureWatch::section(console::Section which, const mission::GroundNode& node,
                                  Instant now) const {
  return console::section_of(which, picture_, node.fleet(), origin_, "1", now + ground_clock_);
}

void PictureWatch::look(Instant now, const mission::GroundNode& node) {
  looked_.clear();
  picture_.on_decisions(node.agent(), now + ground_clock_);
  judge_vehicles(now, node);
  judge_sites(now, node);
  judge_coalitions(now, node);
  judge_cards(now, node);
  judge_hazards(now, node);
  // What is not shown any more is not wrong any more.
  std::erase_if(wrong_since_, [this](const auto& one) { return !looked_.contains(one.first); });
}

void PictureWatch::judge_vehicles(Instant now, const mission::GroundNode& node) {
  const std::string table =
      groundstation::fleet_table(node.fleet().vehicles(), now + ground_clock_);
  for (const Json& v : Json::parse(section(console::Section::vehicles, node, now))) {
    if (v["state"].is_null()) continue;  // not heard yet
    const VehicleId id{v["id"].get<std::uint16_t>()};
    const std::string state = v["state"];
    const Own& own = own_[id];
    seen.insert(state);
    seen_of[id.value].insert(state);
    expect(state_in(table, id) == state, "table",
           fmt::format("{} is {} in the table, and {} on the page", id.value, state_in(table, id),
                       state),
           now);
    if (used_twice_.contains(id)) continue;
    expect(v["silent"].get<bool>() == (state == "silent"), "silent",
           fmt::format("{} is silent, and not", id.value), now);
    expect((state == "silent") == is_silent(own, now), "silence",
           fmt::format("{} is shown as {}", id.value, state), now, kStep);
    if (state != "silent") {
      expect(lately(own, [&](const Moment& m) { return m.state == state; }), "state",
             fmt::format("{} is shown as {}, and is {}", id.value, state,
                         own.now() == nullptr ? "not known" : own.now()->state),
             now);
      judge_facts(id, state, now);
    }
    const Json& task = v["task"];
    const std::string shown =
        task.is_null() ? "" : to_string(task_of(SiteId{task["site"].get<std::uint16_t>()}, task));
    if (!task.is_null()) task_shown = now;
    expect(lately(own, [&](const Moment& m) { return m.task == shown; }), "task",
           fmt::format("{} is shown with '{}', and has '{}'", id.value, shown,
                       own.now() == nullptr ? "?" : own.now()->task),
           now);
    const bool idle = state == "searching" || state == "holding_by_order" || state == "returning";
    expect(shown.empty() || !idle, "task of who is idle",
           fmt::format("{} is {} with {}", id.value, state, shown), now);
  }
}

/// By what it has told as events: of what was sent after that.
void PictureWatch::judge_facts(VehicleId id, const std::string& state, Instant now) {
  const Facts& facts = facts_[id];
  const Own& own = own_[id];
  if (!own.heard_sent || *own.heard_sent - own.clock < facts.changed_at + 2 * kStep) return;
  const auto obeys = [&](CommandKind kind) { return facts.order == kind; };
  bool may_be = true;
  if (state == "holding_by_order") may_be = obeys(CommandKind::hold);
  if (state == "returning") may_be = obeys(CommandKind::return_home) || obeys(CommandKind::land);
  if (state == "range_reserve") may_be = facts.range_spent;
  if (state == "waiting_for_authorisation") may_be = !facts.authorised;
  if (state == "delivering") may_be = facts.authorised;
  expect(may_be, "facts", fmt::format("{} is shown as {}, and cannot be", id.value, state), now,
         late_.word);
}

void PictureWatch::judge_sites(Instant now, const mission::GroundNode& node) {
  const Json vehicles = Json::parse(section(console::Section::vehicles, node, now));
  std::map<std::string, VehicleId> owners;
  for (const Json& site : Json::parse(section(console::Section::sites, node, now))) {
    const SiteId id{site["id"].get<std::uint16_t>()};
    const std::string status = site["status"];
    const auto name = [&](const std::string& what) {
      return fmt::format("site {} is {}: {}", id.value, status, what);
    };
    const bool off = status == "withdrawn" || status == "refused" || status == "taken_back";
    const bool over = node.sites().is_withdrawn(id);
    expect(off == over, "site off", name(over ? "it is withdrawn" : "it is not"), now, kStep);
    expect(status != "done" || done_.contains(id), "site done", name("nobody has said so"), now);
    expect(status != "surveyed" || surveyed_.contains(id), "site surveyed",
           name("nobody has said so"), now, late_.word);
    for (const Json& task : site["tasks"]) {
      const bool held = task["state"] == "planned" || task["state"] == "started";
      if (task["vehicle"].is_null()) continue;
      const VehicleId who{task["vehicle"].get<std::uint16_t>()};
      const std::string shown = to_string(task_of(id, task));
      // Whether it was flown before is not known; who is to fly it anew is shown all the same.
      if (held || task["state"] == "unknown") owners[shown] = who;
      const Own& own = own_[who];
      if (!held || !is_fresh(own, now) || used_twice_.contains(who)) continue;
      expect(lately(own, [&](const Moment& m) { return m.task == shown; }), "owner",
             fmt::format("{} is shown with {}, and has '{}'", shown, who.value, own.now()->task),
             now, late_.word);
    }
  }
  for (const Json& v : vehicles) {
    if (v["task"].is_null() || v["silent"].get<bool>()) continue;
    const VehicleId who{v["id"].get<std::uint16_t>()};
    const TaskId task = task_of(SiteId{v["task"]["site"].get<std::uint16_t>()}, v["task"]);
    const Own& own = own_[who];
    if (task.kind == TaskKind::survey || !is_fresh(own, now) || used_twice_.contains(who) ||
        node.sites().is_withdrawn(task.site))
      continue;
    const auto shown = owners.find(to_string(task));
    expect(shown != owners.end() && shown->second == who, "owner is shown",
           fmt::format("{} has {}, and its site says {}", who.value, to_string(task),
                       shown == owners.end() ? "nobody" : std::to_string(shown->second.value)),
           now, late_.word);
  }
}

void PictureWatch::judge_coalitions(Instant now, const mission::GroundNode& node) {
  for (const Json& shown : Json::parse(section(console::Section::coalitions, node, now))) {
    const auto id = console::coalition_of(shown["key"].get<std::string>());
    if (!id) continue;
    const std::string state = shown["state"];
    const Coalition& known = coalitions_[*id];
    const std::string name =
        fmt::format("coalition {} is {}", shown["key"].get<std::string>(), state);
    expect(state != "closed" || known.closed, "coalition closed", name, now);
    expect(state != "failed" || known.cancelled, "coalition failed", name, now);
    expect(state != "formed" || known.formed, "coalition formed", name, now);
    if (!known.heard || used_twice_.contains(id->leader)) continue;
    std::vector<VehicleId> members;
    for (const Json& member : shown["members"]) members.push_back({member.get<std::uint16_t>()});
    const bool so = std::ranges::any_of(known.said, [&](const Said& said) {
      return said.at >= *known.heard && std::ranges::is_permutation(said.members, members);
    });
    expect(so, "coalition's members", name + " of " + shown["members"].dump(), now, late_.word);
  }
}

void PictureWatch::judge_cards(Instant now, const mission::GroundNode& node) {
  using Key = std::tuple<std::uint16_t, std::string, std::uint32_t>;
  std::map<Key, const mission::PendingAuthorisation*> known;
  for (const auto& pending : node.agent().authorisations()) {
    const auto& round = pending.request.round;
    known[{pending.request.site.value, console::key_of(round.coalition), round.number}] = &pending;
  }
  for (const Json& request : Json::parse(section(console::Section::authorisations, node, now))) {
    const Key key{request["site"], request["coalition"], request["round"]};
    const auto found = known.find(key);
    const bool waits = request["waiting"];
    const std::string name = fmt::format("site {}, coalition {}, round {}", std::get<0>(key),
                                         std::get<1>(key), std::get<2>(key));
    const auto* pending = found == known.end() ? nullptr : found->second;
    const bool undecided = pending != nullptr && !pending->decision &&
                           now + ground_clock_ < pending->request.decide_by;
    expect(waits == undecided, "card waits", name, now, kStep);
    if (pending != nullptr) {
      const Json& decision = request["decision"];
      expect(decision.is_null() == !pending->decision.has_value() &&
                 (decision.is_null() || decision["granted"] == pending->decision->granted),
             "decision", name + ": " + decision.dump(), now, kStep);
      expect(
          request["can_take_back"] == node.agent().may_be_taken_back(*pending, now + ground_clock_),
          "can be taken back", name + ": " + request["can_take_back"].dump(), now, late_.word);
    }
    if (!waits) continue;
    ++cards;
    std::vector<VehicleId> silent;
    if (pending != nullptr) {
      std::set<VehicleId> named{pending->request.round.coalition.leader};
      bool same = request["deliveries"].size() == pending->request.deliveries.size();
      for (std::size_t i = 0; same && i < pending->request.deliveries.size(); ++i) {
        const auto& delivery = pending->request.deliveries[i];
        named.insert(delivery.assignment.vehicle);
        same = request["deliveries"][i]["vehicle"] == delivery.assignment.vehicle.value &&
               request["deliveries"][i]["index"] == delivery.assignment.task.index;
      }
      expect(same, "deliveries of a card", name + ": " + request["deliveries"].dump(), now);
      for (const VehicleId id : named) {
        if (is_silent(own_[id], now)) silent.push_back(id);
      }
      std::vector<VehicleId> shown;
      for (const Json& id : request["silent"]) shown.push_back({id.get<std::uint16_t>()});
      expect(shown == silent, "silent on a card", name + ": " + request["silent"].dump(), now,
             kStep);
    }
    for (const Json& delivery : request["deliveries"]) {
      const VehicleId id{delivery["vehicle"].get<std::uint16_t>()};
      const std::string marks = delivery["marks"].dump();
      const bool is_marked = marks.find("silent for") != std::string::npos ||
                             marks.find("never heard") != std::string::npos;
      marked += is_marked ? 1 : 0;
      expect(is_marked == is_silent(own_[id], now), "marks",
             fmt::format("{} of {}: {}", id.value, name, marks), now, kStep);
    }
    for (const Json& missing : request["missing"]) {
      reasons.insert(missing["why"].get<std::string>());
    }
    for (const Json& who : request["did_not_bid"]) {
      did_not_bid[who["vehicle"].get<std::uint16_t>()].insert(who["why"].get<std::string>());
    }
  }
}

void PictureWatch::judge_hazards(Instant now, const mission::GroundNode& node) {
  std::set<std::uint16_t> known;
  for (const Hazard& hazard : node.hazards().known()) known.insert(hazard.id.value);
  std::set<std::uint16_t> shown;
  for (const Json& hazard : Json::parse(section(console::Section::hazards, node, now))) {
    shown.insert(hazard["id"].get<std::uint16_t>());
  }
  expect(shown == known, "hazards",
         fmt::format("{} are shown, {} known", shown.size(), known.size()), now, kStep);
}

}  // namespace skein::hil
