// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/playback.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/console/sections.hpp"
#include "skein/groundstation/console_desk.hpp"
#include "skein/mission/may_say.hpp"

namespace skein::groundstation {
namespace {

struct Setting {
  Wgs84 origin;
  console::PictureParams picture;
  std::string version;
};

/// What the recorded processes were told: the ground station's words count before a vehicle's.
Result<Setting> setting_of(const std::vector<recording::Session>& sessions) {
  std::optional<Setting> setting;
  for (const recording::Session& session : sessions) {
    if (session.node == kGroundStation) {
      const auto config = configuration::parse_ground_config(session.configuration, "recording");
      if (!config) continue;
      return Setting{config->origin, picture_params(*config), session.version};
    }
    const auto config = configuration::parse_vehicle_config(session.configuration, "recording");
    if (!config) continue;
    if (!setting) setting = Setting{config->origin, {}, session.version};
    setting->picture.expected.push_back(session.node);
    setting->picture.hazards = config->hazards;
    setting->picture.place_tolerance_m = config->formation.place_tolerance_m;
  }
  if (setting) return *std::move(setting);
  return Error{
      "no process in the recording says where the mission's origin is: none has a configuration "
      "that this version reads"};
}

}  // namespace

Playback::Playback(recording::Log log, MissionOrigin origin, Seen seen, std::string version)
    : log_{std::move(log)},
      origin_{origin},
      seen_{std::move(seen)},
      version_{std::move(version)},
      begin_{log_.begin()},
      end_{log_.end()} {}

Result<Playback> Playback::open(const std::filesystem::path& path,
                                const std::function<void(double)>& progress) {
  auto log = recording::Log::open(path);
  if (!log) return log.error();
  auto setting = setting_of(log->sessions());
  if (!setting) return Error{path.string() + ": " + setting.error().message};
  const auto origin = MissionOrigin::make(setting->origin);
  if (!origin) return Error{path.string() + ": " + origin.error().message};
  mission::Fleet fleet{{.expected = setting->picture.expected}};
  Playback playback{std::move(*log),
                    *origin,
                    {console::Picture{std::move(setting->picture)}, std::move(fleet)},
                    std::move(setting->version)};
  playback.read_all(progress);
  return playback;
}

void Playback::read_all(const std::function<void(double)>& progress) {
  const Duration every = std::max<Duration>(kCopyEvery, (end_ - begin_) / kCopiesMax);
  copies_.push_back({begin_, seen_});
  log_.seek(begin_);
  while (const auto entry = log_.next()) {
    if (entry->time >= copies_.back().time + every) {
      copies_.push_back({entry->time, seen_});
      if (progress) progress(to_seconds(entry->time - begin_) / to_seconds(end_ - begin_));
    }
    take(*entry);
    if (const auto* event = std::get_if<mission::MissionEvent>(&entry->content)) {
      events_.push_back({entry->time, console::event_json(*event, events_.size())});
    }
    end_ = std::max(end_, entry->time);  // of a file that was cut
  }
  seen_ = copies_.front().seen;
  log_.seek(begin_);
  now_ = begin_;
}

void Playback::take(const recording::Entry& entry) {
  tell_time(entry.time);
  if (const auto* message = std::get_if<mission::Message>(&entry.content)) {
    if (!mission::may_say(*message, entry.sender)) return;
    seen_.fleet.on_message(*message, entry.time);
    seen_.picture.on_message(*message, entry.sender, entry.time);
    seen_.alarms.on_message(*message, entry.sender, entry.time);
  } else if (const auto* event = std::get_if<mission::MissionEvent>(&entry.content)) {
    seen_.fleet.on_message(*event, entry.time);
    seen_.picture.on_event(*event);
    seen_.alarms.on_event(*event, entry.time);
  }
}

void Playback::go_to(Instant time) {
  time = std::clamp(time, begin_, end_);
  const auto after =
      std::upper_bound(copies_.begin(), copies_.end(), time,
                       [](Instant wanted, const Copy& copy) { return wanted < copy.time; });
  const Copy& nearest = *std::prev(after);
  if (time < now_ || nearest.time > now_) {
    seen_ = nearest.seen;
    ahead_.reset();
    log_.seek(nearest.time);
  }
  play_until(time);
}

void Playback::play_until(Instant time) {
  while (true) {
    if (!ahead_) ahead_ = log_.next();
    if (!ahead_ || ahead_->time > time) break;
    take(*ahead_);
    ahead_.reset();
  }
  tell_time(time);
  now_ = time;
}

/// The news were told when they were new.
void Playback::tell_time(Instant time) {
  seen_.fleet.on_timeout(time);
  while (seen_.fleet.poll_news()) {
  }
  seen_.alarms.on_timeout(seen_.picture, seen_.fleet, time);
}

std::size_t Playback::events_so_far() const {
  return static_cast<std::size_t>(
      std::upper_bound(events_.begin(), events_.end(), now_,
                       [](Instant now, const Event& event) { return now < event.time; }) -
      events_.begin());
}

}  // namespace skein::groundstation
