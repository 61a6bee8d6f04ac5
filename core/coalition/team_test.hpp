// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "skein/coalition/initiator.hpp"
#include "skein/coalition/participant.hpp"

namespace skein::coalition {

[[nodiscard]] inline Site site_with(std::size_t deliveries, std::size_t assessments) {
  Site site;
  site.id = SiteId{1};
  site.deliveries.resize(deliveries);
  site.assessments.resize(assessments);
  return site;
}

/// Some vehicles on a network that a test can make unreliable; vehicle 1 leads, as long as it can.
/// Time moves in steps of 10 ms. Tasks are given to bidders in order of id; each takes as long as
/// the test says.
class Team {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds{10};
  using Fault =
      std::function<int(const Message&, VehicleId to)>;  ///< copies that arrive; 1 is perfect
  using Cut = std::function<bool(VehicleId from, VehicleId to)>;

  Team(std::uint16_t vehicles, Site site) : site_{std::move(site)} {
    for (std::uint16_t i = 1; i <= vehicles; ++i) {
      members_.emplace(VehicleId{i},
                       Member{Participant{params, VehicleId{i}, InstanceId{1}}, InstanceId{1}});
    }
    auto& founder = members_.at(VehicleId{1});
    founder.leads = std::make_unique<Initiator>(params, CoalitionId{VehicleId{1}, InstanceId{1}, 1},
                                                site_, std::vector<TaskId>{}, Vec2{0, 0}, now);
    drain();
  }

  void run_for(Duration d) {
    for (const Instant end = now + d; now < end;) {
      now += kStep;
      deliver_due();
      for (auto& [id, m] : members_) {
        if (dead.contains(id)) continue;
        m.participant.set_may_lead(!m.leads);
        if (m.leads) m.leads->on_timeout(clock(id));
        m.participant.on_timeout(clock(id));
      }
      work();
      drain();
      check_leases();
    }
  }
  bool run_until(const std::function<bool()>& condition, Duration at_most) {
    for (const Instant end = now + at_most; now < end;) {
      if (condition()) return true;
      run_for(kStep);
    }
    return condition();
  }

  /// The founder or another, while it leads.
  [[nodiscard]] Initiator& leader(std::uint16_t id = 1) {
    return *members_.at(VehicleId{id}).leads;
  }
  /// Those that lead and work.
  [[nodiscard]] std::vector<VehicleId> leaders() const {
    std::vector<VehicleId> all;
    for (const auto& [id, m] : members_) {
      const bool leads = m.leads && m.leads->state() != Initiator::State::closed;
      if (leads && !dead.contains(id)) all.push_back(id);
    }
    return all;
  }
  /// The operator grants whatever stands.
  void authorise_all() {
    for (auto& [id, m] : members_) {
      if (m.leads) granted_.insert(m.leads->round());
      if (m.leads) m.leads->authorised(m.leads->round());
    }
  }
  [[nodiscard]] Participant& vehicle(std::uint16_t id) {
    return members_.at(VehicleId{id}).participant;
  }
  /// Its program ends and begins again, without memory of anything but what the world has seen.
  void restart(VehicleId id) {
    Member& m = members_.at(id);
    const InstanceId next{m.instance.value + 1};
    m = Member{Participant{params, id, next}, next};
  }
  [[nodiscard]] bool everyone_free() const {
    return std::all_of(members_.begin(), members_.end(), [&](const auto& m) {
      return dead.contains(m.first) || m.second.participant.free();
    });
  }

  /// For a failing test's message.
  [[nodiscard]] std::string state() const {
    std::string text = "at " + std::to_string(to_seconds(now)) + " s:";
    for (const auto& [id, m] : members_) {
      text += "\n  " + std::to_string(id.value) + (dead.contains(id) ? " dead" : "") + " " +
              std::string{to_string(m.participant.state())};
      if (m.leads) {
        text += ", leads, " + std::string{to_string(m.leads->state())} + ", round " +
                std::to_string(m.leads->round().number) + ", open";
        for (const auto& task : m.leads->announcement().tasks)
          text.append(" ").append(to_string(task));
      }
    }
    return text;
  }

  Instant now{};
  ProtocolParams params;
  Fault fault = [](const Message&, VehicleId) { return 1; };
  std::function<Duration(const Message&, VehicleId to)> delay = [](const Message&, VehicleId) {
    return Duration{std::chrono::milliseconds{50}};
  };
  Cut cut = [](VehicleId, VehicleId) { return false; };
  std::set<VehicleId> silent;     ///< neither send nor hear; they work on
  std::set<VehicleId> dead;       ///< neither send nor hear nor work
  std::set<VehicleId> unwilling;  ///< do not bid
  std::set<VehicleId> unable;     ///< refuse awards
  std::set<VehicleId> late;       ///< hold before their tasks
  bool answers_late = false;      ///< what is asked is answered after the next step in time
  bool all_or_none = true;        ///< is a plan for some of the tasks no plan?
  Duration task_takes = std::chrono::seconds{4};
  Duration begun_before{};             ///< how long before its time a task begins
  std::map<VehicleId, Duration> fast;  ///< clocks, by how much
  std::map<TaskId, int> flown;         ///< how often each task was done
  std::vector<Initiator::Output> leader_outputs;
  int lease_conflicts = 0;

 private:
  struct Member {
    Participant participant;
    InstanceId instance;
    std::unique_ptr<Initiator> leads{};
    std::map<TaskId, Instant> held{};  ///< leases, by expiry, as the vehicle believes
    std::map<TaskId, Instant> due{};   ///< when its tasks will be done
    std::set<TaskId> begun{};
  };
  struct Packet {
    Instant at;
    VehicleId from;
    VehicleId to;
    Message message;
  };

  [[nodiscard]] Instant clock(VehicleId id) const {
    const auto offset = fast.find(id);
    return offset == fast.end() ? now : now + offset->second;
  }

  void post(const Message& message, VehicleId from) {
    for (auto& [to, m] : members_) {
      if (to == from) {
        inbox_.push_back({now, from, to, message});
        continue;
      }
      if (silent.contains(from) || dead.contains(from) || cut(from, to)) continue;
      for (int copies = fault(message, to); copies > 0; --copies) {
        inbox_.push_back({now + delay(message, to), from, to, message});
      }
    }
  }

  void deliver_due() {
    std::vector<Packet> due;
    std::stable_sort(inbox_.begin(), inbox_.end(),
                     [](const Packet& a, const Packet& b) { return a.at < b.at; });
    while (!inbox_.empty() && inbox_.front().at <= now) {
      due.push_back(inbox_.front());
      inbox_.erase(inbox_.begin());
    }
    for (const auto& p : due) {
      if (dead.contains(p.to) || (silent.contains(p.to) && p.from != p.to)) continue;
      receive(p.to, p.message);
      if (answers_late) members_.at(p.to).participant.on_timeout(clock(p.to));
      drain();
    }
  }

  void receive(VehicleId to, const Message& message) {
    Member& m = members_.at(to);
    const Instant at = clock(to);
    if (const auto* a = std::get_if<Announcement>(&message)) {
      if (m.leads) m.leads->on_rival(a->round, false, at);
      m.participant.on_announcement(*a, at);
    } else if (const auto* w = std::get_if<Award>(&message)) {
      if (m.leads) m.leads->on_rival(w->round, true, at);
      m.participant.on_award(*w, at);
    } else if (const auto* c = std::get_if<Cancel>(&message)) {
      m.participant.on_cancel(*c, at);
    } else if (const auto* l = std::get_if<LeaseRenewal>(&message)) {
      if (m.leads) m.leads->on_rival(l->round, stands(*l), at);
      m.participant.on_lease_renewal(*l, at);
    } else if (const auto* n = std::get_if<LeadershipClaim>(&message)) {
      m.participant.on_claim(*n, at);
    } else if (const auto* g = std::get_if<Allegiance>(&message)) {
      if (m.leads) m.leads->on_allegiance(*g, at);
      m.participant.on_allegiance(*g, at);
    } else if (const auto* s = std::get_if<MemberStatus>(&message)) {
      if (m.leads) m.leads->on_status(*s, at);
      m.participant.on_status(*s);
    } else if (const auto* b = std::get_if<Bid>(&message)) {
      if (m.leads) m.leads->on_bid(*b, at);
    } else if (const auto* f = std::get_if<Confirmation>(&message)) {
      if (m.leads) m.leads->on_confirmation(*f, at);
    }
  }

  void drain() {
    for (auto& [id, m] : members_) {
      if (dead.contains(id)) continue;
      while (m.leads) {
        if (const auto message = m.leads->poll_message()) {
          post(*message, id);
        } else if (const auto o = m.leads->poll_output()) {
          leader_outputs.push_back(*o);
          if (const auto* wanted = std::get_if<Initiator::AllocationWanted>(&*o)) {
            allocate(*m.leads, *wanted, clock(id));
          }
          if (std::holds_alternative<Initiator::Superseded>(*o)) {
            while (const auto last = m.leads->poll_message()) post(*last, id);
            m.leads.reset();
          }
        } else {
          break;
        }
      }
      while (const auto o = m.participant.poll_output()) answer(id, m, *o);
      while (const auto message = m.participant.poll_message()) post(*message, id);
    }
  }

  void allocate(Initiator& leader, const Initiator::AllocationWanted& wanted, Instant at) const {
    if (wanted.bids.empty() || (all_or_none && wanted.bids.size() < wanted.tasks.size())) {
      leader.allocation_failed(wanted.round, "too few bids", at);
      return;
    }
    std::vector<TaskAssignment> assignments;
    for (std::size_t i = 0; i < std::min(wanted.bids.size(), wanted.tasks.size()); ++i) {
      assignments.push_back(
          {wanted.tasks[i], wanted.bids[i].bidder, wanted.formed_at + task_takes});
    }
    leader.allocated(wanted.round, assignments, at);
  }

  void answer(VehicleId id, Member& m, const Participant::Output& output) {
    if (const auto* wanted = std::get_if<Participant::BidWanted>(&output)) {
      if (unwilling.contains(id)) {
        m.participant.decline(wanted->announcement);
      } else {
        Bid bid;
        bid.instance = m.instance;
        bid.speed_mps = 20.0;
        bid.planning_radius_m = 60.0;
        bid.final_approach_m = 300.0;
        m.participant.bid(wanted->announcement, bid, clock(id));
      }
    } else if (const auto* award = std::get_if<Participant::AwardReceived>(&output)) {
      if (unable.contains(id)) {
        m.participant.refuse({Reason::no_path}, clock(id));
        return;
      }
      for (const auto& a : award->mine) m.due[a.task] = a.time;
      m.participant.accept(clock(id));
    } else if (const auto* granted = std::get_if<Participant::LeaseGranted>(&output)) {
      m.held[granted->task] = granted->until;
    } else if (const auto* ended = std::get_if<Participant::LeaseEnded>(&output)) {
      m.held.erase(ended->task);
      if (!ended->held) {
        m.due.erase(ended->task);
        m.begun.erase(ended->task);
      }
    } else if (std::holds_alternative<Participant::Released>(output)) {
      m.due.clear();
      m.begun.clear();
    } else if (const auto* won = std::get_if<Participant::LeadershipWon>(&output)) {
      if (m.leads) return;
      const CoalitionId next{id, m.instance, ++founded_};
      m.leads = std::make_unique<Initiator>(params, next, *won, granted_.contains(won->plan.round),
                                            Vec2{0, 0}, clock(id));
    }
  }

  /// Vehicles fly their tasks, whether anybody hears them or not, as long as they hold the lease.
  void work() {
    for (auto& [id, m] : members_) {
      if (dead.contains(id) || late.contains(id)) continue;
      const auto due = m.due;
      const Instant at = clock(id);
      for (const auto& [task, when] : due) {
        const bool begins = at >= when - begun_before && at < when && !m.begun.contains(task);
        if (begins && m.participant.holds(task, at, when)) {
          m.begun.insert(task);
          m.participant.task_started(task, at);
        }
        if (at < when || !m.participant.holds(task, at, at)) continue;
        if (begun_before > Duration{} && !m.begun.contains(task)) continue;
        ++flown[task];
        m.participant.task_done(task, at, at);
      }
    }
  }

  void check_leases() {
    std::map<TaskId, int> owners;
    for (const auto& [id, m] : members_) {
      if (dead.contains(id)) continue;
      for (const auto& [task, until] : m.held) owners[task] += until > clock(id) ? 1 : 0;
    }
    for (const auto& [task, count] : owners) lease_conflicts += count > 1 ? 1 : 0;
  }

  Site site_;
  std::map<VehicleId, Member> members_;
  std::set<Round> granted_;
  std::uint32_t founded_ = 1;
  std::vector<Packet> inbox_;
};

template <class T>
[[nodiscard]] int count(const std::vector<Initiator::Output>& outputs) {
  return static_cast<int>(std::count_if(
      outputs.begin(), outputs.end(), [](const auto& o) { return std::holds_alternative<T>(o); }));
}

}  // namespace skein::coalition
