// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/mission/formation_ground.hpp"

namespace skein::groundstation {

/// Where the operator commands a formation: completes what was typed with the configuration, reads
/// the shapes, and works off the script. Without I/O but for the files of shapes.
class FormationDesk {
 public:
  /// Fails where a shape's file or a line of the script cannot be read.
  [[nodiscard]] static Result<FormationDesk> open(const configuration::FormationConfig& config,
                                                  const std::vector<VehicleId>& vehicles,
                                                  Instant now);

  /// What was done, or would be, for the operator and as JSON (docs/console-socket.md, answer).
  struct Outcome {
    std::string text;
    std::string data;
  };
  /// Fails where the order cannot be given, with the reason.
  [[nodiscard]] Result<Outcome> answer(const Formation& input, Instant now);
  /// Where each vehicle is and how far from its place.
  [[nodiscard]] std::string places_table(Instant now) const;

  void on_message(const mission::Message& message, VehicleId sender, Instant now) {
    ground_.on_message(message, sender, now);
  }
  void on_timeout(Instant now);
  [[nodiscard]] std::optional<mission::Message> poll_message() { return ground_.poll_message(); }
  [[nodiscard]] std::optional<mission::MissionEvent> poll_event();
  /// Lines of the script that are done.
  [[nodiscard]] std::size_t script_line() const { return next_line_; }

 private:
  FormationDesk(const configuration::FormationConfig& config,
                const std::vector<VehicleId>& vehicles, Instant now);
  Result<void> load(const std::string& name, const std::string& file);
  [[nodiscard]] Result<mission::FormationOrder> completed(const Formation& input) const;
  void work_off_script(Instant now);
  void take_events();
  void report(mission::EventBody body, Instant now);

  configuration::FormationConfig config_;
  std::vector<VehicleId> vehicles_;
  std::map<std::string, formation::ShapeSpec> shapes_;
  mission::FormationGround ground_;
  std::vector<Input> script_;
  std::size_t next_line_ = 0;
  bool given_ = false;  ///< an order of the script, that is not in place yet
  std::optional<Instant> wait_until_;
  std::optional<Instant> team_by_;
  Instant try_again_{};
  bool told_awaited_ = false;  ///< that vehicles are not heard yet
  bool told_waits_ = false;    ///< why the script's next order does
  std::deque<mission::MissionEvent> events_;
};

}  // namespace skein::groundstation
