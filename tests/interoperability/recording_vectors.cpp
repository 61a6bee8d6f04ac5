// SPDX-License-Identifier: Apache-2.0
//
// recording_vectors FOLDER: makes a recording in it that has every channel, and prints what is in
// it, a line a record: log time, topic and content, with tabs between.
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/random_messages/random_messages.hpp"
#include "skein/recording/log.hpp"
#include "skein/recording/writer.hpp"

namespace skein::recording {
namespace {

constexpr int kRounds = 20;

Vec3 random_point(Random& random) {
  const double x = random.normal(0.0, 1e3);
  const double y = random.normal(0.0, 1e-3);
  return {x, y, random.uniform()};
}

VehicleState random_state(Instant now, Random& random) {
  const Vec3 at = random_point(random);
  VehicleState s;
  s.time = now;
  s.x_m = at.x();
  s.y_m = at.y();
  s.z_m = at.z();
  s.heading_rad = random.uniform(-3.0, 3.0);
  s.distance_flown_m = random.uniform(0.0, 1e6);
  s.climb_mps = random.normal(0.0, 2.0);
  return s;
}

void write_records(Writer& writer, Instant now, Random& random) {
  TrackPoint point{random_state(now, random), 3, random.uniform(), -0.5};
  writer.write(point);
  mission::MissionEvent event;
  event.vehicle = VehicleId{7};
  event.time = now;
  event.round.coalition.instance = InstanceId{random.next()};
  event.body = mission::body_of(static_cast<mission::EventKind>(
      random.index(static_cast<std::uint64_t>(mission::EventKind::count))));
  if (random.chance(0.5)) {
    event.body = mission::event::AllocationFailed{static_cast<std::uint8_t>(random.index(64)),
                                                  "\"said\" \\ so: \u00e4\u20ac\U0001F681"};
  }
  writer.write(event);
  PlanRecord plan;
  plan.number = 0xFFFFFFFFU;
  plan.since = now;
  plan.plan.start_time = now - std::chrono::hours{1};
  plan.plan.speed_mps = random.uniform(40.0, 60.0);
  for (std::uint64_t i = 0; i < random.index(5); ++i) {
    plan.plan.path.segments.push_back({random.normal(0.0, 1e-3), random.uniform(0.0, 1e4)});
  }
  writer.write(plan);
  writer.write(PlaceRecord{2, now, VehicleId{9}, random_point(random)});
  mission::FlightPlan flight_plan{plan.number, plan.plan};
  MotionTrack track;
  track.count = 2;
  track.start = now;
  const std::vector<AgentRecord> records{
      AgentStart{InstanceId{random.next()}, "skein-onboard 1.0", now},
      StateGiven{random_state(now, random), now},
      PlanningGiven{event.round, random.next(), Duration{12345}, now},
      TimeoutGiven{now},
      NoticeGiven{{now, true, {.news = AutopilotNews::mode_changed, .detail = "RTL"}}, now},
      ConditionGiven{{"GUIDED", 2, random.next()}, now},
      NamesakeHeard{now},
      PlanMade{std::make_shared<const mission::FlightPlan>(flight_plan), now},
      std::get<TrackMade>(made(track, now))};
  for (const AgentRecord& record : records) writer.write(record);
  writer.write(Gap{random.next()});
}

int run(const std::string& folder) {
  {
    Writer::Options options;
    options.session.node = VehicleId{7};
    options.session.instance = InstanceId{0xFFFFFFFFFFFFFFFFU};
    options.session.program = "recording_vectors";
    options.session.version = "0";
    options.session.configuration = "version: 1\ntext: \"\u00e4\"\n";
    auto writer = Writer::open(folder, options);
    if (!writer) {
      std::cerr << writer.error().message << '\n';
      return 1;
    }
    Random random{1};
    for (int round = 0; round < kRounds; ++round) {
      const Instant now = at_seconds(-2.0 + 0.37 * round);
      for (std::size_t kind = 0; kind < codec::kMessageKinds; ++kind) {
        const VehicleId sender{static_cast<std::uint16_t>(kind % 3)};
        writer->write(codec::random_message(kind, random), sender, now);
      }
      write_records(*writer, now, random);
    }
  }
  auto log = Log::open(folder);
  if (!log) {
    std::cerr << log.error().message << '\n';
    return 1;
  }
  const std::int64_t epoch = log->sessions().front().epoch_unix_ns;
  while (const auto entry = log->next()) {
    std::cout << epoch + entry->time.time_since_epoch().count() << '\t' << entry->topic << '\t'
              << text_of(entry->content) << '\n';
  }
  return log->damaged() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace skein::recording

int main(int argc, char** argv) {
  if (argc == 2) return skein::recording::run(argv[1]);
  std::cerr << "recording_vectors FOLDER\n";
  return 2;
}
