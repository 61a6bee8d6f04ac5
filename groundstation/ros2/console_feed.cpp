// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/console_feed.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/ros2/cdr.hpp"

namespace skein::ros2 {
namespace {

using Json = codec::ParsedJson;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kTime_s = 4e9;  // more than that since 1970, or as mission time, is no time
constexpr std::int64_t kSecond_ns = 1'000'000'000;

const Json* member(const Json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return !object.is_object() || found == object.end() ? nullptr : &*found;
}
double number(const Json& object, const char* name) {
  const Json* value = member(object, name);
  return value != nullptr && value->is_number() ? value->get<double>() : kUnknown;
}
float small_number(const Json& object, const char* name) {
  return static_cast<float>(number(object, name));
}
template <class T>
T whole(const Json& object, const char* name) {
  const Json* value = member(object, name);
  const bool is_whole = value != nullptr && value->is_number_unsigned();
  const std::uint64_t got = is_whole ? value->get<std::uint64_t>() : 0;
  return got <= std::numeric_limits<T>::max() ? static_cast<T>(got) : T{};
}
std::string text(const Json& object, const char* name) {
  const Json* value = member(object, name);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}
bool flag(const Json& object, const char* name) {
  const Json* value = member(object, name);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}
/// An empty array where there is none of that name.
const Json& list(const Json& object, const char* name) {
  static const Json none = Json::array();
  const Json* value = member(object, name);
  return value != nullptr && value->is_array() ? *value : none;
}
bool has_list(const Json& object, const char* name) {
  const Json* value = member(object, name);
  return value != nullptr && value->is_array();
}

std::string vehicle_topic(std::uint16_t id, const char* what) {
  return "vehicle_" + std::to_string(id) + "/" + what;
}

/// In the plane, from one place to another.
geometry_msgs::Quaternion direction(double from_x, double from_y, double to_x, double to_y) {
  const double yaw_rad = std::atan2(to_y - from_y, to_x - from_x);
  geometry_msgs::Quaternion made;
  made.z = std::sin(yaw_rad / 2.0);
  made.w = std::cos(yaw_rad / 2.0);
  return made;
}

template <Message T>
Publication publication(std::string topic, Quality quality, const T& message) {
  return {std::move(topic), T::kType, quality, to_cdr(message)};
}

}  // namespace

struct ConsoleFeed::Reading {
  Json json;
  std::vector<Publication> made;

  template <Message T>
  void publish(std::string topic, Quality quality, const T& message) {
    made.push_back(publication(std::move(topic), quality, message));
  }
  /// Only where it differs from `last` in more than its stamp.
  template <Message T>
  void publish_changed(std::string topic, T message, std::vector<std::uint8_t>& last) {
    const auto stamp = std::exchange(message.header.stamp, {});
    auto bare = to_cdr(message);
    if (bare == last) return;
    last = std::move(bare);
    message.header.stamp = stamp;
    publish(std::move(topic), Quality::state, message);
  }
};

builtin_interfaces::Time ConsoleFeed::stamp_of(double mission_s) const {
  builtin_interfaces::Time stamp;
  if (!(std::abs(mission_s) < kTime_s)) return stamp;
  const std::int64_t unix_ns = epoch_unix_ns_ + std::llround(mission_s * 1e9);
  if (unix_ns < 0) return stamp;
  const std::int64_t seconds = unix_ns / kSecond_ns;
  if (seconds > std::numeric_limits<std::int32_t>::max()) return stamp;
  stamp.sec = static_cast<std::int32_t>(seconds);
  stamp.nanosec = static_cast<std::uint32_t>(unix_ns % kSecond_ns);
  return stamp;
}

std_msgs::Header ConsoleFeed::header_of(double mission_s) const {
  return {stamp_of(mission_s), kFrame};
}

Wgs84 ConsoleFeed::place_of(double x_m, double y_m, double z_m) const {
  const bool known = std::isfinite(x_m) && std::isfinite(y_m) && std::isfinite(z_m);
  return known ? origin_->to_wgs84({x_m, y_m, z_m}) : Wgs84{kUnknown, kUnknown, kUnknown};
}

Result<void> ConsoleFeed::take_hello(Reading& reading) {
  const Json& hello = reading.json;
  if (text(hello, "role") != "observer") {
    return Error{
        "the console lets us in as an operator: give an observer's token (console.observer.token) "
        "or name and password"};
  }
  const Json* place = member(hello, "origin");
  const Wgs84 at = place == nullptr
                       ? Wgs84{kUnknown, kUnknown, kUnknown}
                       : Wgs84{number(*place, "latitude_deg"), number(*place, "longitude_deg"),
                               number(*place, "height_m")};
  const auto origin = MissionOrigin::make(at);
  if (!origin) return Error{"the console's hello has no origin: " + origin.error().message};
  origin_ = *origin;
  const double epoch_s = number(hello, "epoch_unix_s");  // none in a replay
  epoch_unix_ns_ = epoch_s >= 0.0 && epoch_s < kTime_s ? std::llround(epoch_s * 1e9) : 0;
  if (run_ != text(hello, "run")) {
    run_ = text(hello, "run");
    next_seq_ = 0;
  }
  sensor_msgs::NavSatFix fix;
  fix.header = header_of(0.0);
  fix.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  fix.latitude = at.latitude_deg;
  fix.longitude = at.longitude_deg;
  fix.altitude = at.height_m;
  reading.publish_changed("origin", std::move(fix), lists_["origin"]);
  return {};
}

void ConsoleFeed::take_vehicles(Reading& reading) {
  for (const Json& one : list(reading.json, "vehicles")) {
    const auto id = whole<std::uint16_t>(one, "id");
    const double measured_s = number(one, "measured_s");
    // Of one that was never heard nothing is known.
    if (id == 0 || !std::isfinite(measured_s)) continue;
    Vehicle& known = vehicles_[id];
    skein_msgs::VehicleStatus status;
    status.header = header_of(measured_s);
    status.id = id;
    status.silent = flag(one, "silent");
    status.activity = text(one, "activity");
    status.state = text(one, "state");
    status.position = {number(one, "x"), number(one, "y"), number(one, "z")};
    const Wgs84 place = place_of(status.position.x, status.position.y, status.position.z);
    status.latitude = place.latitude_deg;
    status.longitude = place.longitude_deg;
    status.altitude = place.height_m;
    status.heading_deg = small_number(one, "heading_deg");
    status.course_deg = small_number(one, "course_deg");
    status.groundspeed = small_number(one, "groundspeed");
    status.airspeed = small_number(one, "airspeed");
    status.range_left = small_number(one, "range_left_m");
    status.loads = whole<std::uint8_t>(one, "loads");
    status.mode = text(one, "mode");
    for (const Json& problem : list(one, "problems")) {
      status.problems.push_back(text(problem, "text"));
    }
    if (std::isfinite(status.position.z)) known.z_m = status.position.z;
    auto bytes = to_cdr(status);
    if (bytes != known.status) {
      known.status = bytes;
      reading.made.push_back({vehicle_topic(id, "status"), skein_msgs::VehicleStatus::kType,
                              Quality::sensor, std::move(bytes)});
    }
    if (known.measured_s == measured_s) continue;
    known.measured_s = measured_s;
    sensor_msgs::NavSatFix fix;
    fix.header = {status.header.stamp, "vehicle_" + std::to_string(id)};
    fix.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
    fix.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
    fix.latitude = place.latitude_deg;
    fix.longitude = place.longitude_deg;
    fix.altitude = place.height_m;
    reading.publish(vehicle_topic(id, "fix"), Quality::sensor, fix);
  }
}

void ConsoleFeed::take_plans(Reading& reading) {
  for (const Json& one : list(reading.json, "plans")) {
    const auto id = whole<std::uint16_t>(one, "id");
    const std::pair plan{whole<std::uint64_t>(one, "number"), number(one, "start_s")};
    if (id == 0 || !std::isfinite(plan.second)) continue;
    Vehicle& known = vehicles_[id];
    if (known.plan == plan) continue;
    known.plan = plan;
    nav_msgs::Path path;
    path.header = header_of(plan.second);
    for (const Json& point : list(one, "points")) {
      const bool good = point.is_array() && point.size() == 3 && point[0].is_number() &&
                        point[1].is_number() && point[2].is_number();
      if (!good) continue;
      geometry_msgs::PoseStamped pose;
      pose.header = header_of(point[2].get<double>());
      pose.pose.position = {point[0].get<double>(), point[1].get<double>(), known.z_m};
      path.poses.push_back(std::move(pose));
    }
    for (std::size_t i = 0; i + 1 < path.poses.size(); ++i) {
      const auto& from = path.poses[i].pose.position;
      const auto& to = path.poses[i + 1].pose.position;
      path.poses[i].pose.orientation = direction(from.x, from.y, to.x, to.y);
    }
    if (path.poses.size() > 1) {
      path.poses.back().pose.orientation = path.poses[path.poses.size() - 2].pose.orientation;
    }
    reading.publish(vehicle_topic(id, "plan"), Quality::state, path);
  }
}

void ConsoleFeed::take_sites(Reading& reading) {
  if (!has_list(reading.json, "sites")) return;
  skein_msgs::Sites all;
  all.header = header_of(number(reading.json, "time_s"));
  for (const Json& one : list(reading.json, "sites")) {
    skein_msgs::Site site;
    site.id = whole<std::uint16_t>(one, "id");
    const double x_m = number(one, "x");
    const double y_m = number(one, "y");
    site.has_place = std::isfinite(x_m) && std::isfinite(y_m);
    site.position = {x_m, y_m, 0.0};
    const Wgs84 place = place_of(x_m, y_m, 0.0);
    site.latitude = place.latitude_deg;
    site.longitude = place.longitude_deg;
    site.status = text(one, "status");
    site.leader = whole<std::uint16_t>(one, "leader");
    for (const Json& task : list(one, "tasks")) {
      site.tasks.push_back({text(task, "kind"), whole<std::uint8_t>(task, "index"),
                            whole<std::uint16_t>(task, "vehicle"), text(task, "state")});
    }
    site.news = text(one, "news");
    all.sites.push_back(std::move(site));
  }
  reading.publish_changed("sites", std::move(all), lists_["sites"]);
}

void ConsoleFeed::take_hazards(Reading& reading) {
  if (!has_list(reading.json, "hazards")) return;
  skein_msgs::Hazards all;
  all.header = header_of(number(reading.json, "time_s"));
  for (const Json& one : list(reading.json, "hazards")) {
    skein_msgs::Hazard hazard;
    hazard.id = whole<std::uint16_t>(one, "id");
    hazard.centre = {number(one, "x"), number(one, "y"), 0.0};
    const Wgs84 place = place_of(hazard.centre.x, hazard.centre.y, 0.0);
    hazard.latitude = place.latitude_deg;
    hazard.longitude = place.longitude_deg;
    hazard.radius = number(one, "radius_m");
    all.hazards.push_back(hazard);
  }
  reading.publish_changed("hazards", std::move(all), lists_["hazards"]);
}

void ConsoleFeed::take_events(Reading& reading) {
  for (const Json& one : list(reading.json, "events")) {
    skein_msgs::Event event;
    event.seq = whole<std::uint64_t>(one, "seq");
    if (event.seq < next_seq_) continue;
    next_seq_ = event.seq + 1;
    event.header = header_of(number(one, "time_s"));
    event.vehicle = whole<std::uint16_t>(one, "vehicle");
    event.kind = text(one, "kind");
    event.level =
        text(one, "level") == "warning" ? skein_msgs::Event::WARNING : skein_msgs::Event::INFO;
    event.site = whole<std::uint16_t>(one, "site");
    event.text = text(one, "text");
    reading.publish("events", Quality::history, event);
  }
}

Result<ConsoleFeed::Heard> ConsoleFeed::on_text(std::string_view said) {
  Reading reading{codec::parse_json(said), {}};
  const std::string type = text(reading.json, "type");
  if (type == "hello") {
    if (auto taken = take_hello(reading); !taken) return taken.error();
    return Heard{std::move(reading.made),
                 codec::json_text({{"type", "resume"}, {"next_seq", next_seq_}})};
  }
  if (type.empty()) return Error{"the console has said what is no JSON with a type"};
  if (!origin_) return Error{"the console has not said hello first"};
  if (type == "state") {
    take_vehicles(reading);
    take_plans(reading);
    take_sites(reading);
    take_hazards(reading);
  } else if (type == "events") {
    take_events(reading);
  }
  return Heard{std::move(reading.made), ""};
}

}  // namespace skein::ros2
