// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/vehicle_node.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "fence_keeper.hpp"
#include "self_report.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/order_book.hpp"
#include "skein/mission/shown_state.hpp"
#include "told_book.hpp"

namespace skein::mission {
namespace {

// A detection is said several times, since a lost one is seen by nobody.
constexpr int kDetectionTimes = 3;
constexpr Duration kDetectionAgain = std::chrono::seconds{2};
constexpr std::size_t kDetectionsMax = 16;
/// From the first answer about the orders on, the answers of others are heard for so long.
constexpr Duration kAnswersFor = std::chrono::seconds{5};
constexpr Duration kClocksDiffer = std::chrono::seconds{1};
// Who passes on what was told begins in turn, and leaves out what others have passed on by then.
constexpr Duration kTurn = std::chrono::milliseconds{50};
constexpr unsigned kTurns = 16;
constexpr int kPassedOnAtOnce = 8;
constexpr std::size_t kPassedOnMax = ToldBook::kHazardsMax + ToldBook::kSitesMax;
constexpr Duration kPassedOnEvery = std::chrono::milliseconds{100};

struct MakeAgent {
  Instant now;
  std::unique_ptr<OnboardAgent> operator()(const VehicleAgentConfig& config) const {
    return std::make_unique<VehicleAgent>(config, now);
  }
  std::unique_ptr<OnboardAgent> operator()(const FormationAgentConfig& config) const {
    return std::make_unique<FormationAgent>(config, now);
  }
  std::unique_ptr<OnboardAgent> operator()(const TrackAgentConfig& config) const {
    return std::make_unique<TrackAgent>(config, now);
  }
};

/// What is of no use from a node that runs with another setup.
bool is_joint_work(const Message& message) {
  return std::holds_alternative<coalition::Message>(message) ||
         std::holds_alternative<SiteReport>(message) ||
         std::holds_alternative<Authorisation>(message);
}

/// The ground station plans ways home from what vehicles tell that they fly, and sees by that who
/// has taken up his.
bool is_about_return(const Message& message, VehicleId self) {
  const auto* command = std::get_if<Command>(&message);
  const auto* way = std::get_if<ReturnFlight>(&message);
  const bool ordered = command != nullptr && command->kind == CommandKind::return_home &&
                       (command->vehicle == self || command->vehicle == kGroundStation);
  return ordered || (way != nullptr && way->vehicle == self);
}

bool speaks_of_ground(const EventBody& news) {
  const auto* differs = std::get_if<event::SetupDiffers>(&news);
  const auto* agrees = std::get_if<event::SetupAgrees>(&news);
  return (differs != nullptr && differs->node == kGroundStation) ||
         (agrees != nullptr && agrees->node == kGroundStation);
}

Health unchanging(const VehicleNodeConfig& config, const Telemetry& telemetry) {
  Health health;
  health.vehicle = telemetry.vehicle;
  health.instance = telemetry.instance;
  health.program = config.program;
  health.flight_controller = config.flight_controller;
  return health;
}

}  // namespace

class VehicleNode::Impl {
 public:
  Impl(const VehicleNodeConfig& config, Instant now)
      : agent{std::visit(MakeAgent{now}, config.agent)},
        self{agent->telemetry().vehicle},
        flies_routes{std::holds_alternative<VehicleAgentConfig>(config.agent)},
        traffic{config.traffic},
        telemetry_pace{config.telemetry},
        self_report{unchanging(config, agent->telemetry()), now},
        setup{config.setup, self, agent->telemetry().instance, now},
        fence{config.fence},
        knows_orders{!starts_anew(now)},
        knows_orders_first_hand{knows_orders},
        answers_until{knows_orders ? Instant::min() : Instant::max()},
        next_telemetry{now} {
    if (!knows_orders) report(event::VehicleTrouble{event::Trouble::orders_unknown}, now);
    update_bar(now);
    take_guidance();
  }

  void take_guidance() {
    auto newest = agent->poll_guidance();
    if (!newest) return;
    if (const auto* plan = std::get_if<FlightPlan>(&*newest)) self_report.on_plan(*plan);
    guidance = *newest;
  }

  void report(EventBody body, Instant at) {
    MissionEvent event{self, at, {}, {}, std::move(body)};
    messages.push(event);
    events.push(std::move(event));
  }

  void update_bar(Instant now) {
    const bool differs =
        setup.difference(kGroundStation) != nullptr || setup.difference(self) != nullptr;
    const Bar now_barred = differs        ? Bar::setup_differs
                           : knows_orders ? Bar::none
                                          : Bar::orders_unknown;
    if (now_barred == std::exchange(bar, now_barred)) return;
    agent->on_bar(bar, now);
  }

  void take_news(Instant now) {
    bool any = false;
    for (auto news = setup.poll_news(); news; news = setup.poll_news()) {
      // In a large team everybody would tell of everybody: the ground station tells of vehicles.
      if (!setup.knows(kGroundStation) || speaks_of_ground(*news)) report(*std::move(news), now);
      any = true;
    }
    if (any) update_bar(now);
  }

  void on_setup(const Setup& message, Instant now) {
    setup.on_setup(message, now);
    take_news(now);
    // The ground station is asked first; where it does not answer, whoever knows does.
    // Who has it from others alone cannot tell that none stands for somebody else.
    if (message.knows_orders || message.node == kGroundStation || !knows_orders_first_hand) return;
    const auto asked = asked_before.find(message.node);
    if (asked != asked_before.end() && asked->second == message.instance) {
      messages.push(Message{orders.standing(message.node, self)});
      to_pass_on = told_book.all(self);
      pass_on_at = now + kTurn * (self.value % kTurns);
    } else if (asked != asked_before.end() || asked_before.size() < OrderBook::kVehiclesMax) {
      asked_before[message.node] = message.instance;
    }
  }

  /// Before the agent has its first state it could do nothing about it.
  void obey(const Command& command, Instant now) {
    if (started) {
      agent->on_message(Message{command}, kGroundStation, now);
    } else {
      waiting = command;
    }
  }

  void on_first_state(Instant now) {
    started = true;
    if (waiting) obey(*std::exchange(waiting, {}), now);
  }

  /// An act, which buries no order that was said before it and comes after it.
  void on_give_back(const Command& command, Instant now) {
    if (!acts.take(command, self)) return;
    report(event::Commanded{command.kind}, now);
    if (command.vehicle == self) give_back = issued_at(command);
  }

  /// Of another vehicle, that passes on the order that stands for this one.
  [[nodiscard]] bool is_answer(const Command& command, Instant now) const {
    // One of the future would bury all that the operator says until then.
    const bool was_said = number_of(command) == 0 || issued_at(command) <= now + kClocksDiffer;
    return command.vehicle == self && command.kind != CommandKind::give_back && was_said &&
           now < answers_until;
  }

  void on_command(const Command& command, VehicleId sender, Instant now) {
    const bool passed_on = sender != kGroundStation;
    // Of those who answer some have missed the newest: each is heard for a while.
    if (passed_on && !is_answer(command, now)) return;
    if (!passed_on) {
      orders.note(command);
      knows_orders_first_hand = knows_orders_first_hand || command.vehicle == self;
    }
    if (command.kind == CommandKind::give_back) return on_give_back(command, now);
    if (commands.take(command, self)) obey(command, now);
    if (knows_orders || command.vehicle != self) return;
    knows_orders = true;
    answers_until = passed_on ? now + kAnswersFor : now;
    report(event::OrdersKnown{sender}, now);
    update_bar(now);
  }

  /// Before the first state it is not known whether it can: it is said again.
  void on_fence(const FenceOrder& order, Instant now) {
    const auto asked = fence.asked(order);
    if (!asked || !state) return;
    std::string why = FenceKeeper::why_not(*asked, *state);
    if (why.empty()) why = agent->keep_fence(*asked, now);
    if (auto answer = fence.answer(order, *asked, why)) report(*std::move(answer), now);
  }

  /// In formation: routes are for vehicles that work in coalitions.
  void refuse_route(const Route& route) {
    if (route.vehicle != self || route.step == RouteStep::call_off) return;
    messages.push(Message{RouteStatus{self, agent->telemetry().instance, route.plan,
                                      RouteState::refused, RouteObstacle::in_formation}});
  }

  [[nodiscard]] bool is_of_use(const Message& message, VehicleId sender) const {
    return !is_joint_work(message) || setup.difference(sender) == nullptr;
  }

  /// Of hazards and sites. Whether it is for the agent: what others pass on is for who has just
  /// started anew.
  bool take_lasting(const Message& message, Instant now) {
    if (told_by(message) == kGroundStation) {
      told_book.note(message);
      return true;
    }
    std::erase_if(to_pass_on, [&](const Message& ours) { return is_same_word(ours, message); });
    const auto* site = std::get_if<SiteReport>(&message);
    const auto* hazard = std::get_if<HazardReport>(&message);
    const bool can_be = site != nullptr ? site->withdrawn : hazard != nullptr && !hazard->withdrawn;
    return can_be && now < answers_until && ++taken_passed_on <= kPassedOnMax;
  }

  void pass_on(Instant now) {
    if (now < pass_on_at) return;
    for (int i = 0; i < kPassedOnAtOnce && !to_pass_on.empty(); ++i) {
      messages.push(std::move(to_pass_on.front()));
      to_pass_on.pop_front();
    }
    pass_on_at = to_pass_on.empty() ? Instant::max() : now + kPassedOnEvery;
  }

  /// Of a detector on board. One that tells more than can be said is not heard in everything.
  void on_detection(Detection detection, Instant now) {
    if (told.size() >= kDetectionsMax) {
      ++detections_dropped;
      return;
    }
    detection.vehicle = self;
    detection.number = ++detections;
    told.push_back({std::move(detection), now, kDetectionTimes});
    say_detections(now);
  }

  void say_detections(Instant now) {
    for (Told& of : told) {
      if (now < of.next) continue;
      messages.push(Message{of.detection});
      of.next = now + kDetectionAgain;
      --of.times;
    }
    std::erase_if(told, [](const Told& of) { return of.times == 0; });
  }

  void watch_traffic(Instant now) {
    if (flies_routes || !traffic.watches() || !state) return;
    traffic.step({.state = *state, .layer_m = state->z_m}, now);
    while (auto news = traffic.poll_event()) report(*std::move(news), now);
  }

  void report_itself(Instant now) {
    watch_traffic(now);
    say_detections(now);
    pass_on(now);
    if (now >= next_telemetry && state) {
      next_telemetry = next_multiple(now, telemetry_pace.period(*state, now));
      Telemetry telemetry = agent->telemetry();
      telemetry.state = *state;
      // Before mission time 0 the agent has seen no state.
      const auto shown = shown_state(telemetry.activity, telemetry.detail);
      if (shown == ShownState::waiting_for_the_start && state->on_ground()) {
        telemetry.detail = ActivityDetail::on_ground;
      }
      telemetry.control_overruns = static_cast<std::uint32_t>(condition.overruns);
      telemetry.messages_dropped = static_cast<std::uint32_t>(dropped());
      messages.push(Message{telemetry});
    }
    if (const auto plan = self_report.plan_due(now)) messages.push(Message{*plan});
    if (const auto ours = setup.poll_setup({knows_orders, commands.newest()}, now)) {
      messages.push(Message{*ours});
    }
    if (!self_report.health_due(now)) return;
    SelfReport::Facts facts{
        .condition = condition,
        .refused = refused,
        .differs = setup.difference(kGroundStation),
        .knows_orders = knows_orders,
        .range_spent = agent->range_spent(),
        .separation = agent->separation_conflict(),
        .fence = digest_of(fence.fence()),
        .traffic = flies_routes ? agent->traffic_conflict() : traffic.conflict()};
    facts.condition.dropped = dropped();
    if (state) facts.state_at = state->time;
    messages.push(Message{self_report.health(facts, now)});
  }

  [[nodiscard]] Counters counters() const {
    Counters all = agent->counters();
    all.refused += refused;
    all.messages_dropped += messages.dropped() + detections_dropped;
    all.events_dropped += events.dropped();
    return all;
  }
  [[nodiscard]] std::uint64_t dropped() const {
    const Counters ours = counters();
    return condition.dropped + ours.messages_dropped + ours.events_dropped;
  }

  std::unique_ptr<OnboardAgent> agent;
  VehicleId self;
  bool flies_routes;
  TrafficWatch traffic;  ///< of a formation, which keeps its places: people decide
  TelemetryPace telemetry_pace;
  SelfReport self_report;
  SetupBook setup;
  FenceKeeper fence;
  OrderBook orders;
  ToldBook told_book;
  std::deque<Message> to_pass_on;
  std::size_t taken_passed_on = 0;  ///< of others
  Instant pass_on_at = Instant::max();
  std::map<VehicleId, InstanceId> asked_before = {};  ///< who wanted to know the orders
  bool knows_orders;
  bool knows_orders_first_hand;    ///< was there, or has it from the ground station
  Instant answers_until;           ///< of others than the ground station
  bool started = false;            ///< the agent has had a state
  std::optional<Command> waiting;  ///< for that
  Bar bar = Bar::none;
  std::optional<VehicleState> state;
  Condition condition;
  std::optional<Guidance> guidance;
  std::optional<Instant> give_back;
  CommandFilter commands;  ///< that stand
  CommandFilter acts;
  std::uint64_t refused = 0;
  struct Told {
    Detection detection;
    Instant next{};
    int times = 0;  ///< still to be said
  };
  std::vector<Told> told;  ///< to the ground station
  std::uint32_t detections = 0;
  std::uint64_t detections_dropped = 0;
  Instant next_telemetry;
  BoundedQueue<Message> messages{64};  ///< the node's own
  BoundedQueue<MissionEvent> events{64};
};

VehicleNode::VehicleNode(const VehicleNodeConfig& config, Instant now)
    : impl_{std::make_unique<Impl>(config, now)} {}
VehicleNode::~VehicleNode() = default;
VehicleNode::VehicleNode(VehicleNode&&) noexcept = default;
VehicleNode& VehicleNode::operator=(VehicleNode&&) noexcept = default;

void VehicleNode::on_state(const VehicleState& state, Instant now) {
  impl_->state = state;
  if (now >= Instant{} && state.time >= Instant{}) {
    impl_->agent->on_state(state, now);
    if (!impl_->started) impl_->on_first_state(now);
    impl_->take_guidance();
  }
  impl_->report_itself(now);
}

void VehicleNode::on_message(const Message& message, VehicleId sender, Instant now) {
  if (!may_say(message, sender)) {
    ++impl_->refused;
    return;
  }
  impl_->self_report.on_heard(sender, now);
  if (is_about_return(message, impl_->self)) impl_->self_report.plan_wanted();
  if (const auto* detection = std::get_if<Detection>(&message)) {
    if (sender == kSensors) impl_->on_detection(*detection, now);
    return;  // others tell the ground station
  }
  if (const auto* command = std::get_if<Command>(&message)) {
    impl_->on_command(*command, sender, now);
  } else if (const auto* setup = std::get_if<Setup>(&message)) {
    impl_->on_setup(*setup, now);
  } else if (const auto* route = std::get_if<Route>(&message);
             route != nullptr && !impl_->flies_routes) {
    impl_->refuse_route(*route);
  } else if (const auto* fence = std::get_if<FenceOrder>(&message)) {
    impl_->on_fence(*fence, now);
  } else if (const auto* traffic = std::get_if<Traffic>(&message);
             traffic != nullptr && !impl_->flies_routes) {
    impl_->traffic.on_traffic(*traffic);
  } else if (impl_->is_of_use(message, sender) && impl_->take_lasting(message, now)) {
    if (const auto* telemetry = std::get_if<Telemetry>(&message)) {
      impl_->setup.on_time(sender, telemetry->state.time, now);
      impl_->telemetry_pace.hear(sender, telemetry->state, now);
      impl_->take_news(now);
    }
    impl_->agent->on_message(message, sender, now);
  }
  impl_->take_guidance();
}

void VehicleNode::on_planning_result(const PlanningResult& result, Instant now) {
  impl_->agent->on_planning_result(result, now);
  impl_->take_guidance();
}

void VehicleNode::on_notice(const FlightNotice& notice, Instant now) {
  if (const auto piloted = tells_piloted(notice.what.news)) {
    impl_->agent->on_piloted(*piloted, now);
    impl_->take_guidance();
  }
  if (notice.warning) impl_->report(event::FlightWarning{notice.what}, notice.time);
}

void VehicleNode::on_condition(const Condition& condition) { impl_->condition = condition; }
bool VehicleNode::wants_condition(Instant now) const {
  return now >= impl_->next_telemetry || impl_->self_report.health_due(now);
}

void VehicleNode::on_timeout(Instant now) {
  if (now >= Instant{}) {
    impl_->agent->on_timeout(now);
    impl_->take_guidance();
  }
  impl_->report_itself(now);
}

std::optional<Message> VehicleNode::poll_message() {
  if (auto message = impl_->agent->poll_message()) return message;
  return impl_->messages.pop();
}
std::optional<Guidance> VehicleNode::poll_guidance() {
  if (!impl_->guidance) return std::nullopt;  // what is not there is kilobytes to copy, too
  return std::exchange(impl_->guidance, {});
}
std::optional<PlanningRequest> VehicleNode::poll_planning_request() {
  return impl_->agent->poll_planning_request();
}
std::optional<MissionEvent> VehicleNode::poll_event() {
  if (auto event = impl_->agent->poll_event()) return event;
  return impl_->events.pop();
}
std::optional<Fence> VehicleNode::poll_fence() { return impl_->fence.poll_changed(); }
std::optional<Instant> VehicleNode::poll_give_back() { return std::exchange(impl_->give_back, {}); }

Instant VehicleNode::next_timeout() const {
  return std::min({impl_->next_telemetry, impl_->self_report.next_due(), impl_->pass_on_at,
                   impl_->setup.next_timeout(), impl_->agent->next_timeout()});
}

Instant VehicleNode::quiet_until(Instant now) const {
  if (!impl_->started) return now;
  Instant next = std::min(next_timeout(), impl_->agent->quiet_until(now));
  for (const Impl::Told& of : impl_->told) next = std::min(next, of.next);
  return next;
}

const OnboardAgent& VehicleNode::agent() const { return *impl_->agent; }
Bar VehicleNode::bar() const { return impl_->bar; }
VehicleId VehicleNode::vehicle() const { return impl_->self; }
InstanceId VehicleNode::instance() const { return impl_->agent->telemetry().instance; }
Counters VehicleNode::counters() const { return impl_->counters(); }

}  // namespace skein::mission
