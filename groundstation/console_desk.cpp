// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/console_desk.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "skein/codec/json_text.hpp"
#include "skein/console/team_preflight.hpp"
#include "skein/console/team_state.hpp"
#include "skein/console/team_traffic.hpp"
#include "skein/groundstation/logins.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/groundstation/vehicle_text.hpp"
#include "skein/process/token.hpp"
#include "skein/recording/published.hpp"
#include "skein/version/version.hpp"

namespace skein::groundstation {
console::PictureParams picture_params(const configuration::GroundConfig& config) {
  console::PictureParams params;
  params.expected = config.vehicles;
  params.hazards = config.hazards;
  params.fence = config.fence;
  params.place_tolerance_m = config.formation.place_tolerance_m;
  return params;
}

console::ServerConfig server_config(const configuration::ConsoleConfig& config) {
  console::ServerConfig server;
  server.address = config.address;
  server.port = config.port;
  server.certificate = config.certificate;
  server.key = config.key;
  server.tiles = config.tiles;
  for (const auto& overlay : config.overlays) {
    server.overlays.push_back({overlay.name, overlay.file});
  }
  for (const auto& group : config.groups) {
    console::VehicleGroup& shown =
        server.groups.emplace_back(console::VehicleGroup{group.name, {}});
    for (const VehicleId vehicle : group.vehicles) shown.vehicles.push_back(vehicle.value);
  }
  return server;
}

std::string hello_text(const MissionOrigin& origin, const std::vector<VehicleId>& expected,
                       const std::vector<std::string>& shapes,
                       const std::vector<std::string>& site_templates, std::optional<bool> sealed,
                       std::optional<std::int64_t> epoch_unix_ns,
                       const std::optional<ShownRecording>& recording,
                       const std::vector<configuration::ConsoleConfig::Video>& videos) {
  const Wgs84& place = origin.origin();
  codec::Json hello{
      {"program", "skein-ground " + version()},
      {"origin",
       {{"latitude_deg", place.latitude_deg},
        {"longitude_deg", place.longitude_deg},
        {"height_m", place.height_m}}},
      {"expected", codec::Json::array()},
      {"shapes", shapes},
      {"site_templates", site_templates},
      {"limits", codec::parse_own_json(limits_json())},
      {"sealed", sealed ? codec::Json(*sealed) : codec::Json(nullptr)},
      {"epoch_unix_s", epoch_unix_ns ? codec::Json(static_cast<double>(*epoch_unix_ns) * 1e-9)
                                     : codec::Json(nullptr)},
      {"videos", codec::Json::array()},
      {"replay", nullptr}};
  for (const auto& video : videos) {
    hello["videos"].push_back({{"vehicle", video.vehicle.value}, {"url", video.url}});
  }
  for (const VehicleId vehicle : expected) hello["expected"].push_back(vehicle.value);
  if (recording) {
    // In steps of the page's scrubber.
    hello["replay"] = {{"name", recording->name},
                       {"from_s", std::floor(10.0 * to_seconds(recording->begin)) / 10.0},
                       {"to_s", std::ceil(10.0 * to_seconds(recording->end)) / 10.0}};
  }
  return codec::json_text(hello);
}

std::optional<console::Section> section_of(View view) {
  using console::Section;
  switch (view) {
    case View::status:
      return Section::vehicles;
    case View::sites:
      return Section::sites;
    case View::pending:
      return Section::authorisations;
    case View::places:
      return Section::formation;
    case View::coalitions:
      return Section::coalitions;
    case View::hazards:
      return Section::hazards;
    case View::proposals:
      return Section::proposals;
    case View::preflight:
      return Section::preflight;
    case View::fence:
      return Section::fence;
    case View::links:
      return Section::links;
    case View::wind:
      return Section::wind;
    case View::traffic:
      return Section::traffic;
    case View::alarms:
      return Section::alarms;
    case View::help:
    case View::audit:
    case View::routes:
    case View::search:
    case View::command:
    case View::console:
      break;
  }
  return std::nullopt;
}

Answer preflight_answer(const mission::Fleet& fleet, VehicleId vehicle, Instant now) {
  const auto team = console::team_preflight(fleet, now);
  auto text = console::preflight_text(team, vehicle, now);
  if (!text) return {false, fmt::format("vehicle {} is not of this fleet\n", vehicle.value)};
  return {true, *std::move(text), console::preflight_json(team)};
}

namespace {

/// The same at every start where there is a folder to keep it in: a page goes on with it.
Result<std::string> token_of(const std::filesystem::path& recording_folder, const char* file) {
  if (recording_folder.empty()) return process::make_token();
  return process::read_or_make_token(recording_folder / file);
}

}  // namespace

std::string ConsoleDesk::address_text() const {
  if (!server_) return "there is no console\n";
  return token_.empty() ? server_->url() + " asks for name and password\n"
                        : fmt::format("{}#{}\n", server_->url(), token_);
}

ConsoleDesk::ConsoleDesk(const configuration::GroundConfig& config, const MissionOrigin& origin)
    : origin_{origin}, picture_{picture_params(config)}, videos_{config.console.videos} {}

Result<void> ConsoleDesk::serve(const configuration::GroundConfig& config,
                                std::int64_t epoch_unix_ns, OperatorKeys& keys,
                                std::function<void()> wake) {
  console::ServerConfig server = server_config(config.console);
  if (!config.console.passwords.empty()) {
    auto logins = Logins::open(config.console.passwords, keys);
    if (!logins) return logins.error();
    server.log_in = [logins = std::make_shared<Logins>(*std::move(logins))](
                        const std::string& user, std::string_view password) {
      return logins->check(user, password, std::chrono::steady_clock::now());
    };
  } else {
    auto token = token_of(config.recording_folder, process::kConsoleTokenFile);
    if (!token) return token.error();
    server.token = token_ = *std::move(token);
    auto observers = token_of(config.recording_folder, process::kObserverTokenFile);
    if (!observers) return observers.error();
    server.observer_token = *std::move(observers);
  }
  std::vector<std::string> shapes = shape_names();
  for (const auto& shape : config.formation.shapes) shapes.push_back(shape.name);
  std::vector<std::string> templates;
  for (const auto& kind : config.site_templates) templates.push_back(kind.name);
  server.hello = hello_text(origin_, config.vehicles, shapes, templates,
                            !config.network.keys.empty(), epoch_unix_ns, {}, videos_);
  server.on_refused_login = [](const console::RefusedLogin& login) {
    spdlog::warn("console: login of '{}' from {} refused, {} in a row; the next of that address {}",
                 login.user, login.address, login.in_a_row,
                 login.wait.count() == 0 ? "at once" : fmt::format("in {} s", login.wait.count()));
  };
  server.on_logout = [&keys](const std::string& user) { keys.lock(user); };
  auto opened = console::Server::open(std::move(server), std::move(wake));
  if (!opened) return opened.error();
  server_ = std::move(*opened);
  return {};
}

void ConsoleDesk::recall(const mission::Message& message, VehicleId sender, Instant at) {
  picture_.on_message(message, sender, at);
  if (const auto* event = std::get_if<mission::MissionEvent>(&message)) {
    picture_.on_event(*event);
    alarms_.recall(*event, at);
  }
}

void ConsoleDesk::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  picture_.on_message(message, sender, now);
  alarms_.on_message(message, sender, now);
  if (!server_ || !server_->live_watched()) return;
  auto published = recording::published(message, sender);
  if (!published) return;
  const auto unix_time = std::chrono::system_clock::now().time_since_epoch();
  server_->live({std::move(published->topic), published->schema_name, published->schema,
                 static_cast<std::uint64_t>(
                     std::chrono::duration_cast<std::chrono::nanoseconds>(unix_time).count()),
                 std::move(published->bytes)});
}

void ConsoleDesk::on_event(const mission::MissionEvent& event, Instant now) {
  picture_.on_event(event);
  alarms_.on_event(event, now);
  const std::uint64_t seq = next_seq_++;
  if (server_) events_.push_back(console::event_json(event, seq));
}

void ConsoleDesk::on_timeout(const mission::Fleet& fleet, const Beside& beside, Instant now) {
  alarms_.on_command(beside.nobody_commands, now);
  alarms_.on_receivers(beside.receiver_trouble, now);
  alarms_.on_search(beside.search);
  alarms_.on_timeout(picture_, fleet, now);
  if (!server_) return;
  if (!events_.empty()) server_->append(std::exchange(events_, {}));
  if (now < next_state_ || !server_->watched()) return;
  next_state_ = now + kStatePeriod;
  auto sections = console::sections_of(picture_, fleet, origin_, version(), now);
  const auto set = [&sections](console::Section section, const std::string& json) {
    sections[static_cast<std::size_t>(section)] = json;
  };
  set(console::Section::audit, beside.audit);
  set(console::Section::command, beside.command);
  set(console::Section::team,
      console::team_json(console::team_state(fleet, {beside.nobody_commands}, now)));
  set(console::Section::areas, beside.areas);
  set(console::Section::alarms, console::alarms_json(alarms_));
  server_->publish(to_seconds(now), std::move(sections));
}

void ConsoleDesk::end(const mission::Fleet& fleet, const Beside& beside, const std::string& text,
                      Instant now) {
  if (!server_) return;
  next_state_ = Instant::min();
  on_timeout(fleet, beside, now);
  server_->end(to_seconds(now), text);
}

Answer ConsoleDesk::answer(const Acknowledge& order, const std::string& by, Instant now) {
  const auto done = alarms_.acknowledge(order.numbers, by, now);
  if (!done) return {false, done.error().message + "\n"};
  next_state_ = Instant::min();  // all who watch see it at once
  std::string text;
  for (const console::Alarm& alarm : *done) {
    text += fmt::format("acknowledged: {}\n", alarm.what);
  }
  return {true, text};
}

std::optional<console::Server::Line> ConsoleDesk::next() {
  while (auto request = server_ ? server_->next() : std::nullopt) {
    if (auto* line = std::get_if<console::Server::Line>(&*request)) return std::move(*line);
    std::get<console::Server::Join>(*request).reply(console::series_of(picture_));
    next_state_ = Instant::min();
  }
  return std::nullopt;
}

std::string picture_text(View view, const console::Picture& picture, const mission::Fleet& fleet,
                         Instant now) {
  if (view == View::links) {
    return console::links_text(console::team_links(fleet, picture.receptions(), now));
  }
  if (view == View::wind) {
    return console::wind_text(picture.wind().estimate(console::without_airspeed(fleet), now), now);
  }
  if (view == View::traffic) return console::traffic_text(picture, fleet, now);
  return "";
}

void ConsoleDesk::on_receptions(const std::vector<network::Reception>& receptions) {
  std::vector<console::GroundReception> own;
  own.reserve(receptions.size());
  for (const network::Reception& one : receptions) {
    own.push_back({one.sender, one.datagrams, one.lost_percent,
                   one.bytes / to_seconds(network::Node::kReceptionFor)});
  }
  picture_.on_receptions(std::move(own));
}

Answer ConsoleDesk::status_of(VehicleId vehicle, const mission::Fleet& fleet, Instant now) const {
  const auto video =
      std::ranges::find(videos_, vehicle, &configuration::ConsoleConfig::Video::vehicle);
  Answer answer = vehicle_answer(vehicle, picture_, fleet,
                                 video == videos_.end() ? std::string{} : video->url, now);
  if (answer.done) answer.data = section(console::Section::vehicles, fleet, now);
  return answer;
}

std::string ConsoleDesk::section(console::Section section, const mission::Fleet& fleet,
                                 Instant now) const {
  if (section == console::Section::alarms) return console::alarms_json(alarms_);
  return console::section_of(section, picture_, fleet, origin_, version(), now);
}

}  // namespace skein::groundstation
