// SPDX-License-Identifier: Apache-2.0
// What a vehicle decides about its own flight: gates, range, fence, others in the air.

const flyer = 'core/mission/task_flyer.cpp';
const formationAgent = 'core/mission/formation_agent.cpp';
const ownship = 'core/mission/ownship.cpp';
const separation = 'core/mission/separation_watch.cpp';

export default [
  {
    name: 'gate-passed-late',
    slip: 'a delivery is still committed at its gate, where the turn away is begun already',
    promise: 'a vehicle that is not committed in time does not pass its gate',
    file: flyer,
    from: 'now >= gate - kCommitLead && now <= gate - kCommitLatest;',
    to: 'now >= gate - kCommitLead && now <= gate + kCommitLatest;',
  },
  {
    name: 'lease-to-the-gate-only',
    slip: 'a delivery is committed with a lease that ends before it is over',
    promise: 'a delivery is flown under its lease to its end',
    file: flyer,
    from: 'if (!participant_.holds(task_->assignment.task, now, task_->end_time())) return;',
    to: 'if (!participant_.holds(task_->assignment.task, now, task_->begin_time())) return;',
  },
  {
    name: 'grant-of-another-vehicle',
    slip: 'the grant of the same delivery by another vehicle counts',
    promise: 'a delivery is flown as the operator saw it',
    file: flyer,
    from: 'return granted.assignment.task == ours.task && granted.assignment.vehicle == ours.vehicle &&',
    to: 'return granted.assignment.task == ours.task &&',
  },
  {
    name: 'grant-after-its-time',
    slip: 'a grant counts after the time for which the operator gave it',
    promise: 'an authorisation ends',
    file: flyer,
    from: 'return now <= message.until && std::ranges::any_of(message.deliveries, is_ours);',
    to: 'return now < Instant::max() && std::ranges::any_of(message.deliveries, is_ours);',
  },
  {
    name: 'older-refusal-hides-the-newer',
    slip: 'the refusal that was heard last counts, not the one that was said last',
    promise: 'the later decision counts, in whatever order they come',
    file: flyer,
    from: 'refused_at = std::max(refused_at, message.decided_at);',
    to: 'refused_at = message.decided_at;',
  },
  {
    name: 'assessment-before-the-wait',
    slip: 'the wait after the last delivery is added where it is to be taken off',
    promise: 'assessments wait until the site may be assessed',
    file: flyer,
    from: 'if (!since || *since > task_->begin_time() + kNewsMayTake - site.assess_wait) return false;',
    to: 'if (!since || *since > task_->begin_time() + kNewsMayTake + site.assess_wait) return false;',
  },
  {
    name: 'load-used-twice',
    slip: 'what a delivery takes off the loads is not counted',
    promise: 'no vehicle delivers more than it carries',
    file: flyer,
    from: `&& !task_->strayed;
  if (task_->is_delivery()) ownship_.use_load();`,
    to: `&& !task_->strayed;
  if (task_->is_delivery() && !flown) ownship_.use_load();`,
  },
  {
    name: 'arc-left-counts',
    slip: 'an assessment counts as flown though its arc was left',
    promise: 'what is told as done was flown as it was to be',
    file: flyer,
    from: 'task_->strayed = task_->strayed || !ownship_.on_arc(task_->site.position, radius_m);',
    to: 'task_->strayed = task_->strayed && !ownship_.on_arc(task_->site.position, radius_m);',
  },
  {
    name: 'goes-on-where-its-old-plan-is',
    slip: 'who is given back by its pilot does not begin where it is',
    promise: 'a plan begins where the vehicle is',
    file: 'core/mission/vehicle_agent_failsafe.cpp',
    from: 'const bool is_given_back = failsafe_.facts().piloted && !piloted;',
    to: 'const bool is_given_back = failsafe_.facts().piloted && piloted;',
  },
  {
    name: 'bid-without-the-way-home',
    slip: 'a bid does not leave the range for the way home',
    promise: 'who comes home has the range for it',
    file: ownship,
    from: `  const Pose2 there{site.position.x(), site.position.y(), 0.0};
  const double turn_m = kTwoPi * planning_radius_m();
  return range_to_spend(at) - flight_.way_home_m(there, hazards()) - spec().assess_radius_m -
         turn_m;`,
    to: `  const Pose2 there{site.position.x(), site.position.y(), 0.0};
  const double turn_m = kTwoPi * planning_radius_m();
  return range_to_spend(at) - 0.0 * flight_.way_home_m(there, hazards()) - spec().assess_radius_m -
         turn_m;`,
  },
  {
    name: 'turns-for-home-late',
    slip: 'the range is looked at half as often as it can matter',
    promise: 'who comes home has the range for it',
    file: ownship,
    from: 'return spare_m / (2.0 * spec().cruise_speed_mps);',
    to: 'return spare_m / (0.5 * spec().cruise_speed_mps);',
  },
  {
    name: 'range-of-the-turn-added',
    slip: 'the turn that the way home may need is added to the range, not taken off',
    promise: 'who comes home has the range for it',
    file: ownship,
    from: 'return range_left(at) - kTwoPi * planning_radius_m();',
    to: 'return range_left(at) + kTwoPi * planning_radius_m();',
  },
  {
    name: 'reserve-of-the-battery-spent',
    slip: 'the battery\'s reserve counts as range',
    promise: 'a flight ends with the reserve in the battery',
    file: 'core/mission/range_budget.cpp',
    from: 'return (*percent_ - reserve_percent_) * metres_per_percent_ - since_m;',
    to: 'return *percent_ * metres_per_percent_ - since_m;',
  },
  {
    name: 'orbit-out-of-the-fence',
    slip: 'an orbit to the right, whose radius is negative, is looked at as if it had no width',
    promise: 'no plan leads out of the fence',
    file: ownship,
    from: 'return fence_room_m(fence, centre, std::abs(radius_m)) >= wanted_m;',
    to: 'return fence_room_m(fence, centre, radius_m) >= wanted_m;',
  },
  {
    name: 'fence-without-a-ceiling',
    slip: 'the height of the fence is not watched',
    promise: 'nobody is outside of the fence, nor above it',
    file: ownship,
    from: 'if (!in_fence({state_.x_m, state_.y_m}) || state_.z_m > config_.fence.height_max_m) return true;',
    to: 'if (!in_fence({state_.x_m, state_.y_m})) return true;',
  },
  {
    name: 'plans-with-the-tightest-turn',
    slip: 'plans turn as tightly as the airframe can, without the margin that wind takes',
    promise: 'turns are as wide as the wind takes',
    file: ownship,
    from: `          vehicle.cruise_speed_mps,
          planning_radius_m(),`,
    to: `          vehicle.cruise_speed_mps,
          vehicle.turn_radius_m,`,
  },
  {
    name: 'order-overruled',
    slip: 'who was told to hold goes on when its setup agrees again',
    promise: 'an order holds until the operator says otherwise',
    file: 'core/mission/failsafe.cpp',
    from: `  if (facts_.ordered) return nullptr;
  if (bar != Bar::none) return barred();`,
    to: '  if (bar != Bar::none) return barred();',
  },
  {
    name: 'range-after-the-fence',
    slip: 'who has left the fence is told to come in again, although it was told to hold',
    promise: 'the operator\'s order comes first',
    file: 'core/mission/failsafe.cpp',
    from: 'if (!facts_.ordered) response = &kLeftFence;',
    to: 'response = &kLeftFence;',
  },
  {
    name: 'gives-way-towards-the-other',
    slip: 'who is above gives way downwards, and who is below upwards',
    promise: 'who gives way goes away from the other',
    file: separation,
    from: 'const bool up = level ? self_ > id : above_m > 0.0;',
    to: 'const bool up = level ? self_ > id : above_m < 0.0;',
  },
  {
    name: 'delay-not-counted',
    slip: 'the other\'s place is taken as of when it was heard, not of when it was there',
    promise: 'a conflict is seen look-ahead seconds before',
    file: separation,
    from: `  const double age_s = to_seconds(now - other.heard + other.delay);
  const double own_age_s`,
    to: `  const double age_s = to_seconds(now - other.heard);
  const double own_age_s`,
  },
  {
    name: 'both-give-way',
    slip: 'who has a task gives way to who has none, and the other to it',
    promise: 'one of a pair gives way, the same by both',
    file: separation,
    from: 'if (own_task != other_task) return other_task;',
    to: 'if (own_task != other_task) return true;',
  },
  {
    name: 'hold-at-home-not-looked-at',
    slip: 'of a way home the orbit at its end is not looked at',
    promise: 'no plan enters a hazard, one round of its hold included',
    file: 'core/mission/return_way.cpp',
    from: 'const auto all = way.piece(0.0, length_m + kTwoPi / std::abs(way.tail_curvature_per_m));',
    to: 'const auto all = way.piece(0.0, length_m);',
  },
  {
    name: 'decision-wanted-too-late',
    slip: 'the operator is given the margin in which the decision has to reach the members',
    promise: 'a decision in time reaches its vehicles in time',
    file: 'core/mission/leader.cpp',
    from: 'return delivery.time - approach - kDecisionMargin;',
    to: 'return delivery.time - approach + kDecisionMargin;',
  },
  {
    name: 'older-telemetry-shown',
    slip: 'telemetry that comes late takes the place of newer',
    promise: 'the one picture is the newest that was heard',
    file: 'core/mission/fleet.cpp',
    from: 'if (!is_late(telemetry)) entry.telemetry = telemetry;',
    to: 'entry.telemetry = telemetry;',
  },
  {
    name: 'piloted-flies-its-change-on',
    slip: 'a copter of a formation is led on in its change while its pilot has it',
    promise: 'whom its pilot has is led nowhere',
    file: 'core/mission/include/skein/mission/formation_agent.hpp',
    from: 'return held_ || piloted_ || bar_',
    to: 'return held_ || bar_',
  },
  {
    name: 'given-back-flies-to-its-old-place',
    slip: 'a copter that its pilot gives back goes on from where its change had it',
    promise: 'who is given back goes on from where it is',
    file: formationAgent,
    from: 'rests_at_ = here(*state_);\n    change_.reset();',
    to: 'rests_at_ = reference(now);\n    change_.reset();',
  },
  {
    name: 'strays-run-into',
    slip: 'who moves in a formation stops only once it is at whoever is off what it follows',
    promise: 'separation is kept from who is where nobody expects it',
    file: formationAgent,
    from: 'return then_m < least_m && then_m < now_m;',
    to: 'return then_m < 0.5 * least_m && then_m < now_m;',
  },
  {
    name: 'piloted-kept-clear-of-where-it-was-led',
    slip: 'changes keep clear of where a piloted vehicle was led to, not of where it is',
    promise: 'separation is kept from whom its pilot has',
    file: 'core/mission/formation_ground.cpp',
    from: 'if (is_with_pilot(member)) return {member.status.position_m};',
    to: 'if (is_with_pilot(member)) return {member.status.reference_m};',
  },
];
