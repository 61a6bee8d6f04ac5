// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/console/alarms.hpp"
#include "skein/console/picture.hpp"
#include "skein/console/sections.hpp"
#include "skein/console/server.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/operator_keys.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/network/node.hpp"

namespace skein::groundstation {

/// For people, of the views `links`, `wind` and `traffic`; empty of others.
[[nodiscard]] std::string picture_text(View view, const console::Picture& picture,
                                       const mission::Fleet& fleet, Instant now);

/// Where the web console meets the ground station: keeps the picture, shows it ten times a second
/// to whoever watches, and passes the lines on that are given there. There is a picture also where
/// no console is served: the prompt reads it too.
class ConsoleDesk {
 public:
  static constexpr Duration kStatePeriod = std::chrono::milliseconds{100};

  ConsoleDesk(const configuration::GroundConfig& config, const MissionOrigin& origin);

  /// Serves the page; who logs in as an operator unlocks his key. `wake` is called on another
  /// thread when a line can be taken. Fails where it cannot be served; the picture is kept all the
  /// same.
  Result<void> serve(const configuration::GroundConfig& config, std::int64_t epoch_unix_ns,
                     OperatorKeys& keys, std::function<void()> wake);

  /// What an earlier process of this ground station heard or said: it is shown as it was then.
  void recall(const mission::Message& message, VehicleId sender, Instant at);
  void on_message(const mission::Message& message, VehicleId sender, Instant now);
  void on_event(const mission::MissionEvent& event, Instant now);
  /// What its operator may decide and take back now.
  void on_decisions(const mission::GroundAgent& agent, Instant now) {
    picture_.on_decisions(agent, now);
  }
  /// All aircraft that receivers hear now.
  void on_traffic(const std::map<std::uint32_t, mission::SeenAircraft>& all) {
    picture_.on_traffic(all);
  }
  /// What is shown that is not of the picture: sections, and what the alarms are told of.
  struct Beside {
    const std::string& audit;
    const std::string& areas;
    const std::string& command;
    bool nobody_commands = false;
    std::string receiver_trouble = {};  ///< why aircraft are not seen
    std::optional<console::EndedSearch> search = {};
  };
  void on_timeout(const mission::Fleet& fleet, const Beside& beside, Instant now);

  /// The newest of everything, and last `text`: the program is about to end.
  void end(const mission::Fleet& fleet, const Beside& beside, const std::string& text, Instant now);

  [[nodiscard]] const console::Alarms& alarms() const { return alarms_; }
  /// What came of `order` of that operator.
  Answer answer(const Acknowledge& order, const std::string& by, Instant now);

  /// Ends what that user has open.
  void expel(const std::string& user) {
    if (server_) server_->expel(user);
  }
  /// For /health and /metrics.
  void report(console::Server::MachineReport report) {
    if (server_) server_->report(std::move(report));
  }

  [[nodiscard]] std::optional<console::Server::Line> next();
  [[nodiscard]] std::string section(console::Section section, const mission::Fleet& fleet,
                                    Instant now) const;
  /// All of one vehicle.
  [[nodiscard]] Answer status_of(VehicleId vehicle, const mission::Fleet& fleet, Instant now) const;
  /// As picture_text().
  [[nodiscard]] std::string text(View view, const mission::Fleet& fleet, Instant now) const {
    return picture_text(view, picture_, fleet, now);
  }
  /// What the ground station's network counts of each vehicle.
  void on_receptions(const std::vector<network::Reception>& receptions);
  [[nodiscard]] const console::Picture& picture() const { return picture_; }
  /// Empty where none is served.
  [[nodiscard]] std::string url() const { return server_ ? server_->url() : ""; }
  /// What opens the page: for who may give orders on this machine.
  [[nodiscard]] std::string address_text() const;

 private:
  MissionOrigin origin_;
  console::Picture picture_;
  std::vector<configuration::ConsoleConfig::Video> videos_;
  console::Alarms alarms_;
  std::string token_;  ///< empty where there are passwords
  std::unique_ptr<console::Server> server_;
  std::vector<std::string> events_;  ///< to be shown
  std::uint64_t next_seq_ = 0;
  Instant next_state_{Instant::min()};
};

/// What the configuration says of it.
[[nodiscard]] console::PictureParams picture_params(const configuration::GroundConfig& config);

/// Where and what a console serves, without who may use it and its hello.
[[nodiscard]] console::ServerConfig server_config(const configuration::ConsoleConfig& config);

/// A recording that is shown in place of what happens now.
struct ShownRecording {
  std::string name;
  Instant begin{};
  Instant end{};
};
/// The hello message's fields that the server does not know itself (docs/console-socket.md).
[[nodiscard]] std::string hello_text(
    const MissionOrigin& origin, const std::vector<VehicleId>& expected,
    const std::vector<std::string>& shapes, const std::vector<std::string>& site_templates,
    std::optional<bool> sealed, std::optional<std::int64_t> epoch_unix_ns,
    const std::optional<ShownRecording>& recording,
    const std::vector<configuration::ConsoleConfig::Video>& videos = {});

/// The section that has what a view of the prompt shows; none for those that are not of the
/// picture.
[[nodiscard]] std::optional<console::Section> section_of(View view);

/// What that vehicle's checks find, in words and as the whole section.
[[nodiscard]] Answer preflight_answer(const mission::Fleet& fleet, VehicleId vehicle, Instant now);

}  // namespace skein::groundstation
