// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/reexecution.hpp"

#include <deque>
#include <optional>
#include <utility>
#include <variant>

#include "skein/configuration/vehicle_config.hpp"
#include "skein/mission/vehicle_node.hpp"
#include "skein/onboard/node_config.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/recording/log.hpp"

namespace skein::hil {
namespace {

using recording::Content;
using recording::Entry;

/// Records that the recorder is late with, at most, when it notes that others had no room.
constexpr Duration kGapMargin = std::chrono::seconds{1};

class Rerun {
 public:
  Rerun(const configuration::VehicleConfig& config, const std::optional<TimedPath>& route)
      : config_{config}, route_{route} {
    result_.vehicle = config.vehicle.id;
  }

  /// False once there is no more to compare.
  bool take(const Entry& entry) {
    if (result_.gap && entry.time >= *result_.gap) return false;
    result_.until = std::max(result_.until, entry.time);
    std::visit([&](const auto& record) { on(record, entry); }, entry.content);
    return result_.difference.empty();
  }

  void end(bool recording_is_complete) {
    if (recording_is_complete && result_.difference.empty() && !result_.gap) {
      expect_nothing_left(result_.until);
    }
  }

  void gap_at(Instant time) {
    if (!result_.gap) result_.gap = time - kGapMargin;
  }
  [[nodiscard]] bool has_started() const { return node_.has_value(); }
  [[nodiscard]] const Reexecution& result() const { return result_; }

 private:
  template <class Other>
  void on(const Other& /*record*/, const Entry& /*entry*/) {}

  void on(const recording::AgentStart& start, const Entry& /*entry*/) {
    node_.emplace(onboard::node_config(config_, route_, start.instance, start.program), start.now);
    given_.clear();
    asked_.clear();
    collect();
  }
  void on(const recording::StateGiven& given, const Entry& entry) {
    input(entry.time, [&] { node_->on_state(given.state, given.now); });
  }
  void on(const recording::TimeoutGiven& given, const Entry& entry) {
    input(entry.time, [&] { node_->on_timeout(given.now); });
  }
  void on(const recording::PlanningGiven& given, const Entry& entry) {
    // A request for which the planner had no room got no answer.
    while (!asked_.empty() && asked_.front().round != given.round) asked_.pop_front();
    if (asked_.empty()) {
      differ(entry.time, "the planner answered, in the recording, what the agent does not ask now",
             named(entry.content), "nothing");
      return;
    }
    const mission::PlanningRequest request = std::move(asked_.front());
    asked_.pop_front();
    planning::PlanningBudget budget;
    std::uint64_t questions = 0;
    budget.expired = [&] {
      ++questions;
      return given.expired_after != 0 && questions >= given.expired_after;
    };
    const mission::PlanningResult result{
        request.round, planning::allocate(request.params, request.problem, budget), given.took};
    ++result_.allocations;
    input(entry.time, [&] { node_->on_planning_result(result, given.now); });
  }
  void on(const recording::NoticeGiven& given, const Entry& entry) {
    input(entry.time, [&] { node_->on_notice(given.notice, entry.time); });
  }
  void on(const recording::ConditionGiven& given, const Entry& entry) {
    input(entry.time, [&] { node_->on_condition(given.condition); });
  }
  void on(const recording::NamesakeHeard& /*heard*/, const Entry& /*entry*/) {
    namesake_follows_ = true;
  }
  void on(const mission::Message& message, const Entry& entry) {
    if (entry.sender != result_.vehicle || std::exchange(namesake_follows_, false)) {
      input(entry.time, [&] { node_->on_message(message, entry.sender, entry.time); });
      return;
    }
    // The process says that, not its node.
    if (std::holds_alternative<mission::Preflight>(message)) return;
    compare(entry);
    ++result_.messages;
  }
  void on(const recording::PlanMade& /*plan*/, const Entry& entry) {
    compare(entry);
    ++result_.plans;
  }
  void on(const recording::TrackMade& /*track*/, const Entry& entry) {
    compare(entry);
    ++result_.plans;
  }

  template <class Give>
  void input(Instant time, Give give) {
    if (!node_) return;
    expect_nothing_left(time);
    if (!result_.difference.empty()) return;
    ++result_.inputs;
    now_ = time;
    give();
    collect();
  }

  /// Takes what the node gives, in the order in which the process does.
  void collect() {
    while (const auto guidance = node_->poll_guidance()) {
      std::visit([this](auto made) { given_.emplace_back(std::move(made)); },
                 recording::made(*guidance, now_));
    }
    while (auto message = node_->poll_message()) {
      Content content{std::in_place_type<mission::Message>, std::move(*message)};
      // One that cannot be sent is not recorded either.
      if (!bytes_of(content).empty()) given_.push_back(std::move(content));
    }
    while (auto request = node_->poll_planning_request()) asked_.push_back(std::move(*request));
    while (node_->poll_event() || node_->poll_give_back() || node_->poll_fence()) {
    }
  }

  static std::string named(const Content& content) {
    return recording::type_of(content).append(" ").append(recording::text_of(content));
  }

  void compare(const Entry& entry) {
    if (!node_) return;
    if (given_.empty()) {
      differ(entry.time, "recorded, and not given now", named(entry.content), "nothing");
      return;
    }
    const Content now = std::move(given_.front());
    given_.pop_front();
    if (now.index() != entry.content.index() || bytes_of(now) != bytes_of(entry.content)) {
      differ(entry.time, "recorded, and given now otherwise", named(entry.content), named(now));
    }
  }

  void expect_nothing_left(Instant time) {
    if (given_.empty()) return;
    differ(time, "given now, and not recorded", "nothing", named(given_.front()));
  }

  void differ(Instant time, const std::string& what, const std::string& recorded,
              const std::string& now) {
    if (!result_.difference.empty()) return;
    result_.differs_at = time;
    result_.difference = what + "\n  recorded: " + recorded + "\n  now:      " + now;
  }

  const configuration::VehicleConfig& config_;
  std::optional<TimedPath> route_;
  std::optional<mission::VehicleNode> node_;
  Instant now_{};
  std::deque<Content> given_;  ///< by the node, and not yet found in the recording
  std::deque<mission::PlanningRequest> asked_;
  bool namesake_follows_ = false;
  Reexecution result_;
};

bool is_input(const Content& content) {
  return std::holds_alternative<recording::StateGiven>(content) ||
         std::holds_alternative<recording::TimeoutGiven>(content) ||
         std::holds_alternative<recording::PlanningGiven>(content);
}

}  // namespace

Result<Reexecution> reexecute(const std::filesystem::path& node_folder) {
  auto log = recording::Log::open(node_folder);
  if (!log) return log.error();
  const recording::Session& session = log->sessions().front();
  const std::string who = node_folder.string();
  if (session.node == kGroundStation)
    return Error{who + " is of the ground station: no agent flew"};
  auto config = configuration::parse_vehicle_config(session.configuration, who);
  if (!config) return config.error();
  auto route = configuration::timed_path(config->route, config->vehicle);
  if (!route) return route.error();

  Rerun rerun{*config, *route};
  bool has_inputs = false;
  bool from_start = false;
  log->for_each_written([&](const Entry& entry) {
    if (std::holds_alternative<recording::Gap>(entry.content)) rerun.gap_at(entry.time);
    if (std::holds_alternative<recording::AgentStart>(entry.content)) from_start = !has_inputs;
    has_inputs = has_inputs || is_input(entry.content);
    return true;
  });
  if (!from_start) {
    return Error{who + (has_inputs ? ": the start of the flight has given way to what came later; "
                                     "a larger recording_limit_mb keeps more"
                                   : ": nothing is recorded that an agent was given")};
  }
  log->for_each_written([&](const Entry& entry) { return rerun.take(entry); });
  rerun.end(log->is_complete() && log->damaged() == 0);
  Reexecution result = rerun.result();
  result.damaged = log->damaged();
  result.complete = log->is_complete();
  return result;
}

}  // namespace skein::hil
