// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// What the ground station is told of the formation by its configuration.
[[nodiscard]] mission::FormationGroundConfig formation_ground(
    const configuration::FormationConfig& config, const std::vector<VehicleId>& vehicles);

/// The same of a formation of planes.
[[nodiscard]] mission::TrackGroundConfig track_ground(const configuration::FormationConfig& config,
                                                      const std::vector<VehicleSpec>& planes,
                                                      const std::vector<Hazard>& hazards);

/// Where the operator commands a formation: completes what was typed with the configuration, reads
/// shapes and tracks, and works off the script. Without I/O but for their files.
class FormationDesk {
 public:
  /// Fails where a shape's file or a line of the script cannot be read. The node must outlive it.
  [[nodiscard]] static Result<FormationDesk> open(const configuration::FormationConfig& config,
                                                  const std::vector<VehicleId>& vehicles,
                                                  mission::GroundNode& node);

  /// What was done, or would be, for the operator and as JSON (docs/console-socket.md, answer).
  struct Outcome {
    std::string text;
    std::string data;
  };
  /// Fails where the order cannot be given, with the reason.
  [[nodiscard]] Result<Outcome> answer(const Formation& input, Instant now);
  /// Where each vehicle is and how far from its place.
  [[nodiscard]] std::string places_table(Instant now) const;

  /// After the node's. What it has to say the node says.
  void on_timeout(Instant now);
  /// Another ground station has the command: whatever the team does by now, the script's next order
  /// is none for it.
  void leave_script() { next_line_ = script_.size(); }
  /// Lines of the script that are done, or left.
  [[nodiscard]] std::size_t script_line() const { return next_line_; }

 private:
  FormationDesk(const configuration::FormationConfig& config,
                const std::vector<VehicleId>& vehicles, mission::GroundNode& node);
  Result<void> load(const std::string& name, const std::string& file);
  Result<void> load_track(const std::string& name, const std::string& file);
  /// What an order names by its file, and is not known yet.
  Result<void> load_files(const Formation& input, bool whatever_its_name);
  [[nodiscard]] Result<formation::ShapeSpec> named_shape(const Formation& input) const;
  [[nodiscard]] Result<mission::FormationOrder> completed(const Formation& input) const;
  [[nodiscard]] Result<mission::TrackOrder> completed_track(const Formation& input) const;
  Result<Outcome> answer_planes(const Formation& input, Instant now);
  [[nodiscard]] std::string tracks_table(Instant now) const;
  [[nodiscard]] std::size_t heard() const;
  [[nodiscard]] bool in_place() const;
  [[nodiscard]] bool is_heard(VehicleId vehicle) const;
  void work_off_script(Instant now);
  void report(mission::EventBody body, Instant now);
  [[nodiscard]] const mission::FormationGround& ground() const { return node_->formation(); }

  configuration::FormationConfig config_;
  std::vector<VehicleId> vehicles_;
  std::map<std::string, formation::ShapeSpec> shapes_;
  std::map<std::string, formation::Track> tracks_;
  mission::GroundNode* node_;
  std::vector<Input> script_;
  std::size_t next_line_ = 0;
  bool given_ = false;  ///< an order of the script, that is not in place yet
  std::optional<Instant> wait_until_;
  std::optional<Instant> team_by_;
  Instant try_again_{};
  bool told_awaited_ = false;  ///< that vehicles are not heard yet
  bool ends_ = false;          ///< its orders are done, and planes are still on their track
  bool told_waits_ = false;    ///< why the script's next order does
  bool moved_ = false;         ///< vehicles, when last looked at
};

}  // namespace skein::groundstation
