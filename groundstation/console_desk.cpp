// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/console_desk.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "skein/process/event_text.hpp"
#include "skein/recording/published.hpp"

namespace skein::groundstation {
namespace {

console::PictureParams picture_params(const configuration::GroundConfig& config) {
  console::PictureParams params;
  params.expected = config.vehicles;
  params.hazards = config.hazards;
  return params;
}

std::string hello(const configuration::GroundConfig& config, const MissionOrigin& origin) {
  nlohmann::ordered_json hello{{"program", "skein-ground " + version()},
                               {"origin",
                                {{"latitude_deg", origin.origin().latitude_deg},
                                 {"longitude_deg", origin.origin().longitude_deg},
                                 {"height_m", origin.origin().height_m}}},
                               {"expected", nlohmann::ordered_json::array()},
                               {"replay", nullptr}};
  for (const VehicleId vehicle : config.vehicles) hello["expected"].push_back(vehicle.value);
  hello["shapes"] = {"line-abreast", "column", "echelon", "wedge", "pentagon"};
  for (const auto& shape : config.formation.shapes) hello["shapes"].push_back(shape.name);
  return hello.dump();
}

}  // namespace

std::string version() { return SKEIN_VERSION; }

ConsoleDesk::ConsoleDesk(const configuration::GroundConfig& config, const MissionOrigin& origin)
    : origin_{origin}, picture_{picture_params(config)} {}

Result<void> ConsoleDesk::serve(const configuration::GroundConfig& config,
                                std::function<void()> wake) {
  const configuration::ConsoleConfig& wanted = config.console;
  console::ServerConfig server;
  server.address = wanted.address;
  server.port = wanted.port;
  if (!wanted.passwords.empty()) {
    auto users = console::Users::load(wanted.passwords);
    if (!users) return users.error();
    server.users = std::move(*users);
  }
  server.certificate = wanted.certificate;
  server.key = wanted.key;
  server.tiles = wanted.tiles;
  for (const auto& overlay : wanted.overlays) {
    server.overlays.push_back({overlay.name, overlay.file});
  }
  server.hello = hello(config, origin_);
  auto opened = console::Server::open(std::move(server), std::move(wake));
  if (!opened) return opened.error();
  server_ = std::move(*opened);
  return {};
}

void ConsoleDesk::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  picture_.on_message(message, sender, now);
  if (!server_ || !server_->live_watched()) return;
  auto published = recording::published(message, sender);
  if (!published) return;
  const auto unix_time = std::chrono::system_clock::now().time_since_epoch();
  server_->live({std::move(published->topic), published->schema_name, published->schema,
                 static_cast<std::uint64_t>(
                     std::chrono::duration_cast<std::chrono::nanoseconds>(unix_time).count()),
                 std::move(published->bytes)});
}

void ConsoleDesk::on_event(const mission::MissionEvent& event) {
  picture_.on_event(event);
  const std::uint64_t seq = next_seq_++;
  if (server_) events_.push_back(console::event_json(event, process::text_of(event), seq));
}

void ConsoleDesk::on_timeout(const std::string& audit, Instant now) {
  if (!server_) return;
  if (!events_.empty()) server_->append(std::exchange(events_, {}));
  if (now < next_state_ || !server_->watched()) return;
  next_state_ = now + kStatePeriod;
  auto sections = console::sections_of(picture_, origin_, version(), now);
  sections[static_cast<std::size_t>(console::Section::audit)] = audit;
  server_->publish(to_seconds(now), std::move(sections));
}

std::optional<console::Server::Line> ConsoleDesk::next() {
  while (auto request = server_ ? server_->next() : std::nullopt) {
    if (auto* line = std::get_if<console::Server::Line>(&*request)) return std::move(*line);
    std::get<console::Server::Join>(*request).reply(console::series_of(picture_));
    next_state_ = Instant::min();
  }
  return std::nullopt;
}

std::string ConsoleDesk::section(console::Section section, Instant now) const {
  return console::section_of(section, picture_, origin_, version(), now);
}

}  // namespace skein::groundstation
