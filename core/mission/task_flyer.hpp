// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <variant>

#include "outbox.hpp"
#include "ownship.hpp"
#include "skein/coalition/participant.hpp"
#include "task_flight.hpp"

namespace skein::mission {

/// The vehicle as a member of coalitions: it answers what its Participant asks (shall I bid? can I
/// fly this?) and flies what it was awarded, one task at a time. After each call: poll_message() is
/// for everybody, this vehicle's own leader included; what poll_output() gives goes to answer() or
/// answer_call(), but for a leadership won, which is the Leader's.
class TaskFlyer {
 public:
  using Participant = coalition::Participant;

  TaskFlyer(Ownship& ownship, Outbox& outbox);

  void on_message(const coalition::Message& message, Instant now);
  void on_authorisation(const Authorisation& message, Instant now);
  [[nodiscard]] bool is_granted_by(const Authorisation& message, Instant now) const;
  /// `may_lead`: whether it may take over from a lost leader.
  void on_timeout(bool may_lead, Instant now);

  /// Goes on with its task.
  void fly(Instant now);
  /// The same for one that has begun: what is done by now was done under the lease that ends now,
  /// so this comes before on_timeout().
  void fly_begun(Instant now);

  void answer(const Participant::Output& output, Instant now);
  /// `otherwise_engaged`: why it cannot take part, whatever the call; none where it can.
  void answer_call(const coalition::Announcement& announcement, coalition::Reason otherwise_engaged,
                   Instant now);
  /// Leaves its coalition. Its task is dropped when the outputs are answered.
  void withdraw(coalition::Reason reason, Instant now) { participant_.withdraw(reason, now); }
  /// As withdraw(), of that site, which the operator wants nobody at any more. A delivery that has
  /// begun is flown to its end.
  void leave_site(SiteId site, coalition::Reason why, Instant now);
  /// Another way to its task at the same time, clear of a hazard that bars the one it is on; false
  /// where there is none.
  [[nodiscard]] bool detour(HazardId hazard, Instant now);

  [[nodiscard]] std::optional<coalition::Message> poll_message();
  [[nodiscard]] std::optional<Participant::Output> poll_output();
  /// Either of these has something.
  [[nodiscard]] bool has_output() const { return participant_.has_output(); }

  /// It has a task.
  [[nodiscard]] bool flying() const { return task_.has_value(); }
  /// It is within its task's own run: that is flown to its end.
  [[nodiscard]] bool in_run() const { return task_ && task_->in_run(); }
  /// False where a hazard that has become known lies on what it is to fly from the gate on, or that
  /// leads out of a fence that was ordered: its flight plan holds it only once it has committed.
  [[nodiscard]] bool run_is_open() const;
  [[nodiscard]] std::optional<TaskId> task() const {
    return task_ ? std::optional{task_->assignment.task} : std::nullopt;
  }
  [[nodiscard]] bool delivers() const { return task_ && task_->is_delivery(); }
  /// It has a delivery that is not authorised yet.
  [[nodiscard]] bool awaits_decision() const {
    return delivers() && task_->in(TaskFlight::State::planned);
  }
  /// Its task's time has passed.
  [[nodiscard]] bool late() const { return task_ && task_->in(TaskFlight::State::late); }
  /// Why it has not bid lately.
  void tell_declined(Telemetry& telemetry, Instant now) const;
  /// It is in no coalition and has bid nowhere.
  [[nodiscard]] bool free() const { return participant_.free(); }
  [[nodiscard]] Instant next_timeout() const;
  /// Before then on_timeout(), fly() and fly_begun() do nothing.
  [[nodiscard]] Instant quiet_until(bool may_lead, Instant now) const;
  [[nodiscard]] coalition::Tally tally() const { return participant_.tally(); }

 private:
  using Why = coalition::Why;
  [[nodiscard]] std::variant<coalition::Bid, coalition::Reason> make_bid(
      const coalition::Announcement& announcement, Instant now) const;
  void answer_award(const Participant::AwardReceived& award, Instant now);
  [[nodiscard]] std::variant<TaskFlight, Why> set_out(TaskFlight task, double speed_mps,
                                                      Instant start, Instant now);
  void keep_time(Instant now);
  void commit_delivery(Instant now);
  void run_out(Path& path, double speed_mps) const;
  bool fly_run(Path rest, const TimedPath& timed, Instant at, Instant now);
  void run_on(Instant now);
  void begin(Instant now);
  void end(Instant now);
  void drop(Instant now);
  void take_back(const Authorisation& message, Instant now);
  [[nodiscard]] bool deliveries_over() const;

  Ownship& ownship_;
  Outbox& outbox_;
  Participant participant_;
  std::optional<TaskFlight> task_;
  struct Declined {
    DeclinedCall call;
    Instant at{};
  };
  std::optional<Declined> declined_;  ///< the newest call
  /// When the operator last decided against a site: what he had granted before counts no more, in
  /// whatever order his words come.
  std::map<SiteId, Instant> refused_at_;
  Instant time_again_{};  ///< when the task's time is looked at next
};

}  // namespace skein::mission
