// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/console/alarms.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/recording/log.hpp"

namespace skein::groundstation {

/// A recording as a picture that can be had of any moment: what the operator saw then, or, of a
/// whole run, what its nodes said. Copies of the picture on the way make a jump quick. Without a
/// clock: whoever has one asks for a time.
class Playback {
 public:
  /// At least so far apart are the copies; a long recording has kCopiesMax of them.
  static constexpr Duration kCopyEvery = std::chrono::seconds{10};
  static constexpr std::size_t kCopiesMax = 120;

  /// Reads everything once. `progress` is told how much of it is done, 0 to 1. Fails where there is
  /// nothing that can be read, or nothing that says where the mission's origin is.
  [[nodiscard]] static Result<Playback> open(const std::filesystem::path& path,
                                             const std::function<void(double)>& progress = {});

  [[nodiscard]] Instant begin() const { return begin_; }
  [[nodiscard]] Instant end() const { return end_; }
  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] const console::Picture& picture() const { return seen_.picture; }
  [[nodiscard]] const mission::Fleet& fleet() const { return seen_.fleet; }
  /// Nobody acknowledges them in a recording.
  [[nodiscard]] const console::Alarms& alarms() const { return seen_.alarms; }
  [[nodiscard]] const MissionOrigin& origin() const { return origin_; }
  /// All, as event_json() gives them, by time.
  struct Event {
    Instant time{};
    std::string json;
  };
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  /// How many of them there were by now().
  [[nodiscard]] std::size_t events_so_far() const;
  /// Of the program that recorded.
  [[nodiscard]] const std::string& version() const { return version_; }
  /// Parts that could not be read.
  [[nodiscard]] std::size_t damaged() const { return log_.damaged(); }

  /// The picture of that moment, clamped to what there is. Back and far ahead by the nearest copy.
  void go_to(Instant time);

 private:
  struct Seen {
    console::Picture picture;
    mission::Fleet fleet;
    console::Alarms alarms{};
  };
  struct Copy {
    Instant time{};
    Seen seen;
  };
  Playback(recording::Log log, MissionOrigin origin, Seen seen, std::string version);
  void read_all(const std::function<void(double)>& progress);
  void take(const recording::Entry& entry);
  void play_until(Instant time);
  void tell_time(Instant time);

  recording::Log log_;
  MissionOrigin origin_;
  Seen seen_;
  std::string version_;
  Instant begin_{};
  Instant end_{};
  Instant now_{};
  std::optional<recording::Entry> ahead_;  ///< read, and not yet seen
  std::vector<Copy> copies_;
  std::vector<Event> events_;
};

}  // namespace skein::groundstation
