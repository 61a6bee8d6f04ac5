// SPDX-License-Identifier: Apache-2.0
//
// Flies seeded missions with faults and prints, site by site, what is said and heard of the
// contract net and what its vehicles tell of their leases: the words of replay.pml, one row of
// numbers each. What changes nothing in the model (a status of a task that is only planned) is left
// out.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "skein/coalition/messages.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/domain/site.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein {
namespace {

using coalition::CoalitionId;
using coalition::Reason;
using mission::EventKind;

constexpr std::size_t kTasks = 7;  ///< of a site, as the model packs their owners
constexpr int kHeard = 20;         ///< more than the kind of what is said
// Numbers that the model counts with: NOLINTBEGIN(readability-identifier-naming)
enum Kind : int {
  kAnnouncement = 1,
  kBid,
  kAward,
  kConfirmation,
  kCancel,
  kRenewal,
  kStatus,
  kClaim,
  kAllegiance,
  kRequest,
  kDecision,
  kCrash = 40,
  kRestart,
  kEngaged,  ///< it bids for another site
  kLeaseGranted = 50,
  kLeaseEnded,
  kReleased,
  kAuthorised,
  kTaskLost,
  kTaskUnknown,
  kLate,  ///< at its gate
};
// NOLINTEND(readability-identifier-naming)
constexpr int kGround = 15;

struct Row {
  int kind = 0;
  int who = 0;
  std::int64_t at_us = 0;
  int c = 0, r = 0, v = 0, t = 0, x = 0, i = 0, n = 0, a = 0, b = 0, d = 0, w = 0;
  std::int64_t s_us = 0, u_us = 0;
  std::array<std::int64_t, kTasks> times_us{};
};

std::int64_t us(Instant at) {
  if (at == Instant::min()) return -1'000'000'000;
  return std::clamp<std::int64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(at.time_since_epoch()).count(),
      -1'000'000'000, 1'000'000'000);
}

bool not_formed(Reason why) {
  return why == Reason::owners_silent || why == Reason::electors_silent ||
         why == Reason::no_allocation || why == Reason::allocation_too_late ||
         why == Reason::award_refused || why == Reason::not_confirmed;
}
bool by_operator(Reason why) {
  return why == Reason::site_withdrawn || why == Reason::grant_taken_back ||
         why == Reason::refused_by_operator;
}

class SiteTrace {
 public:
  explicit SiteTrace(const Site& site) : site_{site}, tasks_{tasks_after_survey(site)} {}

  [[nodiscard]] int task(const TaskId& id) const {
    const auto found = std::find(tasks_.begin(), tasks_.end(), id);
    return found == tasks_.end() ? -1 : static_cast<int>(found - tasks_.begin());
  }
  [[nodiscard]] int tasks(const std::vector<TaskId>& some) const {
    int set = 0;
    for (const TaskId& one : some) {
      const int index = task(one);
      if (index >= 0) set |= 1 << index;
    }
    return set;
  }
  int coalition(const CoalitionId& id) {
    return coalitions_.try_emplace(id, static_cast<int>(coalitions_.size())).first->second;
  }
  [[nodiscard]] std::size_t coalitions() const { return coalitions_.size(); }
  void owners(const std::vector<TaskAssignment>& plan, Row& row) const {
    for (const auto& a : plan) {
      const int t = task(a.task);
      if (t < 0) continue;
      row.w |= a.vehicle.value << (4 * t);
      row.times_us.at(static_cast<std::size_t>(t)) = us(a.time);
    }
  }
  void print() const {
    std::printf("site %u %zu %zu\n", static_cast<unsigned>(site_.id.value), tasks_.size(),
                site_.deliveries.size());
    for (const Row& r : rows) {
      std::printf("%d %d %lld %d %d %d %d %d %d %d %d %d %d %d %lld %lld", r.kind, r.who,
                  static_cast<long long>(r.at_us), r.c, r.r, r.v, r.t, r.x, r.i, r.n, r.a, r.b, r.d,
                  r.w, static_cast<long long>(r.s_us), static_cast<long long>(r.u_us));
      const bool timed = r.kind % kHeard == kAward || r.kind % kHeard == kDecision;
      if (timed && r.kind < 2 * kHeard) {
        for (const auto time : r.times_us) std::printf(" %lld", static_cast<long long>(time));
      }
      std::printf("\n");
    }
    std::printf("end\n");
  }

  std::vector<Row> rows;

 private:
  Site site_;
  std::vector<TaskId> tasks_;
  std::map<CoalitionId, int> coalitions_;
};

class Tracer {
 public:
  explicit Tracer(const hil::TeamMission& mission) {
    for (const Site& site : mission.sites) sites_.emplace(site.id, site);
    for (const auto& v : mission.vehicles) vehicles_ = std::max<int>(vehicles_, v.spec.id.value);
    skew_us_.resize(static_cast<std::size_t>(vehicles_));
    for (const auto& fault : mission.faults) {
      const auto* off = std::get_if<hil::ClockOff>(&fault.what);
      if (off == nullptr || off->node.value < 1 || off->node.value > vehicles_) continue;
      skew_us_.at(off->node.value - 1U) =
          std::chrono::duration_cast<std::chrono::microseconds>(off->offset).count();
    }
  }

  hil::TeamObserver observer() {
    hil::TeamObserver watch;
    watch.message = [this](const mission::Message& m) { said(m); };
    watch.heard = [this](VehicleId v, const mission::Message& m, Instant now) {
      now_us_ = us(now);
      tell(m, v.value - 1, kHeard);
    };
    watch.event = [this](const mission::MissionEvent& e) { event(e); };
    watch.fault = [this](const hil::FaultEvent& e) { fault(e); };
    return watch;
  }

  void print(const std::string& name) const {
    std::printf("mission %s %d", name.c_str(), vehicles_);
    for (const auto skew : skew_us_) std::printf(" %lld", static_cast<long long>(skew));
    std::printf("\n");
    for (const auto& [id, site] : sites_) site.print();
  }

 private:
  static std::optional<CoalitionId> coalition_of(const coalition::Message& message) {
    return std::visit(
        [](const auto& m) -> std::optional<CoalitionId> {
          if constexpr (requires { m.round.coalition; }) return m.round.coalition;
          if constexpr (requires { m.coalition; }) return m.coalition;
        },
        message);
  }

  SiteTrace* site_of(const coalition::Message& message) {
    std::optional<SiteId> site;
    if (const auto* a = std::get_if<coalition::Announcement>(&message)) site = a->site.id;
    if (const auto* a = std::get_if<coalition::Award>(&message)) site = a->site.id;
    if (const auto* a = std::get_if<coalition::LeaseRenewal>(&message)) site = a->site;
    const auto coalition = coalition_of(message);
    if (site && coalition) led_.emplace(*coalition, *site);
    if (!site && coalition && led_.contains(*coalition)) site = led_.at(*coalition);
    if (!site || !sites_.contains(*site)) return nullptr;
    return &sites_.at(*site);
  }

  void said(const mission::Message& message) {
    if (const auto* telemetry = std::get_if<mission::Telemetry>(&message)) {
      const auto index = static_cast<std::size_t>(telemetry->vehicle.value - 1);
      if (index >= skew_us_.size()) return;
      now_us_ = std::max(now_us_, us(telemetry->state.time) - skew_us_.at(index));
      return;
    }
    const int who = sender_of(message);
    if (who < 0 || passed_on(message)) return;
    tell(message, who, 0);
    if (who != kGround) tell(message, who, kHeard);  // its own leader, its own member
  }

  /// What leaders have said before, the ground station says again: it is heard, and said by nobody.
  bool passed_on(const mission::Message& message) {
    const auto* said = std::get_if<coalition::Message>(&message);
    if (said == nullptr) return false;
    if (const auto* m = std::get_if<coalition::Announcement>(said)) {
      return now_us_ > us(m->bids_until) + kAnnouncedLater_us;
    }
    const auto* m = std::get_if<coalition::LeaseRenewal>(said);
    return m != nullptr &&
           !renewals_.emplace(m->round, m->sent_at, m->lease_until, m->done.size()).second;
  }

  static int sender_of(const mission::Message& message) {
    if (std::holds_alternative<mission::Authorisation>(message)) return kGround;
    if (const auto* request = std::get_if<mission::AuthorisationRequest>(&message)) {
      return request->round.coalition.leader.value - 1;
    }
    const auto* said = std::get_if<coalition::Message>(&message);
    if (said == nullptr) return -1;
    if (const auto* m = std::get_if<coalition::Bid>(said)) return m->bidder.value - 1;
    if (const auto* m = std::get_if<coalition::Confirmation>(said)) return m->member.value - 1;
    if (const auto* m = std::get_if<coalition::MemberStatus>(said)) {
      return m->member == kGroundStation ? kGround : m->member.value - 1;
    }
    if (const auto* m = std::get_if<coalition::LeadershipClaim>(said)) return m->claimant.value - 1;
    if (const auto* m = std::get_if<coalition::Allegiance>(said)) return m->elector.value - 1;
    return coalition_of(*said)->leader.value - 1;
  }

  Row row(int kind, int who) const {
    Row made;
    made.kind = kind;
    made.who = who;
    made.at_us = now_us_;
    return made;
  }
  /// When it was said, by the true clock, where it tells that.
  void at_stamp(Row& row, Instant stamp) {
    row.s_us = us(stamp);
    if (row.kind > kHeard || row.who == kGround) return;
    now_us_ = row.s_us - skew_us_.at(static_cast<std::size_t>(row.who));
    row.at_us = now_us_;
  }

  void tell(const mission::Message& message, int who, int heard) {
    if (const auto* m = std::get_if<mission::AuthorisationRequest>(&message)) {
      if (heard != 0 || !sites_.contains(m->site)) return;
      SiteTrace& site = sites_.at(m->site);
      Row made = row(kRequest, who);
      put(m->round, site, made);
      std::vector<TaskAssignment> plan;
      for (const auto& delivery : m->deliveries) plan.push_back(delivery.assignment);
      site.owners(plan, made);
      site.rows.push_back(made);
    } else if (const auto* d = std::get_if<mission::Authorisation>(&message)) {
      if (!sites_.contains(d->site)) return;
      SiteTrace& site = sites_.at(d->site);
      Row made = row(kDecision + heard, who);
      put(d->round, site, made);
      made.x = d->granted ? 1 : 0;
      made.s_us = us(d->decided_at);
      made.u_us = us(d->until);
      std::vector<TaskAssignment> plan;
      for (const auto& delivery : d->deliveries) plan.push_back(delivery.assignment);
      site.owners(plan, made);
      site.rows.push_back(made);
    } else if (const auto* said = std::get_if<coalition::Message>(&message)) {
      tell(*said, who, heard);
    }
  }

  static void put(const coalition::Round& round, SiteTrace& site, Row& made) {
    made.c = site.coalition(round.coalition);
    made.r = static_cast<int>(round.number);
    made.v = round.coalition.leader.value - 1;
  }

  void tell(const coalition::Message& message, int who, int heard) {
    SiteTrace* const site = site_of(message);
    if (site == nullptr) return;
    Row made = row(0, who);
    if (const auto* call = std::get_if<coalition::Announcement>(&message)) {
      made.kind = kAnnouncement + heard;
      put(call->round, *site, made);
      made.a = site->tasks(call->tasks);
    } else if (const auto* bid = std::get_if<coalition::Bid>(&message)) {
      made.kind = kBid + heard;
      put(bid->round, *site, made);
      made.v = bid->bidder.value - 1;
      made.i = start_of(bid->bidder, bid->instance);
      made.u_us =
          std::chrono::duration_cast<std::chrono::microseconds>(approach_time(*bid)).count();
      if (heard == 0) engage(bid->bidder, site);
    } else if (const auto* award = std::get_if<coalition::Award>(&message)) {
      made.kind = kAward + heard;
      put(award->round, *site, made);
      site->owners(award->assignments, made);
      at_stamp(made, award->awarded_at);
      made.u_us = us(award->lease_until);
      if (award->continues.leader.value > 0) made.n = site->coalition(award->continues) + 1;
    } else if (const auto* answer = std::get_if<coalition::Confirmation>(&message)) {
      made.kind = kConfirmation + heard;
      put(answer->round, *site, made);
      made.v = answer->member.value - 1;
      made.x = answer->accepted ? 1 : 2;
    } else if (const auto* cancel = std::get_if<coalition::Cancel>(&message)) {
      made.kind = kCancel + heard;
      put(cancel->round, *site, made);
      made.x = by_operator(cancel->why.reason) ? 1 : 0;
      made.t = not_formed(cancel->why.reason) ? 1 : 0;
    } else if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(&message)) {
      made.kind = kRenewal + heard;
      put(renewal->round, *site, made);
      for (const VehicleId v : renewal->members) made.a |= 1 << (v.value - 1);
      for (const VehicleId v : renewal->electors) made.b |= 1 << (v.value - 1);
      made.d = site->tasks(renewal->done);
      made.x = renewal->closed ? 1 : 0;
      if (!renewal->closed) at_stamp(made, renewal->sent_at);
      made.u_us = us(renewal->lease_until);
    } else if (const auto* status = std::get_if<coalition::MemberStatus>(&message)) {
      made.kind = kStatus + heard;
      put(status->round, *site, made);
      made.v = status->member == kGroundStation ? kGround : status->member.value - 1;
      for (const auto& entry : status->tasks) {
        made.t = site->task(entry.task);
        made.x = static_cast<int>(entry.state);
        if (made.t >= 0 && entry.state != coalition::TaskState::planned) site->rows.push_back(made);
      }
      return;
    } else if (const auto* claim = std::get_if<coalition::LeadershipClaim>(&message)) {
      made.kind = kClaim + heard;
      made.c = site->coalition(claim->coalition);
      made.v = claim->claimant.value - 1;
      at_stamp(made, claim->sent_at);
    } else if (const auto* allegiance = std::get_if<coalition::Allegiance>(&message)) {
      made.kind = kAllegiance + heard;
      made.c = site->coalition(allegiance->coalition);
      made.v = allegiance->elector.value - 1;
      made.i = start_of(allegiance->elector, allegiance->instance);
      made.x = allegiance->follows.value;
      made.s_us = us(allegiance->acknowledges);
    }
    site->rows.push_back(made);
  }

  /// Numbers of a vehicle's starts, from 1.
  int start_of(VehicleId vehicle, InstanceId instance) {
    auto& known = starts_[vehicle];
    const auto found = std::find(known.begin(), known.end(), instance);
    if (found != known.end()) return static_cast<int>(found - known.begin()) + 1;
    known.resize(restarts_[vehicle] + 1);  // it may have said nothing after an earlier start
    known.back() = instance;
    return static_cast<int>(known.size());
  }

  /// Who bids for one site can have nothing to do with another any more.
  void engage(VehicleId vehicle, const SiteTrace* with) {
    for (auto& [id, site] : sites_) {
      if (&site != with) site.rows.push_back(row(kEngaged, vehicle.value - 1));
    }
  }

  void event(const mission::MissionEvent& e) {
    if (e.vehicle.value < 1 || e.vehicle.value > vehicles_) return;
    const auto led = led_.find(e.round.coalition);
    if (led == led_.end() || !sites_.contains(led->second)) return;
    SiteTrace& site = sites_.at(led->second);
    Row made = row(0, e.vehicle.value - 1);
    put(e.round, site, made);
    made.at_us = us(e.time);
    made.v = made.who;
    made.t = std::max(site.task(e.task), 0);
    if (const auto* granted = std::get_if<mission::event::LeaseGranted>(&e.body)) {
      made.kind = kLeaseGranted;
      made.u_us = us(granted->until);
    } else if (const auto* ended = std::get_if<mission::event::LeaseEnded>(&e.body)) {
      made.kind = kLeaseEnded;
      made.x = ended->why.reason == Reason::lease_ran_out ? 1
               : ended->why.reason == Reason::task_done   ? 2
               : ended->why.reason == Reason::task_failed ? 3
                                                          : 0;
      made.n = ended->held ? 1 : 0;
    } else if (std::holds_alternative<mission::event::Released>(e.body)) {
      made.kind = kReleased;
    } else if (e.kind() == EventKind::authorised) {
      made.kind = kAuthorised;
    } else if (const auto* lost = std::get_if<mission::event::TaskLost>(&e.body)) {
      made.kind = kTaskLost;
      made.x = lost->why.reason == Reason::owner_silent ? 1 : 0;
    } else if (e.kind() == EventKind::authorisation_late && site.task(e.task) >= 0) {
      made.kind = kLate;
    } else if (e.kind() == EventKind::task_unknown) {
      made.kind = kTaskUnknown;
    }
    if (made.kind != 0) site.rows.push_back(made);
  }

  void fault(const hil::FaultEvent& e) {
    now_us_ = us(e.time);
    using What = hil::FaultEvent::Kind;
    const bool ends = e.kind == What::ended || e.kind == What::gone;
    if (e.vehicle.value < 1 || e.vehicle.value > vehicles_) return;
    if (!ends && e.kind != What::restarted) return;
    if (!ends) ++restarts_[e.vehicle];
    for (auto& [id, site] : sites_) {
      site.rows.push_back(row(ends ? kCrash : kRestart, e.vehicle.value - 1));
    }
  }

  int vehicles_ = 0;
  std::int64_t now_us_ = 0;
  std::map<SiteId, SiteTrace> sites_;
  static constexpr std::int64_t kAnnouncedLater_us = 5'000'000;
  std::set<std::tuple<coalition::Round, Instant, Instant, std::size_t>> renewals_;
  std::map<CoalitionId, SiteId> led_;
  std::map<VehicleId, std::vector<InstanceId>> starts_;
  std::map<VehicleId, std::size_t> restarts_;
  std::vector<std::int64_t> skew_us_;  ///< of vehicles' clocks, by id
};

}  // namespace
}  // namespace skein

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fputs("usage: mission_traces SCENARIO.yaml FAULTS FIRST-SEED LAST-SEED\n", stderr);
    return 2;
  }
  const auto scenario = skein::configuration::load_scenario(argv[1]);
  if (!scenario) {
    std::fprintf(stderr, "%s\n", scenario.error().message.c_str());
    return 2;
  }
  for (long seed = std::strtol(argv[3], nullptr, 10); seed <= std::strtol(argv[4], nullptr, 10);
       ++seed) {
    const auto mission =
        skein::hil::seeded_mission(*scenario, static_cast<std::uint64_t>(seed), argv[2]);
    if (!mission) {
      std::fprintf(stderr, "%s\n", mission.error().message.c_str());
      return 2;
    }
    // The model tells vehicles apart by their numbers.
    const bool used_twice = std::ranges::any_of(
        mission->vehicles, [](const auto& v) { return v.flies_as.has_value(); });
    if (used_twice) continue;
    skein::Tracer tracer{*mission};
    (void)skein::hil::simulate_team(*mission, tracer.observer());
    tracer.print(std::to_string(seed));
  }
  return 0;
}
