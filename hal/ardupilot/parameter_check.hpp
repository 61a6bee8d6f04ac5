// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/ardupilot/airframe.hpp"
#include "skein/ardupilot/autopilot_facts.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/remote_id.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::ardupilot {

/// The value of a parameter by its first name; nothing where it has not been told.
using Told = std::function<std::optional<double>(std::string_view name)>;

/// A parameter that an autopilot is asked for, and what is made of its answer.
struct ParameterQuestion {
  std::string_view name;
  std::string_view other_name;  ///< of other releases; may be empty
  /// What is wrong with a value, told by one of the names, as a sentence with its remedy.
  std::function<std::optional<std::string>(std::string_view name, float value, const Told& told)>
      judge;
  /// What is wrong where none is told. Empty: nothing; its firmware has no such parameter then.
  std::string untold;
  bool of_own_id = false;  ///< what is good is the autopilot's own system id
};
/// What the safety of a flight rests on, and the autopilot's own fence where there is one.
[[nodiscard]] std::vector<ParameterQuestion> safety_questions(const VehicleSpec& vehicle,
                                                              std::uint8_t system_id,
                                                              const Fence& fence);
/// What an autopilot must be set to, to keep the outline of a fence that is ordered in flight. Its
/// greatest height is the crew's (FENCE_ALT_MAX).
[[nodiscard]] std::vector<ParameterQuestion> ordered_fence_questions();
/// Where a Remote ID is required: the autopilot itself does not arm without.
[[nodiscard]] std::vector<ParameterQuestion> remote_id_questions(const RemoteId& id);
/// Of what limits the vehicle (flight_limits.hpp).
[[nodiscard]] std::vector<ParameterQuestion> limit_questions(const VehicleSpec& vehicle);

/// Asks an autopilot for parameters, and judges its answers. Whoever may fly waits until all are
/// good; what is wrong is asked for again, so that setting it is enough.
class ParameterCheck {
 public:
  explicit ParameterCheck(std::vector<ParameterQuestion> questions);

  /// Asks for these, too, but for those that it asks for already.
  void add(std::vector<ParameterQuestion> questions);
  /// Nothing is known any more: the autopilot is another, or has started anew.
  void begin();
  /// Names to be asked for now.
  [[nodiscard]] std::vector<std::string_view> due(Instant now);
  /// What a PARAM_VALUE says; any name and value.
  void on_value(std::string_view name, float value);
  [[nodiscard]] bool good() const;
  /// What is wrong and was not told yet, or not for long.
  [[nodiscard]] std::optional<std::string> poll_finding(Instant now);
  /// All that is wrong.
  [[nodiscard]] std::vector<std::string> findings() const;
  /// Each of them, as far as it is known.
  [[nodiscard]] std::vector<TestedParameter> tested() const;
  [[nodiscard]] bool all_told() const;
  /// What is not told has been asked for so often that it is not waited for.
  [[nodiscard]] bool all_tried() const;

 private:
  struct Entry {
    ParameterQuestion question;
    std::string_view name = question.name;  ///< by which it has answered; at first the first
    std::optional<float> value = {};
    std::optional<std::string> wrong = {};  ///< with that value
    int asked = 0;                          ///< since the last answer
    std::optional<Instant> asked_at = {};
    std::optional<Instant> told_at = {};
  };
  /// There is nothing to ask any more.
  [[nodiscard]] static bool is_settled(const Entry& entry);
  /// By its first name.
  [[nodiscard]] std::optional<double> told(std::string_view name) const;
  /// Null where nothing is wrong, or not known to be.
  [[nodiscard]] static const std::string* finding(const Entry& entry);

  std::vector<Entry> entries_;
};

}  // namespace skein::ardupilot
