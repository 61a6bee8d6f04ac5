// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>

#include "skein/random_messages/random_messages.hpp"

/// Of operator new, since a test set it to 0.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
static std::size_t g_largest_allocation = 0;

[[gnu::noinline]] void* operator new(std::size_t size) {
  g_largest_allocation = std::max(g_largest_allocation, size);
  if (void* memory = std::malloc(size)) return memory;  // NOLINT(cppcoreguidelines-no-malloc)
  throw std::bad_alloc{};
}
// NOLINTBEGIN(cppcoreguidelines-no-malloc)
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND(cppcoreguidelines-no-malloc)

namespace skein::codec {
namespace {

std::string hex(const Bytes& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    text += kDigits[bytes[i] >> 4U];
    text += kDigits[bytes[i] & 0xFU];
    if (i % 32 == 31) text += '\n';
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

std::string read(const std::string& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// Compares with the file, or rewrites it where SKEIN_UPDATE_GOLDEN is set.
void expect_golden(const std::string& path, const std::string& content) {
  // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
  if (std::getenv("SKEIN_UPDATE_GOLDEN") != nullptr) std::ofstream{path} << content;
  EXPECT_EQ(read(path), content) << path
                                 << ": where the change is meant (idl/README.md says when a type "
                                 << "gets a new version), run this test with SKEIN_UPDATE_GOLDEN=1";
}

Fault fault_of(Topic topic, const Bytes& bytes) {
  const auto decoded = decode(topic, bytes);
  const Refusal* refusal = std::get_if<Refusal>(&decoded);
  EXPECT_NE(refusal, nullptr) << "was accepted";
  return refusal != nullptr ? refusal->fault : Fault{};
}

template <class T>
void put(Bytes& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

// Equality of the bytes, and not of the messages, is enough: with the golden encodings it shows
// that no field is lost, since every field of a random message moves the bytes.
TEST(Codec, MessagesSurviveTheRoundTrip) {
  Random random{1};
  for (std::size_t i = 0; i < 200 * kMessageKinds; ++i) {
    const mission::Message sent = random_message(i, random);
    const Topic topic = topic_of(sent);
    const auto bytes = encode(sent);
    ASSERT_TRUE(bytes) << name_of_kind(i % kMessageKinds);
    EXPECT_LE(bytes->size(), encoded_size_max(topic));
    auto decoded = decode(topic, *bytes);
    const auto* received = std::get_if<mission::Message>(&decoded);
    ASSERT_NE(received, nullptr) << name_of_kind(i % kMessageKinds);
    EXPECT_EQ(received->index(), sent.index());
    const auto again = encode(*received);
    ASSERT_TRUE(again);
    EXPECT_EQ(hex(*again), hex(*bytes));
  }
}

TEST(Codec, FieldsArriveWhereTheyBelong) {
  mission::Telemetry t;
  t.vehicle = VehicleId{0x1234};
  t.instance = InstanceId{0x0123456789ABCDEF};
  t.state = {Instant{Duration{7}}, 1.0, 2.0, 3.0, 0.4, 0.5, 6.0, 7.0, 8.0};
  t.activity = mission::Activity::executing;
  t.range_left_m = -9.0;
  t.loads = 10;
  t.plan_number = 11;
  t.control_overruns = 12;
  t.messages_dropped = 13;
  const auto decoded = decode(Topic::telemetry, encode(t).value());
  const auto& r = std::get<mission::Telemetry>(std::get<mission::Message>(decoded));
  EXPECT_EQ(r.vehicle, t.vehicle);
  EXPECT_EQ(r.instance, t.instance);
  EXPECT_EQ(r.state.time, t.state.time);
  EXPECT_EQ(r.state.x_m, 1.0);
  EXPECT_EQ(r.state.y_m, 2.0);
  EXPECT_EQ(r.state.z_m, 3.0);
  EXPECT_EQ(r.state.heading_rad, 0.4);
  EXPECT_EQ(r.state.course_rad, 0.5);
  EXPECT_EQ(r.state.groundspeed_mps, 6.0);
  EXPECT_EQ(r.state.airspeed_mps, 7.0);
  EXPECT_EQ(r.state.distance_flown_m, 8.0);
  EXPECT_EQ(r.activity, mission::Activity::executing);
  EXPECT_EQ(r.range_left_m, -9.0);
  EXPECT_EQ(r.loads, 10);
  EXPECT_EQ(r.plan_number, 11U);
  EXPECT_EQ(r.control_overruns, 12U);
  EXPECT_EQ(r.messages_dropped, 13U);
}

/// Each kind's messages are drawn by themselves: a change of one leaves the others' files alone.
TEST(Codec, EncodingIsTheGoldenOne) {
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    Random random{20250101 + kind};
    std::string content;
    for (int i = 0; i < 3; ++i) content += hex(encode(random_message(kind, random)).value()) + "\n";
    expect_golden(std::string{SKEIN_SOURCE_DIR} + "/idl/golden/" + name_of_kind(kind) + ".hex",
                  content);
  }
}

/// Messages end with a whole line, or with the end of one that is shorter.
std::vector<Bytes> messages_of(const std::string& golden) {
  std::vector<Bytes> all;
  std::istringstream lines{golden};
  bool begins = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      begins = true;
      continue;
    }
    if (begins) all.emplace_back();
    begins = false;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      all.back().push_back(static_cast<std::uint8_t>(std::stoul(line.substr(i, 2), nullptr, 16)));
    }
  }
  return all;
}

/// What a plan was before its paces were appended.
TEST(Codec, ReadsWhatTheReleaseBeforeHasWritten) {
  const auto older = messages_of(read(SKEIN_SOURCE_DIR "/idl/golden/older/plan_report.hex"));
  ASSERT_EQ(older.size(), 3U);
  for (const Bytes& bytes : older) {
    const auto decoded = decode(Topic::plan_report, bytes);
    const auto* message = std::get_if<mission::Message>(&decoded);
    ASSERT_NE(message, nullptr);
    const auto& plan = std::get<mission::PlanReport>(*message).plan;
    EXPECT_FALSE(plan.timed.path.segments.empty());
    EXPECT_TRUE(plan.timed.paces.empty());
  }
}

/// What sites, hazards and telemetry were before they could be withdrawn, and told capabilities.
TEST(Codec, WhatAnOlderReleaseSaysIsNotWithdrawnAndMayHaveAnyCapability) {
  const auto each = [](const char* name, Topic topic, const auto& look) {
    const auto older =
        messages_of(read(std::string{SKEIN_SOURCE_DIR} + "/idl/golden/older/" + name + ".hex"));
    ASSERT_EQ(older.size(), 3U) << name;
    for (const Bytes& bytes : older) {
      const auto decoded = decode(topic, bytes);
      const auto* message = std::get_if<mission::Message>(&decoded);
      ASSERT_NE(message, nullptr) << name;
      look(*message);
    }
  };
  each("site_report", Topic::site_report,
       [](const mission::Message& m) { EXPECT_FALSE(std::get<mission::SiteReport>(m).withdrawn); });
  each("hazard_report", Topic::hazard_report, [](const mission::Message& m) {
    EXPECT_FALSE(std::get<mission::HazardReport>(m).withdrawn);
  });
  each("telemetry", Topic::telemetry, [](const mission::Message& m) {
    const auto& telemetry = std::get<mission::Telemetry>(m);
    EXPECT_EQ(telemetry.capabilities.bits(), 7);
    EXPECT_EQ(telemetry.detail, mission::ActivityDetail::none);
    EXPECT_EQ(telemetry.task.site, SiteId{});
    EXPECT_EQ(telemetry.declined.why, coalition::Reason::none);
  });
}

/// What events of many vehicles were before their counts had two bytes, and before some were not
/// named.
TEST(Codec, CountsOfOneByteAreReadAsBefore) {
  const auto older = messages_of(read(SKEIN_SOURCE_DIR "/idl/golden/older/mission_event.hex"));
  ASSERT_EQ(older.size(), 3U);
  std::vector<mission::EventBody> bodies;
  for (const Bytes& bytes : older) {
    const auto decoded = decode(Topic::mission_event, bytes);
    const auto* message = std::get_if<mission::Message>(&decoded);
    ASSERT_NE(message, nullptr);
    bodies.push_back(std::get<mission::MissionEvent>(*message).body);
  }
  const auto& begun = std::get<mission::event::ChangeBegun>(bodies[0]);
  EXPECT_EQ(begun.vehicles, 128);
  EXPECT_EQ(begun.takes, std::chrono::seconds{9});
  const auto& given = std::get<mission::event::RoutesGiven>(bodies[1]);
  EXPECT_EQ(given.vehicles, 100);
  EXPECT_EQ(given.begins, Instant{std::chrono::seconds{60}});
  const auto& warning = std::get<mission::event::FormationWarning>(bodies[2]);
  EXPECT_EQ(warning.vehicles, (std::vector{VehicleId{3}, VehicleId{4}}));
  EXPECT_EQ(warning.more, 0);
}

TEST(Topics, DocumentIsUpToDate) {
  expect_golden(SKEIN_SOURCE_DIR "/docs/topics.md", read(SKEIN_IDL_GENERATED "/topics.md"));
}

TEST(Codec, CountsAnotherVersionAsSuch) {
  Random random{2};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    const mission::Message message = random_message(kind, random);
    Bytes bytes = encode(message).value();
    put<std::uint16_t>(bytes, 4, 999);
    EXPECT_EQ(fault_of(topic_of(message), bytes), Fault::bad_version);
    bytes.resize(8);  // another version may be shorter
    bytes[3] = 0;
    EXPECT_EQ(fault_of(topic_of(message), bytes), Fault::bad_version);
  }
}

/// Without what was appended since: understood, and said again with it.
bool is_of_older_release(Topic topic, const Bytes& bytes) {
  const auto decoded = decode(topic, bytes);
  const auto* message = std::get_if<mission::Message>(&decoded);
  if (message == nullptr) return false;
  const Bytes now = encode(*message).value();
  const auto end = bytes.end() - (bytes[3] & 3);  // what only fills up
  return now.size() > bytes.size() && std::equal(bytes.begin() + 4, end, now.begin() + 4);
}

TEST(Codec, RefusesTruncatedAndOverlongSamples) {
  Random random{3};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    const mission::Message message = random_message(kind, random);
    const Bytes bytes = encode(message).value();
    // A long one is cut everywhere at its ends, and here and there in between.
    constexpr std::size_t kEnd = 16'000;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      if (size > kEnd && size + 1000 < bytes.size() && size % 61 != 0) continue;
      const Bytes cut{bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
      if (is_of_older_release(topic_of(message), cut)) continue;
      EXPECT_EQ(fault_of(topic_of(message), cut), Fault::malformed);
    }
    Bytes longer = bytes;
    longer.resize(encoded_size_max(topic_of(message)) + 4);
    EXPECT_EQ(fault_of(topic_of(message), longer), Fault::malformed);
  }
}

TEST(Codec, RefusesEnumeratorsThatDoNotExist) {
  Bytes command = encode(mission::Command{VehicleId{1}, 2, mission::CommandKind::resume}).value();
  put(command, 4 + 8,
      static_cast<std::uint32_t>(
          mission::CommandKind::count));  // after version, vehicle and number
  EXPECT_EQ(fault_of(Topic::command, command), Fault::unknown_kind);
  Bytes cancel = encode(coalition::Message{coalition::Cancel{}}).value();
  put<std::uint32_t>(cancel, 8, 99);  // the union's discriminator
  EXPECT_EQ(fault_of(Topic::coalition, cancel), Fault::unknown_kind);
}

TEST(Codec, RefusesNumbersOutOfRange) {
  const auto refused = [](auto change) {
    mission::Telemetry t;
    change(t);
    return !encode(t).has_value();
  };
  EXPECT_FALSE(refused([](mission::Telemetry&) {}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(refused([&](auto& t) { t.state.x_m = nan; }));
  EXPECT_TRUE(refused([&](auto& t) { t.state.heading_rad = infinity; }));
  EXPECT_TRUE(refused([&](auto& t) { t.range_left_m = -infinity; }));
  EXPECT_TRUE(refused([](auto& t) { t.state.groundspeed_mps = -1.0; }));
  EXPECT_TRUE(refused([](auto& t) { t.state.time = Instant::max(); }));
  EXPECT_TRUE(refused([](auto& t) { t.activity = mission::Activity::count; }));

  Bytes bytes = encode(mission::HazardReport{{HazardId{1}, {1.0, 2.0}, 3.0}, false}).value();
  const std::size_t radius = 4 + 4 + 4 + 8 + 16;  // after header, version, size, number and centre
  put(bytes, radius, nan);
  EXPECT_EQ(fault_of(Topic::hazard_report, bytes), Fault::bad_value);
}

TEST(Codec, RefusesSequencesBeyondTheirLimit) {
  coalition::LeaseRenewal m;
  m.members.resize(coalition::kMembersMax);
  EXPECT_TRUE(encode(coalition::Message{m}));
  m.members.resize(coalition::kMembersMax + 1);
  EXPECT_FALSE(encode(coalition::Message{m}));
}

TEST(Codec, AChangeTellsOfAsManyMoversAsItMay) {
  formation::Change change;
  change.stages = formation::kStagesMax;
  formation::Mover mover;
  mover.points.assign(formation::kMoverPointsMax, Vec3::Zero());
  change.movers.assign(formation::kMoversMax, mover);
  const auto bytes = encode(change);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->size(), 114'800U);
  EXPECT_LE(bytes->size(), encoded_size_max(Topic::formation_change));
  const auto decoded = decode(Topic::formation_change, *bytes);
  const auto* message = std::get_if<mission::Message>(&decoded);
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(std::get<formation::Change>(*message).movers.size(), 1024U);
  change.movers.push_back(mover);
  EXPECT_FALSE(encode(change));
}

TEST(Codec, ACountIsCheckedBeforeMemoryIsTaken) {
  mission::Health health;
  health.vehicle = VehicleId{1};
  Bytes bytes = encode(health).value();
  ASSERT_LE(bytes.size(), 64U);
  const std::size_t count = bytes.size() - 8;  // of `heard`, before the last field
  put<std::uint32_t>(bytes, count, 5'000'000);
  g_largest_allocation = 0;
  EXPECT_EQ(fault_of(Topic::health, bytes), Fault::bad_value);
  EXPECT_LE(g_largest_allocation, 1000U);
  put<std::uint32_t>(bytes, count, static_cast<std::uint32_t>(mission::kHeardMax));
  g_largest_allocation = 0;
  EXPECT_EQ(fault_of(Topic::health, bytes), Fault::malformed);
  EXPECT_LE(g_largest_allocation, 1000U);
}

TEST(Codec, WhatIsIncompatibleIsToldWithBothVersions) {
  Bytes bytes = encode(mission::Command{VehicleId{1}, 2, mission::CommandKind::hold}).value();
  put<std::uint16_t>(bytes, 4, 7);
  const auto decoded = decode(Topic::command, bytes);
  const auto* refusal = std::get_if<Refusal>(&decoded);
  ASSERT_NE(refusal, nullptr);
  EXPECT_EQ(text_of(*refusal, Topic::command),
            "its skein::wire::Command is of version 7, ours of version " +
                std::to_string(info(Topic::command).version));
}

TEST(Codec, CutsLongTextsAtACharacter) {
  coalition::Cancel m;
  m.why.detail = std::string(kTextMax - 1, 'x').append("ä").append("more");
  const auto decoded = decode(Topic::coalition, encode(coalition::Message{m}).value());
  const auto& received = std::get<coalition::Cancel>(
      std::get<coalition::Message>(std::get<mission::Message>(decoded)));
  EXPECT_EQ(received.why.detail, std::string(kTextMax - 1, 'x'));
}

TEST(Codec, RefusesTextsThatAreNotText) {
  coalition::Cancel m;
  m.why.detail = "abc\xFF";
  EXPECT_FALSE(encode(coalition::Message{m}));
  m.why.detail = "abcdefg";
  Bytes bytes = encode(coalition::Message{m}).value();
  bytes[bytes.size() - 5] = 0;  // a zero inside would hide what follows
  EXPECT_EQ(fault_of(Topic::coalition, bytes), Fault::bad_value);
  bytes[bytes.size() - 5] = '\n';
  EXPECT_EQ(fault_of(Topic::coalition, bytes), Fault::bad_value);
}

TEST(Codec, AnyBytesAreSafe) {
  Random random{4};
  std::size_t accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    const mission::Message message = random_message(random.index(kMessageKinds), random);
    const Topic topic = topic_of(message);
    Bytes bytes;
    if (random.chance(0.8)) {  // a true message with some bytes changed gets further than noise
      bytes = encode(message).value();
      for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
        bytes[random.index(bytes.size())] = static_cast<std::uint8_t>(random.next());
      }
    } else {
      bytes.resize(random.index(300));
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
      if (bytes.size() >= 6) {
        put<std::uint32_t>(bytes, 0, 0x00000100);
        put<std::uint16_t>(bytes, 4, info(topic).version);
      }
    }
    auto decoded = decode(topic, bytes);
    if (const auto* received = std::get_if<mission::Message>(&decoded)) {
      ++accepted;
      EXPECT_TRUE(encode(*received));  // what is accepted is within the limits
    }
  }
  EXPECT_GT(accepted, 100U);
}

}  // namespace
}  // namespace skein::codec
