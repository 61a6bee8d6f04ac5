// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"

/// The messages of the contract net (Wang 2022, eq. 19-25, and what the field needs besides).
/// Words after FIPA SC00029: announcement = call for proposals, bid = propose.
namespace skein::coalition {

/// One coalition: who founded it, and its number among those that this leader founded. `instance`
/// tells a leader that has restarted from its earlier self.
struct CoalitionId {
  VehicleId leader;
  InstanceId instance;
  std::uint32_t number = 0;
  friend auto operator<=>(const CoalitionId&, const CoalitionId&) = default;
};

/// A coalition goes through rounds: each announcement opens one, and an award of that round
/// replaces the award of any earlier one. Handled twice, every message has the effect of once.
struct Round {
  CoalitionId coalition;
  std::uint32_t number = 0;
  friend auto operator<=>(const Round&, const Round&) = default;
};

/// "Who can do these tasks?" (eq. 19)
struct Announcement {
  Round round;
  Site site;
  std::vector<TaskId> tasks;  ///< those still to be done
  Instant announced_at{};     ///< t0
  Instant bids_until{};       ///< later bids are not considered
  Instant formed_at{};        ///< t_e: what bids must predict their pose for (eq. 21)
  double reward = 0.0;        ///< of those tasks together; decides conflicts
  Vec2 leader_at_formation{0.0, 0.0};
};

/// "I can, and this is where I shall be." (eq. 22-23)
struct Bid {
  Round round;
  VehicleId bidder;
  InstanceId instance;  ///< of the bidder's program: one that has started anew remembers nothing
  Pose2 pose_at_formation;
  double speed_mps = 0.0;
  double planning_radius_m = 0.0;
  double range_left_m = 0.0;
  double final_approach_m = 0.0;
  double assess_radius_m = 0.0;
  Capabilities capabilities;
  std::uint8_t loads = 0;
  Instant eta{};  ///< at the site, by the shortest path with free final heading (eq. 23)
};

/// "These are your tasks." Names the whole plan, so that every member knows what the others do and
/// the plan survives its leader. A bidder of the round that is not in it is released (eq. 24-25).
struct Award {
  Round round;
  Site site;
  Instant formed_at{};
  std::vector<TaskAssignment> assignments;
  Instant awarded_at{};  ///< by the leader's clock; a renewal sent earlier is for earlier awards
  /// The lease: until then, and no longer, the members own their tasks. Renewed by LeaseRenewal.
  Instant lease_until{};
  /// The coalition whose plan this award goes on with under a new leader; leader 0 for none.
  CoalitionId continues{};
};

/// Why a vehicle does not bid, an award is refused, or a lease, a round or a coalition ends.
enum class Reason : std::uint8_t {
  none,
  // of who does not bid, or not accept
  held_by_operator,
  id_in_use,  ///< by another vehicle too
  surveying,
  leading,
  task_in_progress,
  out_of_range,  ///< not enough of it is left
  incapable,     ///< no capability or load for these tasks
  out_of_reach,  ///< of the leader's radio, before the coalition stands
  one_task_at_a_time,
  path_too_long,  ///< it has too many pieces
  no_path,        ///< Why::detail has the planner's words
  // of who leaves
  sent_home,    ///< by the operator
  path_barred,  ///< by a hazard
  new_round,    ///< the leader opened one
  bid_again,
  not_needed,
  award_too_late,
  no_award,
  no_successor,  ///< of the leader
  lease_ran_out,
  task_done,
  task_failed,
  // of the leader
  owners_silent,  ///< only tasks are open whose owners are silent
  electors_silent,
  no_allocation,  ///< Why::detail has the planner's words
  allocation_too_late,
  award_refused,  ///< by Why::vehicle, for the reason in Why::detail
  not_confirmed,  ///< by every member
  tasks_open,     ///< again
  owner_failed,
  owner_silent,
  superseded,  ///< Why::vehicle leads the site
  no_decision,
  refused_by_operator,
  yields,  ///< to a larger reward
  site_done,
  count
};
[[nodiscard]] std::string_view to_string(Reason reason);

struct Why {
  Reason reason = Reason::none;
  VehicleId vehicle{};   ///< whom the reason speaks of; 0: nobody
  std::string detail{};  ///< for people; at most kReasonMax
  friend auto operator<=>(const Why&, const Why&) = default;
};

/// A member's answer to an award.
struct Confirmation {
  Round round;
  VehicleId member;
  bool accepted = false;
  Why why;  ///< not
};

/// Everyone in the round is released, and every lease in it ends at once.
struct Cancel {
  Round round;
  Why why;
};

/// The leader's heartbeat to those members that it hears.
struct LeaseRenewal {
  Round round;
  SiteId site;
  std::vector<VehicleId> members;
  /// Who may choose another leader when this one falls silent (see Elector).
  std::vector<VehicleId> electors;
  std::vector<TaskId> done;     ///< known to be done: need not be reported again
  std::vector<TaskId> unknown;  ///< deliveries that may have been flown: nobody is to fly them
  Instant sent_at{};            ///< by the leader's clock; an Allegiance gives it back
  Instant lease_until{};
  bool closed = false;  ///< the site needs nobody any more; the coalition is over

  /// The coalition stands, and its leader has its electors behind it.
  [[nodiscard]] bool stands() const { return !electors.empty() && lease_until > sent_at; }
};

/// "The leader has fallen silent: follow me." Repeated every heartbeat until enough have answered.
struct LeadershipClaim {
  CoalitionId coalition;
  VehicleId claimant;
  Instant sent_at{};  ///< by the claimant's clock; an Allegiance gives it back
};

/// An elector's answer to a LeaseRenewal or a LeadershipClaim: whom it follows, and for how long it
/// will follow nobody else: ProtocolParams::lease from when it heard what it acknowledges.
struct Allegiance {
  CoalitionId coalition;
  VehicleId elector;
  InstanceId instance;     ///< of the elector's program: one that has started anew has no promise
  VehicleId follows;       ///< the leader or a claimant; 0: nobody any more, it is no elector
  Instant acknowledges{};  ///< sent_at of the renewal or claim
};

/// `unknown`: said by the ground station of a delivery that may have been flown by who fell silent.
enum class TaskState : std::uint8_t { planned, started, done, failed, unknown, count };
[[nodiscard]] std::string_view to_string(TaskState state);

/// A member's heartbeat to its leader, with the state of each of its tasks.
struct MemberStatus {
  struct Entry {
    TaskId task;
    TaskState state = TaskState::planned;
    Instant time{};  ///< when it came into that state
  };
  Round round;
  VehicleId member;
  std::vector<Entry> tasks;
};

using Message = std::variant<Announcement, Bid, Award, Confirmation, Cancel, LeaseRenewal,
                             MemberStatus, LeadershipClaim, Allegiance>;

/// Limits on what is accepted from the network; larger messages are dropped and counted.
inline constexpr std::size_t kTasksMax = 32;
inline constexpr std::size_t kMembersMax = 64;
inline constexpr std::size_t kReasonMax = 200;

}  // namespace skein::coalition
