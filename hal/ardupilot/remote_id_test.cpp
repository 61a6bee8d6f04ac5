// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using State = Companion::State;

constexpr std::int64_t kUnix_us = 1'700'000'000'000'000;

CompanionParams with_remote_id(bool required, TakeOver take_over = TakeOver::from_ground) {
  CompanionParams p = params(take_over);
  p.unix_us = kUnix_us;
  p.remote_id.uas_id = "1ABCD0123456789";
  p.remote_id.operator_id = "SWE1234567890abc";
  p.remote_id.description = "search for a fire";
  p.remote_id.required = required;
  return p;
}

/// An aircraft on the ground that would arm, and its transmitter.
struct Ground : Line {
  explicit Ground(const CompanionParams& p) : Line{p} {
    autopilot.armed = false;
    autopilot.landed = 1;
    autopilot.relative_height_m = 0.0;
    autopilot.parameters["DID_ENABLE"] = 1.0F;
    autopilot.parameters["DID_OPTIONS"] = 1.0F;
  }
  void transmitter_says(std::uint8_t status, const std::string& error = "",
                        std::uint8_t system = 1) {
    mavlink::Encoder encoder{system, mavlink::kComponentRemoteId1};
    mavlink::OpenDroneIdArmStatus word;
    word.status = status;
    word.error = mavlink::field_of<50>(error);
    const auto bytes = encoder.encode(word);
    companion.on_bytes({bytes.begin(), bytes.size()}, now);
  }
  void run_with(double seconds, std::uint8_t status, const std::string& error = "") {
    for (double s = 0.0; s < seconds; s += 1.0) {
      transmitter_says(status, error);
      run(1.0);
    }
  }
  template <class Message>
  [[nodiscard]] std::optional<Message> last() const {
    std::optional<Message> found;
    for (const auto& packet : autopilot.remote_ids) {
      if (const auto message = mavlink::decode<Message>(packet)) found = message;
    }
    return found;
  }
};

TEST(RemoteId, WithoutAnIdNothingIsSaid) {
  Ground line{params()};
  line.run(8.0);
  EXPECT_TRUE(line.autopilot.remote_ids.empty());
  EXPECT_FALSE(line.companion.facts(line.now)->remote_id);
}

TEST(RemoteId, TellsTheAutopilotOnceASecondWhoItIsAndWhereTheOperatorIs) {
  Ground line{with_remote_id(false, TakeOver::when_guided)};
  line.run(8.0);
  line.autopilot.remote_ids.clear();
  line.run(10.0);
  EXPECT_NEAR(static_cast<double>(line.autopilot.remote_ids.size()), 40.0, 2.0) << "four messages";
  const auto basic = line.last<mavlink::OpenDroneIdBasicId>();
  ASSERT_TRUE(basic);
  EXPECT_EQ(basic->target_system, 1);
  EXPECT_EQ(basic->target_component, 1) << "an ArduPilot hands it on itself";
  EXPECT_EQ(std::string(basic->uas_id.begin(), basic->uas_id.begin() + 15), "1ABCD0123456789");
  EXPECT_EQ(basic->id_type, 1);
  EXPECT_EQ(basic->ua_type, 1);
  const auto system = line.last<mavlink::OpenDroneIdSystem>();
  ASSERT_TRUE(system);
  EXPECT_EQ(system->operator_location_type, 0) << "where it takes off";
  const auto origin = MissionOrigin::make(kTestOrigin).value();
  const auto& truth = line.autopilot.truth;
  const Wgs84 place = origin.to_wgs84({truth.x_m, truth.y_m, truth.z_m});
  EXPECT_NEAR(system->operator_latitude * 1e-7, place.latitude_deg, 2e-5);
  EXPECT_NEAR(system->operator_longitude * 1e-7, place.longitude_deg, 2e-5);
  EXPECT_NEAR(system->timestamp, 1'700'000'000.0 - 1'546'300'800.0 - 2.0, 2.0);
  EXPECT_EQ(system->area_count, 1);
  EXPECT_EQ(mavlink::text_of(line.last<mavlink::OpenDroneIdOperatorId>()->operator_id),
            "SWE1234567890abc");
  EXPECT_EQ(mavlink::text_of(line.last<mavlink::OpenDroneIdSelfId>()->description),
            "search for a fire");
  EXPECT_FALSE(line.last<mavlink::OpenDroneIdLocation>()) << "that the autopilot tells itself";
}

TEST(RemoteId, WhereTheOperatorIsMayBeConfigured) {
  auto p = with_remote_id(false, TakeOver::when_guided);
  p.remote_id.operator_at = Wgs84{31.5, 105.0, 490.0};
  Ground line{p};
  line.run(8.0);
  const auto system = line.last<mavlink::OpenDroneIdSystem>();
  ASSERT_TRUE(system);
  EXPECT_EQ(system->operator_location_type, 2) << "fixed";
  EXPECT_EQ(system->operator_latitude, 315'000'000);
  EXPECT_FLOAT_EQ(system->operator_altitude_geo, 490.0F);
}

TEST(RemoteId, RequiredItIsNotArmedWithoutATransmitterThatIsGood) {
  Ground line{with_remote_id(true)};
  line.run(10.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::component_arm_disarm), 0);
  EXPECT_THAT(*line.companion.facts(line.now)->remote_id, HasSubstr("no transmitter is heard"));
  const auto told = [&](const std::string& words) {
    return std::ranges::any_of(line.companion.troubles(), [&](const AutopilotNotice& trouble) {
      return wording::text_of(trouble).find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(told("no transmitter is heard"));

  line.run_with(5.0, 1, "missing basic_id message");
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_THAT(*line.companion.facts(line.now)->remote_id,
              HasSubstr("not ready: missing basic_id message"));
  EXPECT_TRUE(told("missing basic_id message"));

  line.run_with(3.0, 0);
  EXPECT_EQ(*line.companion.facts(line.now)->remote_id, "");
  EXPECT_FALSE(told("Remote ID"));
  line.transmitter_says(0);
  line.until(State::climbing, 5.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(RemoteId, AWordOfThreeSecondsAgoIsNone) {
  Ground line{with_remote_id(false, TakeOver::when_guided)};
  line.run_with(8.0, 0);
  EXPECT_EQ(*line.companion.facts(line.now)->remote_id, "");
  line.run(2.5);
  EXPECT_THAT(*line.companion.facts(line.now)->remote_id, HasSubstr("no transmitter"));
}

TEST(RemoteId, ATransmitterOfAnotherAircraftCountsForNothing) {
  Ground line{with_remote_id(true)};
  for (int i = 0; i < 10; ++i) {
    line.transmitter_says(0, "", 2);
    line.run(1.0);
  }
  EXPECT_EQ(line.companion.state(), State::standing_by);
}

TEST(RemoteId, NotRequiredItIsArmedWithout) {
  Ground line{with_remote_id(false)};
  line.until(State::climbing, 12.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(RemoteId, RequiredTheAutopilotItselfMustInsist) {
  Ground line{with_remote_id(true)};
  line.autopilot.parameters["DID_OPTIONS"] = 4.0F;
  line.run_with(10.0, 0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("DID_OPTIONS is 4")));
  line.autopilot.set_parameter("DID_OPTIONS", 5.0F);
  for (int i = 0; i < 10 && line.companion.state() != State::climbing; ++i) line.run_with(1.0, 0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

}  // namespace
}  // namespace skein::ardupilot
