// SPDX-License-Identifier: Apache-2.0
#include "mission_upload.hpp"

#include <cmath>
#include <utility>

#include "command_desk.hpp"
#include "skein/domain/landing.hpp"

namespace skein::ardupilot {
namespace {

using mavlink::Command;
using mavlink::MissionItemInt;

constexpr Duration kSayAgain = std::chrono::milliseconds{500};
/// ArduPilot keeps heights in centimetres and radii in metres.
constexpr float kSameHeight_m = 0.02F;
constexpr float kSameRadius_m = 0.5F;

}  // namespace

std::vector<MissionItemInt> landing_mission(const Landing& landing, Command touch_down_by,
                                            const MissionOrigin& origin) {
  std::vector<MissionItemInt> items;
  const auto add = [&](Command command, const Vec2& place, double height_m) -> MissionItemInt& {
    const Wgs84 at = origin.to_wgs84({place.x(), place.y(), 0.0});
    MissionItemInt& item = items.emplace_back();
    item.seq = static_cast<std::uint16_t>(items.size() - 1);
    item.command = static_cast<std::uint16_t>(command);
    item.frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt);
    item.x = static_cast<std::int32_t>(std::lround(at.latitude_deg * 1e7));
    item.y = static_cast<std::int32_t>(std::lround(at.longitude_deg * 1e7));
    item.z = static_cast<float>(height_m);
    item.autocontinue = 1;
    return item;
  };
  const Vec2 touch_down{landing.x_m, landing.y_m};
  add(Command::nav_waypoint, touch_down, 0.0);
  add(Command::do_land_start, approach_begin(landing), landing.approach_height_m);
  MissionItemInt& circle =
      add(Command::nav_loiter_to_alt, descent_centre(landing), landing.approach_height_m);
  circle.param2 = -static_cast<float>(std::round(landing.radius_m));  // to the left
  circle.param4 = 1.0F;                                               // leaves it on its tangent
  add(touch_down_by, touch_down, 0.0);
  return items;
}

std::vector<MissionItemInt> fence_mission(const Fence& fence, const MissionOrigin& origin) {
  std::vector<MissionItemInt> items;
  for (const Vec2& corner : fence.corners) {
    const Wgs84 at = origin.to_wgs84({corner.x(), corner.y(), 0.0});
    MissionItemInt& item = items.emplace_back();
    item.seq = static_cast<std::uint16_t>(items.size() - 1);
    item.command = static_cast<std::uint16_t>(Command::nav_fence_polygon_vertex_inclusion);
    item.param1 = static_cast<float>(fence.corners.size());
    item.x = static_cast<std::int32_t>(std::lround(at.latitude_deg * 1e7));
    item.y = static_cast<std::int32_t>(std::lround(at.longitude_deg * 1e7));
    item.mission_type = static_cast<std::uint8_t>(MissionUpload::Kind::fence);
  }
  return items;
}

/// Of a fence it keeps neither heights nor frames.
bool MissionUpload::same(const MissionItemInt& a, const MissionItemInt& b) const {
  const bool there = a.seq == b.seq && a.command == b.command && a.x == b.x && a.y == b.y;
  if (!there || kind_ == Kind::fence) return there && a.param1 == b.param1;
  const auto turns = static_cast<std::uint16_t>(Command::nav_loiter_to_alt);
  return a.frame == b.frame && std::abs(a.z - b.z) <= kSameHeight_m &&
         (a.command != turns || std::abs(a.param2 - b.param2) <= kSameRadius_m);
}

void MissionUpload::begin(std::vector<MissionItemInt> items, Instant now) {
  clear();
  items_ = std::move(items);
  state_ = State::sending;
  go_on(now);
  say(mavlink::MissionCount{.count = static_cast<std::uint16_t>(items_.size()),
                            .mission_type = type()},
      now);
}

void MissionUpload::clear() { *this = MissionUpload{kind_}; }

void MissionUpload::say(const Message& message, Instant now) {
  out_.push_back(message);
  again_at_ = now + kSayAgain;
}

void MissionUpload::fail(std::string why) {
  state_ = State::failed;
  why_ = std::move(why);
}

void MissionUpload::on_packet(const mavlink::Packet& packet, Instant now) {
  if (const auto asked = mavlink::decode<mavlink::MissionRequest>(packet)) {
    if (asked->mission_type == type()) on_request(asked->seq, now);
  } else if (const auto as_int = mavlink::decode<mavlink::MissionRequestInt>(packet)) {
    if (as_int->mission_type == type()) on_request(as_int->seq, now);
  } else if (const auto ack = mavlink::decode<mavlink::MissionAck>(packet)) {
    if (ack->mission_type == type()) on_ack(*ack, now);
  } else if (const auto count = mavlink::decode<mavlink::MissionCount>(packet)) {
    if (count->mission_type == type()) on_count(*count, now);
  } else if (const auto item = mavlink::decode<MissionItemInt>(packet)) {
    if (item->mission_type == type()) on_item(*item, now);
  }
}

void MissionUpload::on_request(std::uint16_t seq, Instant now) {
  if (state_ != State::sending || seq >= items_.size()) return;
  requested_ = true;
  go_on(now);
  say(items_[seq], now);
}

void MissionUpload::on_ack(const mavlink::MissionAck& ack, Instant now) {
  if (state_ != State::sending) return;
  if (ack.type != static_cast<std::uint8_t>(mavlink::MissionResult::accepted)) {
    return fail("the autopilot refuses the " + name() + " (MISSION_ACK " +
                std::to_string(ack.type) + ")");
  }
  if (!requested_) return;  // of something else
  state_ = State::reading;
  go_on(now);
  read(now);
}

void MissionUpload::read(Instant now) {
  if (counted_) {
    say(mavlink::MissionRequestInt{.seq = next_, .mission_type = type()}, now);
  } else {
    say(mavlink::MissionRequestList{.mission_type = type()}, now);
  }
}

void MissionUpload::on_count(const mavlink::MissionCount& count, Instant now) {
  if (state_ != State::reading || counted_) return;
  if (count.count != items_.size()) {
    return fail("the autopilot has " + std::to_string(count.count) + " items of " +
                std::to_string(items_.size()));
  }
  counted_ = true;
  next_ = kind_ == Kind::mission ? 1 : 0;  // the first of a mission is the autopilot's home
  go_on(now);
  read(now);
}

void MissionUpload::on_item(const MissionItemInt& item, Instant now) {
  if (state_ != State::reading || !counted_ || item.seq != next_) return;
  if (!same(item, items_[next_])) {
    return fail("item " + std::to_string(next_) + " (" + name_of_command(items_[next_].command) +
                ") is another one when it is read back");
  }
  go_on(now);
  if (++next_ < items_.size()) return read(now);
  say(mavlink::MissionAck{.mission_type = type()}, now);
  state_ = State::verified;
}

void MissionUpload::step(Instant now) {
  if (state_ != State::sending && state_ != State::reading) return;
  if (now - progress_at_ > kPatience) {
    return fail("the autopilot does not answer about its " + name());
  }
  if (now < again_at_) return;
  if (state_ == State::reading) return read(now);
  // Once it asks, it asks again for what it has not got.
  if (!requested_) {
    say(mavlink::MissionCount{.count = static_cast<std::uint16_t>(items_.size()),
                              .mission_type = type()},
        now);
  }
}

std::optional<MissionUpload::Message> MissionUpload::poll() {
  if (out_.empty()) return std::nullopt;
  const Message message = out_.front();
  out_.pop_front();
  return message;
}

}  // namespace skein::ardupilot
