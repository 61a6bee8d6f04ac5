// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/reader.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "csv.hpp"

namespace skein::recording {
namespace {

using Fields = std::vector<std::string>;

/// Walks the fields of one line; the first that does not read is kept as the reason.
class FieldReader {
 public:
  explicit FieldReader(const Fields& fields) : fields_{fields} {}

  template <class T>
  T number(std::string_view name) {
    T value{};
    const std::string& field = next();
    if (!parse_number(field, value)) fail(std::string{name} + " is no number: '" + field + "'");
    return value;
  }
  Instant time_ns(std::string_view name) { return Instant{Duration{number<Duration::rep>(name)}}; }
  const std::string& text() { return next(); }

  template <class Enum>
  Enum name_of(std::string_view name) {
    const std::string& field = next();
    for (std::size_t i = 0; i < static_cast<std::size_t>(Enum::count); ++i) {
      if (to_string(static_cast<Enum>(i)) == field) return static_cast<Enum>(i);
    }
    fail("unknown " + std::string{name} + " '" + field + "'");
    return Enum{};
  }
  void fail(std::string reason) {
    if (!reason_) reason_ = std::move(reason);
  }
  [[nodiscard]] const std::optional<std::string>& reason() const { return reason_; }

 private:
  const std::string& next() { return fields_[at_++]; }  // the count was checked beforehand

  const Fields& fields_;
  std::size_t at_ = 0;
  std::optional<std::string> reason_;
};

/// Calls `take` with every whole line after the header; counts a last line without its end.
Result<std::size_t> for_each_line(const std::filesystem::path& path, std::string_view header,
                                  const std::function<void(FieldReader&)>& take) {
  std::ifstream file{path, std::ios::binary};
  if (!file) return Error{"cannot read " + path.string()};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  if (file.bad()) return Error{"cannot read " + path.string()};

  const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  std::string_view rest = text;
  std::size_t number = 0;
  const auto damage = [&](const std::string& reason) {
    return Error{path.string() + ":" + std::to_string(number) + ": " + reason};
  };
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (number == 1) {
      if (line != header) return damage("expected the header '" + std::string{header} + "'");
      continue;
    }
    const auto fields = split(line);
    if (!fields) return damage(fields.error().message);
    if (fields->size() != columns) {
      return damage("expected " + std::to_string(columns) + " fields, found " +
                    std::to_string(fields->size()));
    }
    FieldReader reader{*fields};
    take(reader);
    if (reader.reason()) return damage(*reader.reason());
  }
  if (number == 0) {
    number = 1;
    return damage("expected the header '" + std::string{header} + "'");
  }
  return std::size_t{rest.empty() ? 0U : 1U};
}

TrackPoint read_track_point(FieldReader& in) {
  TrackPoint point;
  VehicleState& s = point.state;
  s.time = at_seconds(in.number<double>("time_s"));
  s.x_m = in.number<double>("x_m");
  s.y_m = in.number<double>("y_m");
  s.z_m = in.number<double>("z_m");
  s.heading_rad = in.number<double>("heading_rad");
  s.course_rad = in.number<double>("course_rad");
  s.groundspeed_mps = in.number<double>("groundspeed_mps");
  s.airspeed_mps = in.number<double>("airspeed_mps");
  s.distance_flown_m = in.number<double>("distance_flown_m");
  point.plan_number = in.number<std::uint32_t>("plan_number");
  point.along_error_m = in.number<double>("along_error_m");
  point.cross_error_m = in.number<double>("cross_error_m");
  return point;
}

mission::MissionEvent read_event(FieldReader& in) {
  mission::MissionEvent event;
  event.time = in.time_ns("time_ns");
  event.vehicle.value = in.number<std::uint16_t>("vehicle");
  event.kind = in.name_of<mission::EventKind>("kind");
  event.round.coalition.leader.value = in.number<std::uint16_t>("leader");
  event.round.coalition.instance.value = in.number<std::uint64_t>("instance");
  event.round.coalition.number = in.number<std::uint32_t>("coalition");
  event.round.number = in.number<std::uint32_t>("round");
  event.task.site.value = in.number<std::uint16_t>("site");
  event.task.kind = in.name_of<TaskKind>("task");
  event.task.index = in.number<std::uint8_t>("index");
  event.value = in.number<double>("value");
  event.text = in.text();
  return event;
}

PlanRecord read_plan(FieldReader& in) {
  PlanRecord record;
  record.number = in.number<std::uint32_t>("plan_number");
  record.since = in.time_ns("since_ns");
  record.plan.start_time = in.time_ns("start_time_ns");
  record.plan.speed_mps = in.number<double>("speed_mps");
  record.plan.tail_curvature_per_m = in.number<double>("tail_curvature_per_m");
  record.plan.path.start.x_m = in.number<double>("x_m");
  record.plan.path.start.y_m = in.number<double>("y_m");
  record.plan.path.start.heading_rad = in.number<double>("heading_rad");

  std::string_view rest = in.text();
  while (!rest.empty()) {
    const std::string_view piece = rest.substr(0, rest.find('|'));
    rest.remove_prefix(std::min(piece.size() + 1, rest.size()));
    const auto colon = piece.find(':');
    Segment segment;
    if (colon == std::string_view::npos ||
        !parse_number(piece.substr(0, colon), segment.curvature_per_m) ||
        !parse_number(piece.substr(colon + 1), segment.length_m) || segment.length_m < 0.0) {
      in.fail("no segment: '" + std::string{piece} + "'");
      break;
    }
    if (!record.plan.path.segments.try_push_back(segment)) {
      in.fail("more than " + std::to_string(kPathSegmentsMax) + " segments");
      break;
    }
  }
  return record;
}

PlaceRecord read_place(FieldReader& in) {
  PlaceRecord record;
  record.change = in.number<std::uint32_t>("change");
  record.start = in.time_ns("start_ns");
  record.vehicle.value = in.number<std::uint16_t>("vehicle");
  for (int axis = 0; axis < 3; ++axis) record.place_m[axis] = in.number<double>("place");
  return record;
}

/// The node of a folder's name, where it is one that folder_name() gives.
std::optional<VehicleId> node_of(const std::string& name) {
  if (name == folder_name(kGroundStation)) return kGroundStation;
  const auto dash = name.find('-');
  VehicleId vehicle;
  if (dash == std::string::npos ||
      !parse_number(std::string_view{name}.substr(dash + 1), vehicle.value) ||
      folder_name(vehicle) != name) {
    return std::nullopt;
  }
  return vehicle;
}

}  // namespace

Result<Recording> read(const std::filesystem::path& folder, VehicleId vehicle) {
  Recording recording;
  recording.vehicle = vehicle;
  const auto track = for_each_line(folder / "track.csv", kTrackHeader, [&](FieldReader& in) {
    recording.track.push_back(read_track_point(in));
  });
  if (!track) return track.error();
  const auto events = for_each_line(folder / "events.csv", kEventsHeader, [&](FieldReader& in) {
    recording.events.push_back(read_event(in));
  });
  if (!events) return events.error();
  const auto plans = for_each_line(folder / "plans.csv", kPlansHeader, [&](FieldReader& in) {
    recording.plans.push_back(read_plan(in));
  });
  if (!plans) return plans.error();
  recording.truncated_lines = *track + *events + *plans;
  if (std::error_code none; std::filesystem::exists(folder / "places.csv", none)) {
    const auto places = for_each_line(folder / "places.csv", kPlacesHeader, [&](FieldReader& in) {
      recording.places.push_back(read_place(in));
    });
    if (!places) return places.error();
    recording.truncated_lines += *places;
  }
  return recording;
}

Result<std::vector<Recording>> read_run(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<VehicleId> nodes;
  for (std::filesystem::directory_iterator it{folder, failure}, end; !failure && it != end;
       it.increment(failure)) {
    if (const auto node = node_of(it->path().filename().string())) nodes.push_back(*node);
  }
  if (failure) return Error{"cannot read " + folder.string() + ": " + failure.message()};
  std::sort(nodes.begin(), nodes.end());

  std::vector<Recording> recordings;
  for (const VehicleId node : nodes) {
    auto recording = read(folder / folder_name(node), node);
    if (!recording) return recording.error();
    recordings.push_back(std::move(*recording));
  }
  return recordings;
}

}  // namespace skein::recording
