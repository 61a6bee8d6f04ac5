// SPDX-License-Identifier: Apache-2.0
#include "records.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/codec/codec.hpp"
#include "skein/schemas/cdr_text.hpp"
#include "skein/wire/recording.h"

namespace skein::recording {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::size_t kEncapsulation = 4;
constexpr std::string_view kTopicPrefix = "skein/";
constexpr std::string_view kEventType = "skein::record::Event";
constexpr std::string_view kEventName = "event/";
/// Of any record that is no message; the largest is a plan of 64 pieces, or an event's text.
constexpr std::size_t kRecordBytesMax = 64U << 10U;

// --- records and their IDL types ---------------------------------------------------------------

std::int64_t ns(Instant t) { return t.time_since_epoch().count(); }

record::State state(const VehicleState& s) {
  record::State w;
  w.time_ns(ns(s.time));
  w.x_m(s.x_m);
  w.y_m(s.y_m);
  w.z_m(s.z_m);
  w.heading_rad(s.heading_rad);
  w.course_rad(s.course_rad);
  w.groundspeed_mps(s.groundspeed_mps);
  w.airspeed_mps(s.airspeed_mps);
  w.distance_flown_m(s.distance_flown_m);
  w.climb_mps(s.climb_mps);
  return w;
}

wire::Round round(const coalition::Round& r) {
  wire::Round w;
  w.leader(r.coalition.leader.value);
  w.leader_instance(r.coalition.instance.value);
  w.coalition(r.coalition.number);
  w.number(r.number);
  return w;
}

record::Position position(const Vec3& p) {
  record::Position w;
  w.x_m(p.x());
  w.y_m(p.y());
  w.z_m(p.z());
  return w;
}

record::TimedPath timed_path(const TimedPath& p) {
  record::TimedPath w;
  w.start_time_ns(ns(p.start_time));
  w.speed_mps(p.speed_mps);
  w.tail_curvature_per_m(p.tail_curvature_per_m);
  w.x_m(p.path.start.x_m);
  w.y_m(p.path.start.y_m);
  w.heading_rad(p.path.start.heading_rad);
  for (const Segment& segment : p.path.segments) {
    record::Piece piece;
    piece.curvature_per_m(segment.curvature_per_m);
    piece.length_m(segment.length_m);
    w.pieces().push_back(piece);
  }
  return w;
}

record::TrackPoint to_idl(const TrackPoint& p) {
  record::TrackPoint w;
  w.state(state(p.state));
  w.plan_number(p.plan_number);
  w.along_error_m(p.along_error_m);
  w.cross_error_m(p.cross_error_m);
  return w;
}

record::Plan to_idl(const PlanRecord& p) {
  record::Plan w;
  w.number(p.number);
  w.since_ns(ns(p.since));
  w.path(timed_path(p.plan));
  return w;
}

record::Place to_idl(const PlaceRecord& p) {
  record::Place w;
  w.change(p.change);
  w.start_ns(ns(p.start));
  w.vehicle(p.vehicle.value);
  w.position(position(p.place_m));
  return w;
}

record::Gap to_idl(const Gap& g) {
  record::Gap w;
  w.lost(g.lost);
  return w;
}

record::AgentStart to_idl(const AgentStart& s) {
  record::AgentStart w;
  w.instance(s.instance.value);
  w.program(s.program);
  return w;
}

record::AgentState to_idl(const StateGiven& s) {
  record::AgentState w;
  w.state(state(s.state));
  return w;
}

record::AgentPlanning to_idl(const PlanningGiven& p) {
  record::AgentPlanning w;
  w.round(round(p.round));
  w.expired_after(p.expired_after);
  w.took_ns(p.took.count());
  return w;
}

record::AgentTimeout to_idl(const TimeoutGiven& t) {
  record::AgentTimeout w;
  w.now_ns(ns(t.now));
  return w;
}

record::AgentNotice to_idl(const NoticeGiven& n) {
  record::AgentNotice w;
  w.time_ns(ns(n.notice.time));
  w.warning(n.notice.warning);
  w.news(static_cast<wire::autopilot::AutopilotNews>(n.notice.what.news));
  w.number(n.notice.what.number);
  w.given(static_cast<wire::autopilot::Given>(n.notice.what.given));
  w.refusal(static_cast<wire::autopilot::GiveBackRefusal>(n.notice.what.refusal));
  w.detail(n.notice.what.detail);
  return w;
}

record::AgentCondition to_idl(const ConditionGiven& c) {
  record::AgentCondition w;
  w.mode(c.condition.mode);
  w.overruns(c.condition.overruns);
  w.dropped(c.condition.dropped);
  return w;
}

record::AgentNamesake to_idl(const NamesakeHeard& n) {
  record::AgentNamesake w;
  w.now_ns(ns(n.now));
  return w;
}

record::AgentPlan to_idl(const PlanMade& p) {
  record::AgentPlan w;
  w.number(p.plan->number);
  w.path(timed_path(p.plan->timed));
  return w;
}

record::AgentTrack to_idl(const TrackMade& t) {
  record::AgentTrack w;
  w.number(t.number);
  w.start_ns(ns(t.start));
  w.points(t.points);
  w.first(position(t.first_m));
  w.digest(t.digest);
  return w;
}

/// Takes fields over and remembers whether one was out of range.
class Check {
 public:
  double number(double value) {
    ok = ok && std::isfinite(value);
    return value;
  }
  Instant instant(std::int64_t value) { return Instant{duration(value)}; }
  Duration duration(std::int64_t value) {
    ok = ok && value >= -codec::kTimeMax.count() && value <= codec::kTimeMax.count();
    return Duration{value};
  }
  template <class To, class From>
  To enumerator(From value) {
    const auto which = static_cast<std::uint32_t>(value);
    ok = ok && which < static_cast<std::uint32_t>(To::count);
    return ok ? static_cast<To>(which) : To{};
  }
  VehicleState state(const record::State& w) {
    VehicleState s;
    s.time = instant(w.time_ns());
    s.x_m = number(w.x_m());
    s.y_m = number(w.y_m());
    s.z_m = number(w.z_m());
    s.heading_rad = number(w.heading_rad());
    s.course_rad = number(w.course_rad());
    s.groundspeed_mps = number(w.groundspeed_mps());
    s.airspeed_mps = number(w.airspeed_mps());
    s.distance_flown_m = number(w.distance_flown_m());
    s.climb_mps = number(w.climb_mps());
    return s;
  }
  static coalition::Round round(const wire::Round& w) {
    return {{VehicleId{w.leader()}, InstanceId{w.leader_instance()}, w.coalition()}, w.number()};
  }
  Vec3 position(const record::Position& w) {
    return {number(w.x_m()), number(w.y_m()), number(w.z_m())};
  }
  TimedPath timed_path(const record::TimedPath& w) {
    TimedPath p;
    p.start_time = instant(w.start_time_ns());
    p.speed_mps = number(w.speed_mps());
    p.tail_curvature_per_m = number(w.tail_curvature_per_m());
    p.path.start = {number(w.x_m()), number(w.y_m()), number(w.heading_rad())};
    for (const record::Piece& piece : w.pieces()) {
      const Segment segment{number(piece.curvature_per_m()), number(piece.length_m())};
      ok = ok && segment.length_m >= 0.0 && p.path.segments.try_push_back(segment);
    }
    return p;
  }

  bool ok = true;
};

TrackPoint from_idl(const record::TrackPoint& w, Check& c, Instant /*now*/) {
  return {c.state(w.state()), w.plan_number(), c.number(w.along_error_m()),
          c.number(w.cross_error_m())};
}

PlanRecord from_idl(const record::Plan& w, Check& c, Instant /*now*/) {
  return {w.number(), c.instant(w.since_ns()), c.timed_path(w.path())};
}

PlaceRecord from_idl(const record::Place& w, Check& c, Instant /*now*/) {
  return {w.change(), c.instant(w.start_ns()), VehicleId{w.vehicle()}, c.position(w.position())};
}

Gap from_idl(const record::Gap& w, Check& /*c*/, Instant /*now*/) { return {w.lost()}; }

AgentStart from_idl(const record::AgentStart& w, Check& /*c*/, Instant now) {
  return {InstanceId{w.instance()}, w.program(), now};
}

StateGiven from_idl(const record::AgentState& w, Check& c, Instant now) {
  return {c.state(w.state()), now};
}

PlanningGiven from_idl(const record::AgentPlanning& w, Check& c, Instant now) {
  return {Check::round(w.round()), w.expired_after(), c.duration(w.took_ns()), now};
}

TimeoutGiven from_idl(const record::AgentTimeout& /*w*/, Check& /*c*/, Instant now) {
  return {now};
}

NoticeGiven from_idl(const record::AgentNotice& w, Check& c, Instant now) {
  return {{c.instant(w.time_ns()),
           w.warning(),
           {c.enumerator<AutopilotNews>(w.news()), w.number(), c.enumerator<Given>(w.given()),
            c.enumerator<GiveBackRefusal>(w.refusal()), w.detail()}},
          now};
}

ConditionGiven from_idl(const record::AgentCondition& w, Check& /*c*/, Instant now) {
  return {{w.mode(), w.overruns(), w.dropped()}, now};
}

NamesakeHeard from_idl(const record::AgentNamesake& /*w*/, Check& /*c*/, Instant now) {
  return {now};
}

PlanMade from_idl(const record::AgentPlan& w, Check& c, Instant now) {
  mission::FlightPlan plan;
  plan.number = w.number();
  plan.timed = c.timed_path(w.path());
  return {std::make_shared<const mission::FlightPlan>(plan), now};
}

TrackMade from_idl(const record::AgentTrack& w, Check& c, Instant now) {
  return {w.number(), c.instant(w.start_ns()), w.points(), c.position(w.first()), w.digest(), now};
}

// --- kinds -------------------------------------------------------------------------------------

using Decoder = std::optional<Content> (*)(std::span<const std::uint8_t>, Instant);

/// Fast CDR reads through char*.
char* chars(Bytes& bytes) { return reinterpret_cast<char*>(bytes.data()); }

template <class Idl>
std::optional<Content> decode_as(std::span<const std::uint8_t> sample, Instant now) {
  if (sample.size() > kRecordBytesMax) return std::nullopt;
  Bytes bytes{sample.begin(), sample.end()};
  FastBuffer buffer{chars(bytes), bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  Idl w;
  try {
    cdr.read_encapsulation();
    w.deserialize(cdr);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  if (cdr.getSerializedDataLength() != bytes.size()) return std::nullopt;
  Check check;
  Content content = from_idl(w, check, now);
  if (!check.ok) return std::nullopt;
  return content;
}

template <codec::Topic Of>
std::optional<Content> decode_message(std::span<const std::uint8_t> sample, Instant /*now*/) {
  auto decoded = codec::decode(Of, sample);
  if (auto* message = std::get_if<mission::Message>(&decoded)) return std::move(*message);
  return std::nullopt;
}

std::optional<Content> decode_event(std::span<const std::uint8_t> sample, Instant /*now*/) {
  auto decoded = codec::decode(codec::Topic::mission_event, sample);
  auto* message = std::get_if<mission::Message>(&decoded);
  if (message == nullptr) return std::nullopt;
  return std::move(std::get<mission::MissionEvent>(*message));
}

struct KnownKind {
  RecordKind kind;
  Decoder decoder;
};

template <class Idl>
struct Named {
  const char* name;
  const char* type;
};

/// Every kind of record that is no message: what its topic ends in, and its struct in idl/.
template <class Idl>
constexpr Named<Idl> kNamed{};
template <>
constexpr Named<record::TrackPoint> kNamed<record::TrackPoint>{"track", "TrackPoint"};
template <>
constexpr Named<record::Plan> kNamed<record::Plan>{"plan", "Plan"};
template <>
constexpr Named<record::Place> kNamed<record::Place>{"place", "Place"};
template <>
constexpr Named<record::Gap> kNamed<record::Gap>{"gap", "Gap"};
template <>
constexpr Named<record::AgentStart> kNamed<record::AgentStart>{"agent/start", "AgentStart"};
template <>
constexpr Named<record::AgentState> kNamed<record::AgentState>{"agent/state", "AgentState"};
template <>
constexpr Named<record::AgentPlanning> kNamed<record::AgentPlanning>{"agent/planning",
                                                                     "AgentPlanning"};
template <>
constexpr Named<record::AgentTimeout> kNamed<record::AgentTimeout>{"agent/timeout", "AgentTimeout"};
template <>
constexpr Named<record::AgentNotice> kNamed<record::AgentNotice>{"agent/notice", "AgentNotice"};
template <>
constexpr Named<record::AgentCondition> kNamed<record::AgentCondition>{"agent/condition",
                                                                       "AgentCondition"};
template <>
constexpr Named<record::AgentNamesake> kNamed<record::AgentNamesake>{"agent/namesake",
                                                                     "AgentNamesake"};
template <>
constexpr Named<record::AgentPlan> kNamed<record::AgentPlan>{"agent/plan", "AgentPlan"};
template <>
constexpr Named<record::AgentTrack> kNamed<record::AgentTrack>{"agent/track", "AgentTrack"};

/// Kinds by the names of their schemas. Made once, never changed.
class Kinds {
 public:
  Kinds() {
    add<record::TrackPoint>();
    add_events();
    add<record::Plan>();
    add<record::Place>();
    add<record::Gap>();
    add<record::AgentStart>();
    add<record::AgentState>();
    add<record::AgentPlanning>();
    add<record::AgentTimeout>();
    add<record::AgentNotice>();
    add<record::AgentCondition>();
    add<record::AgentNamesake>();
    add<record::AgentPlan>();
    add<record::AgentTrack>();
    add_messages(std::make_index_sequence<codec::kTopicCount>{});
  }

  [[nodiscard]] const KnownKind* find(std::string_view schema_name) const {
    const auto found = kinds_.find(schema_name);
    return found == kinds_.end() ? nullptr : &found->second;
  }
  template <class Idl>
  [[nodiscard]] const RecordKind* of() const {
    return &find("skein/msg/" + std::string{kNamed<Idl>.type})->kind;
  }

 private:
  template <class Idl>
  void add() {
    const auto* schema = schemas::find(std::string{"skein::record::"} + kNamed<Idl>.type);
    SKEIN_ASSERT(schema != nullptr);
    kinds_.emplace(schema->name, KnownKind{{kNamed<Idl>.name, schema}, &decode_as<Idl>});
  }
  /// Recorded as they are sent, and told apart by their schemas' names.
  void add_events() {
    for (const schemas::Schema& schema : schemas::all()) {
      if (schema.type != kEventType) continue;
      kinds_.emplace(schema.name,
                     KnownKind{{std::string{kEventName} + std::string{schema.branch}, &schema},
                               &decode_event});
    }
  }
  template <std::size_t... Topic>
  void add_messages(std::index_sequence<Topic...> /*topics*/) {
    (add_message<static_cast<codec::Topic>(Topic)>(), ...);
  }
  /// A topic's schema, or those of its union's branches.
  template <codec::Topic Of>
  void add_message() {
    const std::string_view type = codec::info(Of).type;
    const std::string name{codec::info(Of).name.substr(kTopicPrefix.size())};
    bool any = false;
    for (const schemas::Schema& schema : schemas::all()) {
      if (schema.type != type) continue;
      const std::string branch = schema.branch.empty() ? "" : "/" + std::string{schema.branch};
      kinds_.emplace(schema.name, KnownKind{{name + branch, &schema}, &decode_message<Of>});
      any = true;
    }
    SKEIN_ASSERT(any);
  }

  std::map<std::string_view, KnownKind> kinds_;
};

const Kinds& kinds() {
  static const Kinds kKinds;
  return kKinds;
}

template <class Idl>
Encoded encode_idl(const Idl& w) {
  static const RecordKind* const kKind = kinds().of<Idl>();
  Encoded encoded{kKind, Bytes(kEncapsulation + Idl::getCdrSerializedSize(w))};
  FastBuffer buffer{chars(encoded.bytes), encoded.bytes.size()};
  Cdr cdr{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  try {
    cdr.serialize_encapsulation();
    w.serialize(cdr);
  } catch (const eprosima::fastcdr::exception::Exception&) {
    SKEIN_ASSERT(false && "the buffer was made to fit");
  }
  encoded.bytes.resize(cdr.getSerializedDataLength());
  return encoded;
}

/// A type's kind, or those of its union's branches.
std::vector<const RecordKind*> kinds_of(std::string_view type) {
  std::vector<const RecordKind*> of;
  for (const schemas::Schema& schema : schemas::all()) {
    if (schema.type != type) continue;
    const std::size_t branch = schema.kind.value_or(0);
    of.resize(std::max(of.size(), branch + 1));
    of[branch] = &kinds().find(schema.name)->kind;
  }
  return of;
}

const RecordKind* kind_of(const mission::Message& message) {
  static const auto kByTopic = [] {
    std::array<std::vector<const RecordKind*>, codec::kTopicCount> by_topic;
    for (const codec::TopicInfo& t : codec::kTopics) {
      by_topic.at(static_cast<std::size_t>(t.topic)) = kinds_of(t.type);
    }
    return by_topic;
  }();
  std::size_t branch = 0;
  if (const auto* said = std::get_if<coalition::Message>(&message)) branch = said->index();
  if (const auto* event = std::get_if<mission::MissionEvent>(&message))
    branch = event->body.index();
  return kByTopic.at(static_cast<std::size_t>(codec::topic_of(message))).at(branch);
}

}  // namespace

const RecordKind* kind_named(std::string_view schema_name) {
  const KnownKind* known = kinds().find(schema_name);
  return known == nullptr ? nullptr : &known->kind;
}

std::optional<Encoded> encode(const mission::Message& message) {
  auto bytes = codec::encode(message);
  if (!bytes) return std::nullopt;
  return Encoded{kind_of(message), std::move(*bytes)};
}
Encoded encode(const TrackPoint& point) { return encode_idl(to_idl(point)); }
std::optional<Encoded> encode(const mission::MissionEvent& event) {
  auto bytes = codec::encode(mission::Message{event});
  if (!bytes) return std::nullopt;
  static const auto kOf = kinds_of(kEventType);
  return Encoded{kOf.at(event.body.index()), std::move(*bytes)};
}
Encoded encode(const PlanRecord& plan) { return encode_idl(to_idl(plan)); }
Encoded encode(const PlaceRecord& place) { return encode_idl(to_idl(place)); }
Encoded encode(const Gap& gap) { return encode_idl(to_idl(gap)); }
Encoded encode(const AgentStart& start) { return encode_idl(to_idl(start)); }
Encoded encode(const StateGiven& state) { return encode_idl(to_idl(state)); }
Encoded encode(const PlanningGiven& planning) { return encode_idl(to_idl(planning)); }
Encoded encode(const TimeoutGiven& timeout) { return encode_idl(to_idl(timeout)); }
Encoded encode(const NoticeGiven& notice) { return encode_idl(to_idl(notice)); }
Encoded encode(const ConditionGiven& condition) { return encode_idl(to_idl(condition)); }
Encoded encode(const NamesakeHeard& namesake) { return encode_idl(to_idl(namesake)); }
Encoded encode(const PlanMade& plan) { return encode_idl(to_idl(plan)); }
Encoded encode(const TrackMade& track) { return encode_idl(to_idl(track)); }

std::optional<Encoded> encode(const Content& content) {
  return std::visit([](const auto& record) -> std::optional<Encoded> { return encode(record); },
                    content);
}

std::vector<std::uint8_t> bytes_of(const Content& content) {
  auto encoded = encode(content);
  return encoded ? std::move(encoded->bytes) : Bytes{};
}

std::string text_of(const Content& content) {
  const auto encoded = encode(content);
  if (!encoded) return "a record with a value out of its range";
  return std::string{encoded->kind->schema->name} + " " +
         schemas::text_of(encoded->kind->schema->text, encoded->bytes);
}

std::optional<Content> decode(const RecordKind& kind, std::span<const std::uint8_t> bytes,
                              Instant now) {
  return kinds().find(kind.schema->name)->decoder(bytes, now);
}

std::optional<VehicleId> vehicle_of_event(const RecordKind& kind,
                                          std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kVehicle = kEncapsulation + 2;  // after the version
  if (!kind.name.starts_with(kEventName) || bytes.size() < kVehicle + 2) return std::nullopt;
  return VehicleId{static_cast<std::uint16_t>(bytes[kVehicle] | bytes[kVehicle + 1] << 8U)};
}

GuidanceMade made(const mission::Guidance& guidance, Instant now) {
  if (const auto* plan = std::get_if<mission::FlightPlan>(&guidance)) {
    return PlanMade{std::make_shared<const mission::FlightPlan>(*plan), now};
  }
  const auto& track = std::get<MotionTrack>(guidance);
  TrackMade record;
  record.number = track.number;
  record.start = track.start;
  record.points = track.count;
  const auto& first = track.points.front().position_m;
  record.first_m = {first[0], first[1], first[2]};
  constexpr std::uint64_t kOffset = 0xCBF29CE484222325U;
  constexpr std::uint64_t kPrime = 0x100000001B3U;
  std::uint64_t digest = kOffset;
  const auto add = [&digest](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned i = 0; i < 64; i += 8) digest = (digest ^ (bits >> i & 0xFFU)) * kPrime;
  };
  add(track.yaw_rad);
  for (std::size_t i = 0; i < std::min<std::size_t>(track.count, track.points.size()); ++i) {
    for (const double value : track.points[i].position_m) add(value);
    for (const double value : track.points[i].velocity_mps) add(value);
  }
  record.digest = digest;
  record.now = now;
  return record;
}

}  // namespace skein::recording
