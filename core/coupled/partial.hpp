// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model.hpp"

namespace skein::planning::coupled {

/// A plan that is being built, one task after the other: every task has its final time, but for the
/// deliveries of one site (the group) while some of them are still to be given away; those have the
/// earliest common moment so far.
///
/// So that a plan is not built in many ways, what is added (a task, or a group as one) must not be
/// earlier than anything that it could have come before: what was added since the last that shares
/// its site or a vehicle. Without offsets this is the order of the times.
class PartialPlan {
 public:
  struct Step {
    Index vehicle = kNone;
    Index visit = kNone;
  };
  struct Site {
    bool survey_open = false;
    int deliveries_open = 0;
    int assessments_open = 0;
    bool untouched = false;  ///< optional, and nothing of it is done: it may be left out
    double ready_s = 0.0;    ///< when what comes next may be done

    [[nodiscard]] bool is_open() const {
      return survey_open || deliveries_open > 0 || assessments_open > 0;
    }
  };
  struct Vehicle {
    double free_s = 0.0;
    Index last = kNone;  ///< visit
    int loads = 0;
  };
  /// What undo needs.
  struct Before {
    Vehicle vehicle;
    double cost = 0.0;
    double floor_s = 0.0;
    double common_s = 0.0;
    double ready_s = 0.0;
    Index group_site = kNone;
    std::size_t group_begin = 0;
    std::size_t jobs = 0;
    bool untouched = false;
  };

  explicit PartialPlan(const Model& model);

  [[nodiscard]] double time_of(const Step& step) const;
  /// Within range, with a load where it needs one, in the order above? The last delivery of a group
  /// may still turn out to be too late, see cost().
  [[nodiscard]] bool allows(const Step& step) const;
  [[nodiscard]] Before apply(const Step& step);
  void undo(const Step& step, const Before& before);

  [[nodiscard]] const std::vector<Site>& sites() const { return sites_; }
  [[nodiscard]] const std::vector<Vehicle>& vehicles() const { return vehicles_; }
  [[nodiscard]] const Orders& orders() const { return orders_; }
  [[nodiscard]] const Set128& done() const { return done_; }
  /// What is left may be left out.
  [[nodiscard]] bool may_end() const { return must_ == 0 && group_site_ == kNone; }
  /// Of leaving it out.
  [[nodiscard]] double left_out_cost() const;
  [[nodiscard]] Index left() const { return left_; }
  /// Of what has its final time; infinite when the plan came to nothing.
  [[nodiscard]] double cost() const { return cost_; }
  [[nodiscard]] double floor_s() const { return floor_s_; }  ///< nothing to come is before it
  /// The site of the group, and how many of its deliveries are given away; kNone between groups.
  [[nodiscard]] Index group_site() const { return group_site_; }
  [[nodiscard]] std::size_t group_size() const { return members_.size() - group_begin_; }
  [[nodiscard]] double common_s() const { return common_s_; }

 private:
  /// A delivery given away.
  struct Member {
    Index vehicle;
    Index task;
    Index last;     ///< the visit that the vehicle came from
    double free_s;  ///< when it was free there
  };

  [[nodiscard]] std::span<const Member> group() const {
    return std::span{members_}.subspan(group_begin_);
  }
  /// Something added.
  struct Job {
    double time_s;
    Mask vehicles;
    Index site;
  };
  [[nodiscard]] bool comes_after_all(const Job& job) const;
  void add_job(const Job& job);
  void set_common(double common_s);
  void close_group();

  const Model& model_;
  std::vector<Site> sites_;
  std::vector<Vehicle> vehicles_;
  Orders orders_;
  Set128 done_;
  Index left_ = 0;
  int must_ = 0;  ///< tasks that are left, and cannot be left out
  double cost_ = 0.0;
  double floor_s_ = 0.0;
  Index group_site_ = kNone;
  double common_s_ = 0.0;
  std::vector<Job> jobs_;
  std::vector<Member> members_;  ///< of all sites, as they were given away
  std::size_t group_begin_ = 0;  ///< the first of the group
};

}  // namespace skein::planning::coupled
