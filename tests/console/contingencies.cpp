// SPDX-License-Identifier: Apache-2.0
//
// console_contingencies VEHICLES: serves the console with so many vehicles, to which ten things
// happen in one moment, through the same picture, alarms and server as the ground station's. They
// obey orders a moment later, as vehicles do. Prints the address; at a line of its input everything
// happens, and whatever the operator orders is printed as it comes. Goes on until its input ends.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "skein/console/alarms.hpp"
#include "skein/console/picture.hpp"
#include "skein/console/sections.hpp"
#include "skein/console/server.hpp"

namespace {

using namespace skein;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
namespace event = mission::event;
using mission::ActivityDetail;
using mission::CommandKind;

constexpr auto kPeriod = std::chrono::milliseconds{20};
constexpr int kTelemetryEvery = 10;  // periods; each vehicle at another one
constexpr int kPublishEvery = 5;
constexpr double kObeysAfter_s = 0.3;

CommandKind command_named(const std::string& name) {
  for (int i = 0; i < static_cast<int>(CommandKind::count); ++i) {
    if (to_string(static_cast<CommandKind>(i)) == name) return static_cast<CommandKind>(i);
  }
  return CommandKind::hold;
}

/// The fleet, its troubles, and the ground station's side of it.
class Team {
 public:
  explicit Team(std::uint16_t vehicles) {
    for (std::uint16_t i = 1; i <= vehicles; ++i) {
      params_.expected.push_back({i});
      details_[{i}] = ActivityDetail::none;
    }
    picture_.emplace(params_);
    fleet_.emplace(mission::FleetParams{.expected = params_.expected});
  }

  [[nodiscard]] std::string hello() const {
    Json said{{"program", "contingencies 1.0"},
              {"origin", {{"latitude_deg", 47.0}, {"longitude_deg", 8.0}, {"height_m", 500.0}}},
              {"shapes", Json::array()},
              {"replay", nullptr},
              {"expected", Json::array()}};
    for (const VehicleId id : params_.expected) said["expected"].push_back(id.value);
    return said.dump();
  }

  void step(long period, double now_s) {
    now_ = at_seconds(now_s);
    for (auto one = due_.begin(); one != due_.end() && one->first <= now_s; one = due_.erase(one)) {
      one->second();
    }
    for (const auto& [id, detail] : details_) {
      if ((period + id.value) % kTelemetryEvery != 0 || silent_.contains(id)) continue;
      hear(telemetry(id, id.value), id);
      if (id == twin_) hear(telemetry(id, 999), id);
    }
    fleet_->on_timeout(now_);
    while (const auto news = fleet_->poll_news()) continue;
    alarms_.on_timeout(*picture_, *fleet_, now_);
  }

  /// All of it in one moment.
  void befall() {
    silent_.insert({3});
    details_[{7}] = ActivityDetail::range_reserve;
    tell({7}, event::RangeSpent{900.0, true, 800.0, false});
    details_[{11}] = ActivityDetail::left_fence;
    tell({14}, event::SeparationWarning{{15}, 12.0, 3.0, std::chrono::seconds{9}, {}});
    tell({18}, event::TrafficWarning{0x4b1a2c, 150.0, 20.0, std::chrono::seconds{15}, false});
    AutopilotNotice notice;
    notice.news = AutopilotNews::not_obeying;
    tell({22}, event::FlightWarning{notice});
    tell({26}, event::VehicleTrouble{event::Trouble::orders_unknown});
    twin_ = {30};
    ask({1}, {33}, 1.0);  // runs out, and is asked again
    due_.emplace(seconds() + 1.5, [this] { ask({1}, {33}, 120.0); });
    tell({40}, event::TaskUnknown{{41}}, {{2}, TaskKind::deliver, 0});
  }

  void obey(const Json& order) {
    const std::string kind = order["kind"];
    if (kind == "command") command(order);
    if (kind == "decision") decide(order);
  }

  [[nodiscard]] std::string acknowledge(const Json& order) {
    const auto done = alarms_.acknowledge(order["alarms"], "operator", now_);
    if (!done) return "";
    std::string keys;
    for (const auto& alarm : *done) keys += " " + text_of(alarm.key);
    return keys;
  }

  [[nodiscard]] console::Sections sections(const MissionOrigin& origin) const {
    auto all = console::sections_of(*picture_, *fleet_, origin, "1.0", now_);
    all[static_cast<std::size_t>(console::Section::audit)] = "[]";
    all[static_cast<std::size_t>(console::Section::alarms)] = console::alarms_json(alarms_);
    return all;
  }
  [[nodiscard]] std::string series() const { return console::series_of(*picture_); }

 private:
  [[nodiscard]] double seconds() const { return to_seconds(now_); }

  [[nodiscard]] mission::Telemetry telemetry(VehicleId id, std::uint64_t instance) const {
    mission::Telemetry t;
    t.vehicle = id;
    t.instance = {instance};
    t.state.time = now_;
    const double angle = 0.125 * seconds() + id.value;
    t.state.x_m = 500.0 * (id.value % 8) + 200.0 * std::cos(angle);
    t.state.y_m = 500.0 * (id.value / 8) + 200.0 * std::sin(angle);
    t.state.z_m = 100.0;
    t.state.heading_rad = t.state.course_rad = angle + std::numbers::pi / 2.0;
    t.state.groundspeed_mps = t.state.airspeed_mps = 25.0;
    t.range_left_m = 9000.0;
    t.loads = 1;
    t.detail = details_.at(id);
    t.activity = t.detail == ActivityDetail::none ? mission::Activity::searching
                                                  : mission::Activity::holding;
    return t;
  }

  void hear(const mission::Message& message, VehicleId sender) {
    fleet_->on_message(message, now_);
    picture_->on_message(message, sender, now_);
    alarms_.on_message(message, sender, now_);
  }
  void tell(VehicleId who, mission::EventBody body, const TaskId& task = {},
            const coalition::Round& round = {}) {
    const mission::MissionEvent event{who, now_, round, task, std::move(body)};
    picture_->on_event(event);
    alarms_.on_event(event, now_);
  }

  void ask(SiteId site, VehicleId vehicle, double for_s) {
    mission::AuthorisationRequest request;
    request.round = {{vehicle, {77}, 1}, ++round_};
    request.site = site;
    const Instant at = now_ + from_seconds(for_s + 5.0);
    request.deliveries = {{{{site, TaskKind::deliver, 0}, vehicle, at}, 0.0}};
    request.decide_by = now_ + from_seconds(for_s);
    hear(request, vehicle);
  }

  void command(const Json& order) {
    mission::Command said;
    said.vehicle = {order["vehicle"].get<std::uint16_t>()};
    said.kind = command_named(order["command"]);
    mission::set_number(said, ++number_);
    hear(said, kGroundStation);
    for (const auto& [id, detail] : details_) {
      const bool asked = said.vehicle == kGroundStation || said.vehicle == id;
      if (!asked || silent_.contains(id)) continue;
      due_.emplace(seconds() + kObeysAfter_s, [this, id = id, kind = said.kind] {
        tell(id, event::Commanded{kind});
        details_[id] = kind == CommandKind::hold     ? ActivityDetail::ordered
                       : kind == CommandKind::resume ? ActivityDetail::none
                                                     : ActivityDetail::returning;
        end_of(id);
      });
    }
  }

  /// What the operator's order mends.
  void end_of(VehicleId id) {
    if (id == VehicleId{14}) tell(id, event::SeparationRestored{{15}});
    if (id == VehicleId{18}) tell(id, event::TrafficClear{0x4b1a2c});
    if (id == VehicleId{26}) tell(id, event::OrdersKnown{kGroundStation});
  }

  void decide(const Json& order) {
    const SiteId site{order["site"].get<std::uint16_t>()};
    for (const auto& one : picture_->authorisations()) {
      if (one.request.site != site || one.request.round.number != order["round"]) continue;
      mission::Authorisation decision{
          one.request.round, site, order["grant"].get<bool>(), "operator", now_, {}, {}, {}};
      decision.deliveries = one.request.deliveries;
      decision.until = one.request.deliveries.front().assignment.time;
      hear(decision, kGroundStation);
      const auto& assignment = decision.deliveries.front().assignment;
      due_.emplace(seconds() + kObeysAfter_s,
                   [this, who = assignment.vehicle, task = assignment.task, of = decision.round] {
                     tell(who, event::Authorised{"operator"}, task, of);
                   });
      return;
    }
  }

  console::PictureParams params_;
  std::optional<console::Picture> picture_;
  std::optional<mission::Fleet> fleet_;
  console::Alarms alarms_;
  std::map<VehicleId, ActivityDetail> details_;
  std::set<VehicleId> silent_;
  VehicleId twin_{};
  std::multimap<double, std::function<void()>> due_;
  Instant now_{};
  std::uint32_t round_ = 0;
  std::uint64_t number_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int wanted = argc > 1 ? std::atoi(argv[1]) : 50;
  if (wanted < 41 || wanted > 500) {
    std::fprintf(stderr, "console_contingencies VEHICLES: 41 to 500\n");
    return 2;
  }
  Team team{static_cast<std::uint16_t>(wanted)};
  const auto origin = MissionOrigin::make({47.0, 8.0, 500.0});
  console::ServerConfig config;
  config.port = 0;
  config.hello = team.hello();
  auto server = console::Server::open(std::move(config), [] {});
  if (!server) {
    std::fprintf(stderr, "%s\n", server.error().message.c_str());
    return 3;
  }
  std::printf("%s\n", (*server)->url().c_str());
  std::fflush(stdout);

  std::atomic<bool> ended{false};
  std::atomic<bool> befalls{false};
  std::thread input{[&] {
    for (int c; (c = std::getchar()) != EOF;) befalls = befalls || c == '\n';
    ended = true;
  }};
  const auto begun = Clock::now();
  for (long period = 0; !ended; ++period) {
    const double now_s = std::chrono::duration<double>(Clock::now() - begun).count();
    team.step(period, now_s);
    if (befalls.exchange(false)) {
      team.befall();
      std::printf("%.3f befallen\n", now_s);
    }
    while (const auto request = (*server)->next()) {
      if (const auto* join = std::get_if<console::Server::Join>(&*request)) {
        join->reply(team.series());
        continue;
      }
      const auto& line = std::get<console::Server::Line>(*request);
      const Json order = Json::parse(line.order, nullptr, false);
      if (!order.is_object()) {
        line.reply(false, "orders only\n", "");
        continue;
      }
      std::string what = order.dump();
      if (order["kind"] == "acknowledge") what = "acknowledged" + team.acknowledge(order);
      team.obey(order);
      std::printf("%.3f %s\n", now_s, what.c_str());
      line.reply(true, "done\n", "");
    }
    std::fflush(stdout);
    if (period % kPublishEvery == 0) (*server)->publish(now_s, team.sections(*origin));
    std::this_thread::sleep_until(begun + (period + 1) * kPeriod);
  }
  input.join();
  return 0;
}
