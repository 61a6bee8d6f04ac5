// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/coalition/protocol_params.hpp"

namespace skein::coalition {

/// A member's part in who leads its coalition. It follows its leader by a promise that each of the
/// leader's heartbeats renews: to follow nobody else for one lease. A leader leases tasks only as
/// far as the promises of half of its electors reach (Initiator); when they have all run out, the
/// electors may follow another, and who is followed by more than half of them leads on. So leases
/// of two leaders never overlap, whatever the network does (a leader lease after Gray and Cheriton
/// 1989). Electors only ever become fewer: who has nothing left to do in the coalition says so, and
/// follows nobody in it for ever after. Who has once followed another says nothing: to be counted
/// no more could give the lost leader a majority again.
class Elector {
 public:
  struct Supporter {
    VehicleId vehicle;
    InstanceId instance;
  };
  /// This vehicle is followed by more than half of the electors.
  struct Won {
    Award plan;                         ///< the latest that this vehicle was part of
    std::vector<Supporter> supporters;  ///< itself among them, by id
    std::size_t majority = 0;           ///< how many of the electors it takes to lead
    Instant promised_from{};            ///< its own stamp; their promises reach a lease from here
    std::vector<TaskId> done;           ///< as far as this vehicle has heard
  };

  Elector(const ProtocolParams& params, VehicleId self, InstanceId instance);

  /// The member has accepted that award.
  void accepted(const Award& award);
  /// The member has nothing to do in its coalition any more.
  void leave();
  /// So by its leader's word, who may wait to lead again until nobody can choose another (Scout).
  void cancelled();
  /// May this vehicle lead now? Otherwise it follows only.
  void set_may_lead(bool may_lead) {
    may_lead_ = may_lead;
    if (!may_lead) won_.reset();
  }
  [[nodiscard]] bool may_lead() const { return may_lead_; }

  void on_lease_renewal(const LeaseRenewal& message, Instant now);
  void on_claim(const LeadershipClaim& message, Instant now);
  void on_allegiance(const Allegiance& message, Instant now);
  void on_status(const MemberStatus& message);
  void on_timeout(Instant now);

  /// Its coalition may still find a successor that goes on with its plan.
  [[nodiscard]] bool awaits_successor() const { return elector_; }
  [[nodiscard]] bool follows_leader() const {
    return elector_ && follows_ == plan_->round.coalition.leader;
  }
  /// Does that award go on with this member's plan, from the successor that it follows?
  [[nodiscard]] bool succeeds(const Award& award) const;

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<Won> poll_won();
  /// Either of these has something.
  [[nodiscard]] bool has_output() const { return !messages_.empty() || won_.has_value(); }
  [[nodiscard]] Instant next_timeout() const;
  [[nodiscard]] std::uint64_t bad_messages() const { return bad_messages_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped(); }

 private:
  struct Support {
    Instant acknowledged{Instant::min()};  ///< the stamp of the newest claim that it answered
    InstanceId instance;
  };
  void follow(VehicleId whom, Instant stamp, Instant now);
  [[nodiscard]] bool promise_over(Instant now) const;
  [[nodiscard]] Instant claims_at() const;
  void count_supporters(Instant now);

  ProtocolParams params_;
  InstanceId instance_;
  VehicleId self_;
  VehicleId follows_;  ///< the leader, or a claimant
  bool may_lead_ = true;
  bool elector_ = false;  ///< of plan_'s coalition
  bool strayed_ = false;  ///< it has followed a claimant in that coalition
  std::optional<Award> plan_;
  std::vector<VehicleId> electors_;     ///< of plan_'s coalition, the leader among them
  Instant renewed_at_{Instant::min()};  ///< by the leader's clock: the newest renewal
  Instant promised_until_{};
  std::vector<TaskId> done_;
  std::map<VehicleId, Support> supporters_;  ///< of this vehicle's claim
  Instant next_claim_{};
  std::optional<Won> won_;
  std::vector<CoalitionId> left_;  ///< newest last
  std::uint64_t bad_messages_ = 0;
  BoundedQueue<Message> messages_{16};
};

}  // namespace skein::coalition
