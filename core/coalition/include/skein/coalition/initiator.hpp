// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
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

/// The leader's side of the contract net for one site: announces, collects bids, awards, renews
/// leases, and goes through further rounds for what is not done. It does no I/O, reads no clock and
/// plans nothing: it asks for an allocation (AllocationWanted) and is told (allocated(), ...).
/// The leader's own bid and tasks go through its own Participant like anybody's.
class Initiator {
 public:
  enum class State : std::uint8_t {
    announcing,
    allocating,
    awarding,
    executing,
    monitoring,
    closed,
    count
  };
  enum class Event : std::uint8_t {
    bids_closed,
    allocated,
    allocation_failed,
    confirmed,
    not_confirmed,
    try_again,
    all_done,
    closed,
    count
  };
  static constexpr auto kTable = state_table(
      from(State::announcing, on(Event::bids_closed, State::allocating),
           on(Event::closed, State::closed)),
      from(State::allocating, on(Event::allocated, State::awarding),
           on(Event::allocation_failed, State::monitoring), on(Event::closed, State::closed)),
      from(State::awarding, on(Event::confirmed, State::executing),
           on(Event::not_confirmed, State::monitoring), on(Event::closed, State::closed)),
      from(State::executing, on(Event::all_done, State::closed),
           on(Event::try_again, State::announcing), on(Event::closed, State::closed)),
      from(State::monitoring, on(Event::try_again, State::announcing),
           on(Event::all_done, State::closed), on(Event::closed, State::closed)));

  /// Bids are in. Answer with allocated() or allocation_failed() by `answer_by`.
  struct AllocationWanted {
    Round round;
    Instant formed_at{};
    std::vector<TaskId> tasks;
    std::vector<Bid> bids;  ///< by bidder id
    Instant answer_by{};
  };
  /// Everybody has confirmed.
  struct Formed {
    Round round;
    std::vector<TaskAssignment> assignments;
  };
  /// Not enough bids, or no plan, or an award unconfirmed: the leader monitors and tries again.
  struct NotFormed {
    Round round;
    Why why;
  };
  /// A task whose owner fell silent or failed: it is announced again.
  struct TaskLost {
    Round round;
    TaskAssignment assignment;
    Reason why;
  };
  /// A delivery that was due when its owner fell silent. Whether it was flown is not known, so it
  /// is not flown again.
  struct TaskUnknown {
    Round round;
    TaskAssignment assignment;
  };
  struct AllDone {
    Round round;
  };
  /// Another vehicle leads the site by now; this coalition is closed.
  struct Superseded {
    Round round;
    CoalitionId by;
  };
  using Output =
      std::variant<AllocationWanted, Formed, NotFormed, TaskLost, TaskUnknown, AllDone, Superseded>;

  /// Opens the first round at once: poll_message() has the announcement. `done` is what is known to
  /// be done already.
  Initiator(const ProtocolParams& params, const CoalitionId& id, const Site& site,
            const std::vector<TaskId>& done, const Vec2& leader_at_formation, Instant now);
  /// Takes over from a leader that fell silent: awards what is left of its plan, with its times, to
  /// those who follow. `authorised`: the operator's grant for the plan was heard.
  Initiator(const ProtocolParams& params, const CoalitionId& id, const Elector::Won& won,
            bool authorised, const Vec2& leader_at_formation, Instant now);

  void on_bid(const Bid& message, Instant now);
  void on_confirmation(const Confirmation& message, Instant now);
  void on_status(const MemberStatus& message, Instant now);
  void on_allegiance(const Allegiance& message, Instant now);
  /// Another vehicle leads the same site. Whose coalition does not stand gives up, and tells what
  /// it knows to be done; where both stand or neither does, the smaller id goes on.
  void on_rival(const Round& rival, bool rival_stands, Instant now);
  void on_timeout(Instant now);
  /// As configured, but for what it has learned: the planner is given longer where it was late,
  /// messages where bids came too late in a round that failed.
  [[nodiscard]] const ProtocolParams& params() const { return params_; }

  /// Also where they come too late: later rounds leave the planner half as long again as it took.
  void allocated(const Round& round, std::vector<TaskAssignment> assignments, Instant now);
  void allocation_failed(const Round& round, const std::string& detail, Instant now);
  /// The operator's grant came for that round: from then on a silent owner's delivery that is due
  /// may have been flown.
  void authorised(const Round& round);
  /// Opens another round for what is not done (times have become impossible).
  void announce_again(Reason why, Instant now);
  /// Ends the coalition and releases everyone.
  void close(const Why& why, Instant now);

  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] std::optional<Output> poll_output();
  /// Either of these has something.
  [[nodiscard]] bool has_output() const { return !messages_.empty() || !outputs_.empty(); }
  [[nodiscard]] Instant next_timeout() const;

  [[nodiscard]] State state() const { return machine_.state(); }
  [[nodiscard]] const Round& round() const { return announcement_.round; }
  [[nodiscard]] const Site& site() const { return announcement_.site; }
  [[nodiscard]] const Announcement& announcement() const { return announcement_; }
  /// Where the leader will be at the next formation, for its next announcement.
  void set_leader_at_formation(const Vec2& position) { leader_at_formation_ = position; }
  /// The latest time of a delivery that is done or may have been flown; nothing when there is none.
  [[nodiscard]] std::optional<Instant> last_delivery() const;
  /// What is said last: the coalition is over, and what became of its tasks.
  [[nodiscard]] LeaseRenewal farewell() const;
  /// What its owner may hold still, or have flown, after the coalition is closed: it may not have
  /// heard of that.
  struct Outstanding {
    TaskId task;
    VehicleId owner;
    Round round;
    Instant until{};           ///< nobody holds it any more
    bool maybe_flown = false;  ///< by then
  };
  [[nodiscard]] std::vector<Outstanding> outstanding() const;
  struct ElectorEntry {
    Instant acknowledged{Instant::min()};  ///< the stamp of the newest heartbeat that it answered
    InstanceId instance;                   ///< the one that was chosen: no other counts
    Instant awarded_at{Instant::min()};    ///< the newest award that it is part of

    /// It says that it follows nobody in the coalition any more; not before its newest award.
    [[nodiscard]] bool leaves_by(const Allegiance& message) const;
  };
  /// Who may choose another leader after this one has gone, and not have heard that it has.
  struct Electorate {
    CoalitionId coalition;
    std::map<VehicleId, ElectorEntry> others;  ///< than this leader
    std::size_t majority = 0;                  ///< as many of them as choose one
    Instant promised_until{};                  ///< so long too few of them can
    Instant until{};  ///< none of them can be at work under another any more

    [[nodiscard]] bool may_choose() const { return majority > 0 && others.size() >= majority; }
    void on_allegiance(const Allegiance& message, Instant now);
  };
  [[nodiscard]] Electorate electorate() const;
  /// The tasks that others still own in this round, with their times.
  [[nodiscard]] std::vector<TaskAssignment> owned() const;
  [[nodiscard]] Tally tally() const {
    return {machine_.protocol_errors(), bad_messages_, messages_.dropped() + outputs_.dropped()};
  }

 private:
  enum class Ownership : std::uint8_t { open, leased, done, unknown };
  struct Entry {
    TaskId task;
    Ownership ownership = Ownership::open;
    bool left_over = false;     ///< not part of the newest award: waits until that is flown
    bool maybe_flown = false;   ///< the ground station says so: unknown when its lease has ended
    InstanceId instance;        ///< of the owner, as it bid
    Instant begins{};           ///< when the owner begins its run at the earliest
    TaskAssignment assignment;  ///< of the owner, while leased, and of who did it
    Round round;                ///< of that award
    TaskState reported = TaskState::planned;
    Instant lease_until{};  ///< the latest that the owner may believe in
    Instant done_at{};
  };
  void make_ledger(const std::vector<TaskId>& done);
  [[nodiscard]] bool may_be_flown(const Entry& entry) const;
  void start_round(Instant now);
  void send_award(std::vector<TaskAssignment> assignments, Instant now);
  void start_anew(Instant now);
  void found(Instant now);
  [[nodiscard]] Instant authority_until() const;
  [[nodiscard]] bool has_authority(Instant now) const { return authority_until() > now; }
  [[nodiscard]] Instant starts_anew_at() const;
  void collect_open_tasks(Instant now);
  void close_bids(Instant now);
  void take_back(Entry& entry, const Bid& bid, Instant now);
  [[nodiscard]] Instant due(const Entry& entry) const;
  void expire(Instant now);
  void reopen(Entry& entry);
  void lose(Entry& entry, Reason why);
  void make_unknown(Entry& entry);
  void heartbeat(Instant now);
  void note_planning_time(Instant now);
  void note_late_bid(Instant now);
  void heed_late_bids();
  [[nodiscard]] Duration stagger() const;
  void not_formed(Event event, const Why& why, Instant now);
  void finish_if_done();
  [[nodiscard]] bool all_confirmed() const;
  [[nodiscard]] std::vector<TaskId> tasks_that_are(Ownership ownership) const;
  [[nodiscard]] bool hears(VehicleId member, Instant now) const;
  [[nodiscard]] Entry* find(const TaskId& task);

  ProtocolParams params_;
  StateMachine<State, Event> machine_{kTable, State::announcing};
  Announcement announcement_;
  Vec2 leader_at_formation_;
  Instant planning_since_{};   ///< of the newest round that got so far
  std::vector<Entry> ledger_;  ///< one entry a task, in the order of the site
  std::map<VehicleId, Bid> bids_;
  Duration late_bid_took_{};     ///< from the announcement of this round; 0: none was late
  std::set<VehicleId> doubled_;  ///< two programs have bid under these numbers
  std::optional<Award> award_;
  /// Taking over: how far the supporters' promises reach, and how many of them must come over to
  /// this coalition, so that the lost leader can never have a majority again.
  Instant promised_until_{Instant::max()};
  std::size_t majority_ = 0;
  std::map<VehicleId, bool> confirmed_;  ///< members of award_
  std::map<VehicleId, Instant> heard_;   ///< members, by when they last spoke
  /// Who was in the first coalition that stood, and may choose another leader; empty before. They
  /// only become fewer.
  std::map<VehicleId, ElectorEntry> electors_;
  std::set<std::uint32_t> authorised_rounds_;
  Instant deadline_{};  ///< of the present state
  Instant next_repeat_{};
  Instant next_heartbeat_{};
  std::uint64_t bad_messages_ = 0;
  BoundedQueue<Message> messages_{64};
  BoundedQueue<Output> outputs_{64};
};

[[nodiscard]] std::string_view to_string(Initiator::State state);
[[nodiscard]] std::string_view to_string(Initiator::Event event);

}  // namespace skein::coalition
