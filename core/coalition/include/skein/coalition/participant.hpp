// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/state_table.hpp"
#include "skein/coalition/elector.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/coalition/tally.hpp"

namespace skein::coalition {

/// A vehicle's side of the contract net: bids, is locked to one leader, holds leases, reports
/// tasks. It does no I/O and reads no clock, and decides nothing about flying: it asks (BidWanted,
/// AwardReceived) and is told (bid(), decline(), accept(), refuse(), task_*()).
/// Call with a `now` that never decreases; drain poll_message() and poll_output() after each call.
class Participant {
 public:
  enum class State : std::uint8_t { free, bidding, deciding, member, rebidding, orphaned, count };
  enum class Event : std::uint8_t {
    bid,
    award_received,
    accepted,
    refused,
    not_awarded,
    no_award,
    released,
    new_round,
    leader_lost,
    leader_heard,
    count
  };
  static constexpr auto kTable = state_table(
      from(State::free, on(Event::bid, State::bidding)),
      from(State::bidding, on(Event::award_received, State::deciding),
           on(Event::not_awarded, State::free), on(Event::no_award, State::free),
           on(Event::released, State::free), on(Event::new_round, State::free)),
      from(State::deciding, on(Event::accepted, State::member), on(Event::refused, State::free)),
      from(State::member, on(Event::bid, State::rebidding), on(Event::released, State::free),
           on(Event::leader_lost, State::orphaned)),
      from(State::orphaned, on(Event::leader_heard, State::member),
           on(Event::award_received, State::deciding), on(Event::bid, State::rebidding),
           on(Event::released, State::free)),
      from(State::rebidding, on(Event::award_received, State::deciding),
           on(Event::not_awarded, State::free), on(Event::no_award, State::free),
           on(Event::released, State::free), on(Event::new_round, State::free)));

  /// Shall this vehicle bid? Answer with bid() or decline(), in the same step.
  struct BidWanted {
    Announcement announcement;
  };
  /// Can this be flown? Answer with accept() or refuse(), in the same step.
  struct AwardReceived {
    Award award;
    std::vector<TaskAssignment> mine;
  };
  /// A lease was granted or renewed.
  struct LeaseGranted {
    Round round;
    TaskId task;
    Instant until{};
  };
  /// A lease ended: the task was done, taken back, given up or it ran out. When `held`, the leader
  /// is silent: the plan is flown on, but nothing is begun, until a successor's award or Released.
  struct LeaseEnded {
    Round round;
    TaskId task;
    Why why;
    bool held = false;
  };
  /// Not (any more) in a coalition; all leases have ended.
  struct Released {
    Round round;
    Why why;
  };
  /// This vehicle leads from now on: Initiator's second constructor takes it.
  using LeadershipWon = Elector::Won;
  using Output =
      std::variant<BidWanted, AwardReceived, LeaseGranted, LeaseEnded, Released, LeadershipWon>;

  /// `instance`: of this vehicle's program, new with each start.
  Participant(const ProtocolParams& params, VehicleId self, InstanceId instance);

  void on_announcement(const Announcement& message, Instant now);
  void on_award(const Award& message, Instant now);
  void on_cancel(const Cancel& message, Instant now);
  void on_lease_renewal(const LeaseRenewal& message, Instant now);
  /// Of other members: what they have done, whom they follow, who wants to lead.
  void on_status(const MemberStatus& message);
  void on_claim(const LeadershipClaim& message, Instant now);
  void on_allegiance(const Allegiance& message, Instant now);
  void on_timeout(Instant now);
  /// May this vehicle lead another coalition now?
  void set_may_lead(bool may_lead) { elector_.set_may_lead(may_lead); }

  /// Answers to BidWanted. Precondition: the announcement is the one asked about.
  void bid(const Announcement& announcement, Bid bid, Instant now);
  void decline(const Announcement& announcement);
  /// Answers to AwardReceived.
  void accept(Instant now);
  void refuse(const Why& why, Instant now);

  /// How the tasks go. A task that is done or failed is no longer held. `end` is told as its end:
  /// what follows counts from there.
  void task_started(const TaskId& task, Instant now);
  void task_done(const TaskId& task, Instant end, Instant now);
  void task_failed(const TaskId& task, Instant now);
  /// Leaves the coalition: tasks that are not done are reported as failed.
  void withdraw(Reason reason, Instant now);
  /// What has begun is flown to its end under its lease, and nobody is followed after it: the site
  /// is withdrawn.
  void finish_alone() { elector_.leave(); }

  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] std::optional<Output> poll_output();
  /// Either of these has something.
  [[nodiscard]] bool has_output() const { return !messages_.empty() || !outputs_.empty(); }
  [[nodiscard]] Instant next_timeout() const;
  /// Before then on_timeout() does nothing, where `may_lead` is set.
  [[nodiscard]] Instant quiet_until(bool may_lead) const;

  [[nodiscard]] State state() const { return machine_.state(); }
  [[nodiscard]] bool free() const { return machine_.in(State::free); }
  [[nodiscard]] const Round& round() const { return round_; }
  /// Is a lease on the task held at `now`, and does it last until `until`?
  [[nodiscard]] bool holds(const TaskId& task, Instant now, Instant until) const;
  struct Over {
    TaskId task;
    /// Its end as who flew it told it, else when the leader's word came; Instant::min() for one
    /// that may have been flown at any time.
    Instant since{};
    bool told_by_owner = false;
  };
  /// What is known of a task that is over; nothing where nobody has said that it is.
  [[nodiscard]] std::optional<Over> over(const TaskId& task) const;
  [[nodiscard]] Tally tally() const {
    return {machine_.protocol_errors(), bad_messages_ + elector_.bad_messages(),
            messages_.dropped() + outputs_.dropped() + elector_.dropped()};
  }

 private:
  struct Lease {
    TaskId task;
    TaskState state = TaskState::planned;
    Instant until{};
  };
  struct Finished {
    Round round;
    TaskStatus entry;
    Instant report_until{};
  };
  void finish(const TaskId& task, TaskState state, Instant end, Instant now);
  void end_leases(const Why& why, bool unstarted_only);
  void leave(Event event, const Why& why);
  void expire_leases(Instant now);
  void note_over(const Over& over);
  void give_up(const Lease& lease, Instant now);
  void send_status(Instant now);
  [[nodiscard]] std::vector<TaskAssignment> awarded_in(const Award& award) const;
  [[nodiscard]] bool task_in_progress() const;
  [[nodiscard]] bool delivery_in_progress() const;
  [[nodiscard]] bool has_news(Instant now) const;

  ProtocolParams params_;
  VehicleId self_;
  InstanceId instance_;
  StateMachine<State, Event> machine_{kTable, State::free};
  Round round_;             ///< the round bid in, or awarded in
  std::optional<Bid> bid_;  ///< sent again when the announcement is heard again
  std::optional<Award> award_;
  std::optional<Confirmation> confirmation_;  ///< sent again when the award is heard again
  Elector elector_;
  Instant bidding_until_{};
  Instant orphaned_until_{};
  std::vector<Lease> leases_;
  std::vector<Finished> finished_;  ///< reported until the leader knows; what is done is kept
  std::vector<Over> over_;          ///< done or unknown, as heard; newest last
  Instant next_status_{};
  std::uint64_t bad_messages_ = 0;
  BoundedQueue<Message> messages_{64};
  BoundedQueue<Output> outputs_{256};
};

[[nodiscard]] std::string_view to_string(Participant::State state);
[[nodiscard]] std::string_view to_string(Participant::Event event);

}  // namespace skein::coalition
