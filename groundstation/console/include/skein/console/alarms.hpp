// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/console/alarm_news.hpp"
#include "skein/console/order_answers.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"

/// What may not be overlooked: found in picture and fleet at the ground station, so that all who
/// watch, and whoever sees a recording, have the same.
namespace skein::console {

/// The worst first.
enum class AlarmLevel : std::uint8_t {
  alarm,    ///< act now
  warning,  ///< look at it
  notice,   ///< told once
  count
};
[[nodiscard]] std::string_view to_string(AlarmLevel level);

/// One row each in alarm_kinds.cpp, in this order; the worse first within a level.
enum class AlarmKind : std::uint8_t {
  nobody_heard,
  nobody_commands,
  separation_no_room,
  traffic_no_room,
  left_fence,
  vehicle_silent,
  decision_runs_out,
  decision_lapsed,
  no_answer,
  range_reserve,
  range_overdrawn,
  autopilot_trouble,
  vehicle_trouble,
  task_unknown,
  duplicate_id,
  setup_differs,
  formation_lost,
  command_elsewhere,
  separation,
  traffic,
  traffic_unseen,
  all_held,
  formation_waits,
  order_waits,
  task_lost,
  search_ended,
  proposal_waits,
  not_landed,
  vehicle_missing,
  stranger,
  revoked,
  autopilot_warning,
  vehicle_warning,
  vehicle_problem,
  told,
  count
};
[[nodiscard]] std::string_view to_string(AlarmKind kind);

/// Which alarm it is, whatever its figures: of that kind, about these.
struct AlarmKey {
  AlarmKind kind{};
  VehicleId vehicle{};
  VehicleId other{};
  SiteId site{};
  std::uint64_t detail = 0;  ///< a task, an aircraft's address, a proposal
  auto operator<=>(const AlarmKey&) const = default;
};
/// "vehicle_silent-3"
[[nodiscard]] std::string text_of(const AlarmKey& key);

struct Acknowledgement {
  std::string by;
  Instant at{};
};

struct Alarm {
  AlarmKey key;
  /// One its own: what comes back, or has become worse, has another one.
  std::uint32_t number = 0;
  AlarmLevel level{};
  Instant since{};
  std::string what;                ///< a sentence, with vehicle and site
  std::string remedy;              ///< what to do
  std::optional<Instant> closest;  ///< of two that come too near to each other: when that is
  std::uint32_t edition = 0;
  std::uint32_t times = 1;  ///< that it came, since it was acknowledged last
  std::optional<Instant> gone_since;
  std::optional<Instant> over;  ///< it is not so any more, and nobody has acknowledged it
  std::optional<Acknowledgement> acknowledged;
};

/// A search that some or all of those who flew it do not fly to its end.
struct EndedSearch {
  Instant begun{};  ///< tells it from others
  Instant since{};
  std::string what;           ///< a sentence
  std::uint32_t edition = 0;  ///< greater: more of it has ended
  bool is_wanted = false;     ///< the operator has called it off
};

struct Found;

struct AlarmCounts {
  std::size_t alarms = 0;
  std::size_t warnings = 0;
  std::size_t notices = 0;
  std::size_t unacknowledged = 0;
};

/// The standing list. An alarm stays until its condition is over; acknowledged, it is silent and
/// stays; one that ended and was not acknowledged stays as over until it is. Pure and copyable, as
/// Picture: what is made of a recording is the same each time. `now` never decreases.
class Alarms {
 public:
  /// Looked at at whole multiples of it, so that it does not matter when it is asked.
  static constexpr Duration kPeriod = std::chrono::milliseconds{100};
  static constexpr std::size_t kOverMax = 200;  ///< of which the oldest give way

  /// A message of the mission network, or one that the ground station sent (sender 0).
  void on_message(const mission::Message& message, VehicleId sender, Instant now);
  /// An event, once, as it was heard.
  void on_event(const mission::MissionEvent& event, Instant now);
  /// Of several ground stations: whether none that has the command is heard. No recording tells.
  void on_command(bool nobody, Instant now) { news_.on_command(nobody, now); }
  /// What keeps this ground station's receivers from telling of aircraft; empty where nothing does.
  void on_receivers(const std::string& trouble, Instant now) { news_.on_receivers(trouble, now); }
  /// What has become of the search of an area; none: nothing that it should not. No recording
  /// tells.
  void on_search(std::optional<EndedSearch> search) { search_ = std::move(search); }
  /// What an earlier process of this ground station was told.
  void recall(const mission::MissionEvent& event, Instant at);
  /// Before what is heard at `now` is taken.
  void on_timeout(const Picture& picture, const mission::Fleet& fleet, Instant now);

  /// Silences those numbers; none given: all. What is told once, and that a search has ended, is
  /// gone then. Fails where none of them is there, or waits for it.
  [[nodiscard]] Result<std::vector<Alarm>> acknowledge(const std::vector<std::uint32_t>& numbers,
                                                       const std::string& by, Instant now);

  /// The worst first of those that are not acknowledged; then those that are, then what is over.
  [[nodiscard]] std::vector<const Alarm*> list() const;
  /// Of what stands, and is not over.
  [[nodiscard]] AlarmCounts counts() const;
  [[nodiscard]] const OrderAnswers& orders() const { return orders_; }

 private:
  void look(const Picture& picture, const mission::Fleet& fleet, Instant now);
  void take(Found found);

  AlarmNews news_;
  OrderAnswers orders_;
  std::optional<EndedSearch> search_;
  std::optional<EndedSearch> read_search_;  ///< as it was when it was acknowledged
  std::map<AlarmKey, Alarm> standing_;
  std::map<AlarmKey, Alarm> over_;
  std::uint32_t last_number_ = 0;
  std::optional<Instant> begun_;
  std::optional<Instant> looked_at_;
};

/// The section `alarms` of docs/console-socket.md.
[[nodiscard]] std::string alarms_json(const Alarms& alarms);
/// At the prompt.
[[nodiscard]] std::string alarms_text(const Alarms& alarms, Instant now);

}  // namespace skein::console
