// SPDX-License-Identifier: Apache-2.0
#include "skein/console/alarm_news.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

namespace event = mission::event;
using event::FleetNews;
using event::FormationNews;

/// What news of an autopilot mean for its vehicle.
enum class Weight : std::uint8_t {
  none,
  well,     ///< whatever was is over
  notice,   ///< told once
  warning,  ///< until it is well
  alarm     ///< the same, and somebody must act
};

Weight weight_of(AutopilotNews news) {
  using enum AutopilotNews;
  switch (news) {
    case flying:
    case ready:
    case disarmed:
    case given_back_landed:
      return Weight::well;
    case gone:
    case not_obeying:
    case not_climbed:
    case no_frames:
    case silent:
    case duplicate_node:
    case no_bus_traffic:
    case node_missing:
    case no_heartbeat:
    case not_signed:
    case still_piloted:
    case stays_in_hover:
    case landing_not_uploaded:
    case launch_broken_off:
      return Weight::alarm;
    case mode_changed:
    case armed_by_others:
    case not_armed:
    case not_given_back:
    case wrong_make:
    case wrong_airframe:
    case old_firmware:
    case parameter_wrong:
    case parameter_changed:
    case no_serial_port:
    case serial_port_elsewhere:
    case not_told:
    case no_position:
    case pre_arm:
    case fence_not_uploaded:
    case hovers_low:
      return Weight::warning;
    case rebooted:
    case looked_for:
    case other_system:
    case text:
    case command_refused:
    case no_go_around:
      return Weight::notice;
    case found:
    case taking_off:
    case landing:
    case firmware:
    case landing_uploaded:
    case going_around:
    case fence_uploaded:
    case count:
      break;
  }
  return Weight::none;
}

/// A task of a site as a number.
std::uint64_t number_of(const TaskId& task) {
  return (static_cast<std::uint64_t>(task.kind) << 8U) | task.index;
}

}  // namespace

/// Of one event.
struct AlarmNews::Reader {
  AlarmNews& news;
  const mission::MissionEvent& told;
  Instant now{};

  [[nodiscard]] VehicleId self() const { return told.vehicle; }
  [[nodiscard]] std::string words() const { return wording::news_of(told); }
  [[nodiscard]] std::string words_of_vehicle() const {
    return wording::text_of(told.vehicle) + ": " + words();
  }
  [[nodiscard]] Item item(bool grave = false) const {
    return {now, words_of_vehicle(), told.task, grave};
  }
  /// Of what goes on for longer than until its moment.
  [[nodiscard]] Item encounter(bool grave) const {
    return {now, wording::text_of(told.vehicle) + ": " + wording::lasting_news_of(told), told.task,
            grave, wording::closest_of(told)};
  }
  void clear(const Key& key) const {
    news.drop(key);
    news.clear_since_[self()] = told.time;
  }
  void tell() const {
    news.tell(self(), now, self() == kGroundStation ? words() : words_of_vehicle());
  }

  void operator()(const event::SeparationWarning& e) const {
    news.begin({Topic::separation, self(), e.other}, encounter(e.gives_way == VehicleId{}));
  }
  void operator()(const event::SeparationRestored& e) const {
    clear({Topic::separation, self(), e.other});
  }
  void operator()(const event::TrafficWarning& e) const {
    news.begin({.topic = Topic::traffic, .vehicle = self(), .detail = e.address},
               encounter(!e.gives_way));
  }
  void operator()(const event::TrafficClear& e) const {
    clear({.topic = Topic::traffic, .vehicle = self(), .detail = e.address});
  }
  void operator()(const event::RangeSpent& /*e*/) const {
    news.begin({Topic::range_spent, self()}, item(true));
  }
  void operator()(const event::TaskLost& e) const {
    news.begin({Topic::task_lost, e.why.vehicle, {}, told.task.site, number_of(told.task)},
               {now, to_string(told.task) + " is nobody's any more: " + words(), told.task});
  }
  void operator()(const event::TaskUnknown& e) const {
    news.begin({Topic::task_unknown, e.owner, {}, told.task.site, number_of(told.task)},
               {now, to_string(told.task) + " " + words(), told.task, true});
  }
  void operator()(const event::VehicleTrouble& e) const {
    switch (e.trouble) {
      case event::Trouble::id_in_use:
        return news.begin({Topic::id_in_use, self()}, item(true));
      case event::Trouble::orders_unknown:
        return news.begin({Topic::orders_unknown, self()}, item(true));
      case event::Trouble::landing_barred:
        return news.begin({Topic::landing_barred, self()}, item(true));
      case event::Trouble::left_fence:  // its state says it
        return;
      case event::Trouble::untimely:
      case event::Trouble::route_not_flown:
      case event::Trouble::turns_not_held:
      case event::Trouble::lands_by_itself:
      case event::Trouble::count:
        return tell();
    }
  }
  void operator()(const event::OrdersKnown& /*e*/) const {
    news.end(Topic::orders_unknown, self());
  }
  void operator()(const event::FleetWarning& e) const {
    if (e.news == FleetNews::restarted) {
      news.forget(e.vehicle);
      news.tell(e.vehicle, now, words());
    } else if (e.news == FleetNews::not_landed) {
      news.begin({Topic::not_landed, e.vehicle}, {now, words()});
    }
    // Silence, ids and strangers are the fleet's own to tell.
  }
  void operator()(const event::FormationWarning& e) const {
    switch (e.news) {
      case FormationNews::lost:
      case FormationNews::lost_on_its_way:
      case FormationNews::lost_on_track:
      case FormationNews::astray:
        for (const VehicleId one : e.vehicles) {
          news.begin({Topic::formation_lost, one}, {now, words(), {}, true});
        }
        return;
      case FormationNews::back:
        for (const VehicleId one : e.vehicles) news.end(Topic::formation_lost, one);
        return;
      case FormationNews::not_begun:
      case FormationNews::drift_corrected:
      case FormationNews::awaited:
      case FormationNews::off_place:
      case FormationNews::count:
        return tell();
    }
  }
  void operator()(const event::ChangeRefused& /*e*/) const {
    news.begin({Topic::change_refused, self()}, item());
  }
  void operator()(const event::Waiting& /*e*/) const {
    news.begin({Topic::change_waits, self()}, item());
  }
  void operator()(const event::ChangeTakenUp& /*e*/) const {
    news.end(Topic::change_refused, self());
    news.end(Topic::change_waits, self());
  }
  void operator()(const event::PlaceReached& /*e*/) const { news.end(Topic::change_waits, self()); }
  void operator()(const event::OrderWaits& /*e*/) const {
    news.begin({Topic::order_waits}, {now, words()});
  }
  void operator()(const event::ChangeBegun& /*e*/) const { news.drop({Topic::order_waits}); }
  void operator()(const event::ScriptDone& /*e*/) const { news.drop({Topic::order_waits}); }
  void operator()(const event::FlightWarning& e) const {
    const Weight weight = weight_of(e.notice.news);
    if (weight == Weight::well) return news.end(Topic::autopilot, self());
    if (weight == Weight::none) return;
    if (weight == Weight::notice) return tell();
    const Key key{Topic::autopilot, self()};
    const auto known = news.items_.find(key);
    const bool graver = known != news.items_.end() && known->second.grave;
    news.begin(key, item(weight == Weight::alarm || graver));
  }
  void operator()(const event::SetupDiffers& e) const {
    news.begin({Topic::setup_differs, self(), e.node}, {now, words()});
  }
  void operator()(const event::SetupAgrees& e) const {
    news.drop({Topic::setup_differs, self(), e.node});
  }
  void operator()(const event::CommandHanded& e) const {
    const Key elsewhere{Topic::command_elsewhere};
    const bool was_taken = news.items_.contains(elsewhere) || news.commanded_here_;
    news.commanded_here_ = e.here;
    news.drop(elsewhere);
    if (e.here || !was_taken) return tell();  // who only ever watched has lost nothing
    news.begin(elsewhere, {now, words(), {}, true});
  }
  void operator()(const event::RoutesCalledOff& /*e*/) const { tell(); }
  void operator()(const event::ReturnAlone& e) const { news.tell(e.vehicle, now, words()); }
  template <class Other>
  void operator()(const Other& /*of no concern*/) const {}
};

void AlarmNews::on_command(bool nobody, Instant now) {
  const Key key{Topic::nobody_commands};
  if (!nobody) return drop(key);
  if (items_.contains(key)) return;
  drop({Topic::command_elsewhere});
  begin(key, {now, "nobody is in command: no ground station that has it is heard", {}, true});
}

void AlarmNews::on_receivers(const std::string& trouble, Instant now) {
  const Key key{Topic::traffic_unseen};
  if (trouble.empty()) return drop(key);
  begin(key, {now, "aircraft are not seen: " + trouble, {}, false});
}

void AlarmNews::on_event(const mission::MissionEvent& event, Instant now) {
  std::visit(Reader{*this, event, now}, event.body);
  for (auto one = items_.lower_bound({Topic::told}); one != items_.end();) {
    one = now >= one->second.since + kTold ? items_.erase(one) : std::next(one);
  }
}

Instant AlarmNews::clear_since(VehicleId vehicle) const {
  const auto known = clear_since_.find(vehicle);
  return known == clear_since_.end() ? Instant::min() : known->second;
}

void AlarmNews::begin(const Key& key, Item item) {
  const auto known = items_.find(key);
  if (known != items_.end()) item.since = known->second.since;
  items_.insert_or_assign(key, std::move(item));
  if (items_.size() <= kMax) return;
  items_.erase(std::ranges::min_element(
      items_, [](const auto& a, const auto& b) { return a.second.since < b.second.since; }));
}

void AlarmNews::end(Topic topic, VehicleId vehicle) { items_.erase({topic, vehicle}); }

void AlarmNews::tell(VehicleId vehicle, Instant now, std::string what) {
  begin({.topic = Topic::told, .vehicle = vehicle, .detail = ++told_}, {now, std::move(what)});
}

/// It has started anew: what it said before is not so any more.
void AlarmNews::forget(VehicleId vehicle) {
  std::erase_if(items_, [&](const auto& one) {
    const Topic topic = one.first.topic;
    const bool is_its_own = topic != Topic::task_lost && topic != Topic::task_unknown &&
                            topic != Topic::told && topic != Topic::formation_lost;
    return is_its_own && one.first.vehicle == vehicle;
  });
}

}  // namespace skein::console
