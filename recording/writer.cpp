// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/writer.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include "csv.hpp"

namespace skein::recording {

namespace {

constexpr int kLengthDecimals = 4;
constexpr int kAngleDecimals = 7;

// to_seconds() of an Instant has a spacing below 1e-9 s for 52 days, so nine decimals lose nothing.
constexpr int kTimeDecimals = 9;

}  // namespace

void Writer::File::put(const std::string& line) {
  if (error != 0 || handle == nullptr) return;
  errno = 0;
  if (std::fwrite(line.data(), 1, line.size(), handle.get()) != line.size()) {
    error = errno != 0 ? errno : EIO;
  }
}

Result<Writer::File> Writer::open_file(const std::filesystem::path& path,
                                       const std::string& header) {
  File file;
  file.path = path.string();
  file.handle.reset(std::fopen(file.path.c_str(), "wbe"));
  if (file.handle == nullptr) {
    return Error{"cannot write " + file.path + ": " + std::generic_category().message(errno)};
  }
  file.put(header);
  return file;
}

Result<Writer> Writer::open(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) return Error{"cannot make folder " + folder.string() + ": " + failure.message()};

  auto track = open_file(folder / "track.csv", std::string{kTrackHeader} + "\n");
  if (!track) return track.error();
  auto events = open_file(folder / "events.csv", std::string{kEventsHeader} + "\n");
  if (!events) return events.error();
  auto plans = open_file(folder / "plans.csv", std::string{kPlansHeader} + "\n");
  if (!plans) return plans.error();

  Writer writer;
  writer.track_ = std::move(*track);
  writer.events_ = std::move(*events);
  writer.plans_ = std::move(*plans);
  writer.folder_ = folder;
  std::filesystem::remove(folder / "places.csv", failure);
  const auto flushed = writer.flush();  // a reader finds the headers even if the process is killed
  if (!flushed) return flushed.error();
  return writer;
}

void Writer::write(const TrackPoint& point) {
  const VehicleState& s = point.state;
  line_.clear();
  append_fixed(line_, to_seconds(s.time), kTimeDecimals);
  for (const double length : {s.x_m, s.y_m, s.z_m}) {
    append_fixed(line_ += ',', length, kLengthDecimals);
  }
  append_fixed(line_ += ',', s.heading_rad, kAngleDecimals);
  append_fixed(line_ += ',', s.course_rad, kAngleDecimals);
  append_fixed(line_ += ',', s.groundspeed_mps, kLengthDecimals);
  append_fixed(line_ += ',', s.airspeed_mps, kLengthDecimals);
  append_fixed(line_ += ',', s.distance_flown_m, kLengthDecimals);
  append_unsigned(line_ += ',', point.plan_number);
  append_fixed(line_ += ',', point.along_error_m, kLengthDecimals);
  append_fixed(line_ += ',', point.cross_error_m, kLengthDecimals);
  track_.put(line_ += '\n');
}

void Writer::write(const mission::MissionEvent& event) {
  line_.clear();
  append_integer(line_, event.time.time_since_epoch().count());
  append_unsigned(line_ += ',', event.vehicle.value);
  (line_ += ',') += to_string(event.kind);
  append_unsigned(line_ += ',', event.round.coalition.leader.value);
  append_unsigned(line_ += ',', event.round.coalition.instance.value);
  append_unsigned(line_ += ',', event.round.coalition.number);
  append_unsigned(line_ += ',', event.round.number);
  append_unsigned(line_ += ',', event.task.site.value);
  (line_ += ',') += to_string(event.task.kind);
  append_unsigned(line_ += ',', event.task.index);
  append_exact(line_ += ',', event.value);
  append_quoted(line_ += ',', event.text);
  events_.put(line_ += '\n');
}

void Writer::write(const PlanRecord& record) {
  const TimedPath& plan = record.plan;
  line_.clear();
  append_unsigned(line_, record.number);
  append_integer(line_ += ',', record.since.time_since_epoch().count());
  append_integer(line_ += ',', plan.start_time.time_since_epoch().count());
  for (const double value : {plan.speed_mps, plan.tail_curvature_per_m, plan.path.start.x_m,
                             plan.path.start.y_m, plan.path.start.heading_rad}) {
    append_exact(line_ += ',', value);
  }
  char separator = ',';
  for (const Segment& segment : plan.path.segments) {
    append_exact(line_ += separator, segment.curvature_per_m);
    append_exact(line_ += ':', segment.length_m);
    separator = '|';
  }
  if (plan.path.segments.empty()) line_ += ',';
  plans_.put(line_ += '\n');
}

void Writer::write(const PlaceRecord& record) {
  if (places_.path.empty()) {
    auto opened = open_file(folder_ / "places.csv", std::string{kPlacesHeader} + "\n");
    if (opened) {
      places_ = std::move(*opened);
    } else {
      places_.path = (folder_ / "places.csv").string();
      places_.error = EIO;
    }
  }
  line_.clear();
  append_unsigned(line_, record.change);
  append_integer(line_ += ',', record.start.time_since_epoch().count());
  append_unsigned(line_ += ',', record.vehicle.value);
  for (int axis = 0; axis < 3; ++axis) append_exact(line_ += ',', record.place_m[axis]);
  places_.put(line_ += '\n');
}

Result<void> Writer::flush() {
  for (File* file : {&track_, &events_, &plans_, &places_}) {
    if (file->handle == nullptr) continue;
    if (file->error == 0 && std::fflush(file->handle.get()) != 0) file->error = errno;
  }
  for (const File* file : {&track_, &events_, &plans_, &places_}) {
    if (file->error != 0) {
      return Error{"cannot write " + file->path + ": " +
                   std::generic_category().message(file->error)};
    }
  }
  return {};
}

}  // namespace skein::recording
