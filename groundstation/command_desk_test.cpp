// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/command_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

using mission::event::CommandHanded;
using testing::HasSubstr;
using Heard = CommandDesk::Heard;
using State = CommandDesk::State;

constexpr InstanceId kOlder{100}, kOwn{200}, kNewer{300};

mission::Message setup(InstanceId instance) {
  mission::Setup said;
  said.node = kGroundStation;
  said.instance = instance;
  return said;
}
mission::Message word(bool here, const std::string& who) {
  return mission::MissionEvent{kGroundStation, {}, {}, {}, CommandHanded{here, who}};
}
configuration::CommandConfig one_of_two(bool watches) { return {2, "ridge-2", watches}; }

TEST(CommandDesk, OneAloneCommandsFromTheStartOn) {
  CommandDesk desk{{}, kOwn, at_seconds(0.0)};
  EXPECT_TRUE(desk.is_commanding());
  EXPECT_EQ(desk.on_message(setup(kOwn), kGroundStation, kOwn, at_seconds(1.0)), Heard::own);
  EXPECT_EQ(desk.on_message(mission::Telemetry{}, VehicleId{3}, kNewer, at_seconds(1.0)),
            Heard::others);
  EXPECT_TRUE(desk.is_commanding());
  EXPECT_TRUE(desk.why_not_take(at_seconds(1.0)));
  EXPECT_FALSE(desk.hand_over("ada", at_seconds(1.0)));
}

TEST(CommandDesk, StepsBackAtTheFirstProvenWordOfANewerStart) {
  for (const auto& config : {configuration::CommandConfig{}, one_of_two(false)}) {
    CommandDesk desk{config, kOwn, at_seconds(0.0)};
    if (!desk.is_commanding()) (void)desk.take(kOwn, "ada", "", at_seconds(3.0));
    // What is not signed anybody could say.
    EXPECT_EQ(desk.on_message(mission::Traffic{}, kGroundStation, kNewer, at_seconds(4.0)),
              Heard::others);
    ASSERT_TRUE(desk.is_commanding());
    EXPECT_EQ(desk.on_message(setup(kNewer), kGroundStation, kNewer, at_seconds(5.0)),
              Heard::superseded);
    EXPECT_FALSE(desk.is_commanding());
    EXPECT_FALSE(desk.poll_word(at_seconds(60.0))) << "it says nothing any more";
    EXPECT_FALSE(desk.poll_news(at_seconds(5.1))) << "who has it is told in a moment";
    EXPECT_EQ(desk.on_message(word(true, "ridge-1 (bo)"), kGroundStation, kNewer, at_seconds(5.2)),
              Heard::word);
    const auto news = desk.poll_news(at_seconds(5.3));
    ASSERT_TRUE(news);
    EXPECT_EQ(std::get<CommandHanded>(news->body), (CommandHanded{false, "ridge-1 (bo)"}));
    EXPECT_FALSE(desk.poll_news(at_seconds(5.4)));
    EXPECT_THAT(desk.text(at_seconds(5.4)), HasSubstr("ridge-1 (bo) has the command"));
  }
}

TEST(CommandDesk, AnOlderStartNeverSupersedes) {
  CommandDesk desk{one_of_two(true), {}, at_seconds(0.0)};
  (void)desk.on_message(setup(kOlder), kGroundStation, kOlder, at_seconds(1.0));
  EXPECT_EQ(desk.newest(), kOlder);
  (void)desk.take(kOwn, "ada", "the other is gone", at_seconds(2.0));
  EXPECT_EQ(desk.on_message(word(true, "ridge-1"), kGroundStation, kOlder, at_seconds(3.0)),
            Heard::others);
  EXPECT_TRUE(desk.is_commanding());
  EXPECT_THAT(desk.text(at_seconds(3.0)), HasSubstr("ridge-2 (ada)"));
}

TEST(CommandDesk, ListensBeforeItTakesTheCommandByItself) {
  CommandDesk quiet{one_of_two(false), {}, at_seconds(10.0)};
  EXPECT_EQ(quiet.state(), State::listening);
  EXPECT_FALSE(quiet.takes_by_itself(at_seconds(12.9)));
  EXPECT_TRUE(quiet.takes_by_itself(at_seconds(13.0)));

  CommandDesk other{one_of_two(false), {}, at_seconds(10.0)};
  (void)other.on_message(setup(kOlder), kGroundStation, kOlder, at_seconds(11.0));
  EXPECT_FALSE(other.takes_by_itself(at_seconds(60.0))) << "another has it";
  EXPECT_EQ(other.state(), State::watching);

  CommandDesk watcher{one_of_two(true), {}, at_seconds(10.0)};
  EXPECT_FALSE(watcher.takes_by_itself(at_seconds(60.0)));
}

TEST(CommandDesk, TellsThatNobodyIsInCommand) {
  CommandDesk desk{one_of_two(true), {}, at_seconds(0.0)};
  EXPECT_FALSE(desk.nobody_commands(at_seconds(9.9)));
  EXPECT_TRUE(desk.nobody_commands(at_seconds(10.0))) << "none was ever heard";
  (void)desk.on_message(word(true, "ridge-1"), kGroundStation, kOlder, at_seconds(12.0));
  (void)desk.poll_notice(at_seconds(12.0));
  EXPECT_FALSE(desk.nobody_commands(at_seconds(21.9)));
  EXPECT_FALSE(desk.poll_notice(at_seconds(21.9)));
  EXPECT_TRUE(desk.nobody_commands(at_seconds(22.0)));
  const auto notice = desk.poll_notice(at_seconds(22.0));
  ASSERT_TRUE(notice);
  EXPECT_THAT(*notice, HasSubstr("NOBODY is in command: ridge-1 was not heard for 10 s"));
  EXPECT_FALSE(desk.poll_notice(at_seconds(23.0))) << "once";
  (void)desk.take(kOwn, "", "", at_seconds(24.0));
  EXPECT_FALSE(desk.nobody_commands(at_seconds(60.0)));
}

TEST(CommandDesk, AsksOthersToTakeItAndKeepsItUntilOneDoes) {
  CommandDesk desk{one_of_two(true), {}, at_seconds(0.0)};
  CommandDesk other{{1, "ridge-1", true}, {}, at_seconds(0.0)};
  EXPECT_FALSE(desk.hand_over("ada", at_seconds(1.0)));
  (void)desk.take(kOwn, "ada", "", at_seconds(1.0));
  EXPECT_TRUE(desk.why_not_take(at_seconds(1.5))) << "it has it";
  const auto asked = desk.hand_over("ada", at_seconds(2.0));
  ASSERT_TRUE(asked);
  EXPECT_TRUE(desk.is_commanding());
  EXPECT_EQ(other.on_message(mission::Message{*asked}, kGroundStation, kOwn, at_seconds(2.1)),
            Heard::word);
  EXPECT_THAT(other.text(at_seconds(2.2)), HasSubstr("ridge-2 (ada) asks others to take"));
  EXPECT_TRUE(desk.poll_word(at_seconds(5.1))) << "for who comes later";
  EXPECT_FALSE(desk.why_not_take(at_seconds(5.5))) << "it may take that back";
  const auto kept = desk.keep("ada", "", at_seconds(6.0));
  (void)other.on_message(mission::Message{kept}, kGroundStation, kOwn, at_seconds(6.1));
  EXPECT_THAT(other.text(at_seconds(6.2)), HasSubstr("ridge-2 (ada) has the command"));
}

// They have heard a start of the other one that this one never did.
TEST(CommandDesk, NamesWhoDoesNotHeedIt) {
  CommandDesk desk{one_of_two(true), {}, at_seconds(0.0)};
  (void)desk.take(kOwn, "", "", at_seconds(10.0));
  const auto tell = [&](std::uint16_t vehicle, std::optional<Duration> age, double time_s) {
    mission::Health health;
    health.vehicle = {vehicle};
    if (age) health.heard.push_back({kGroundStation, *age});
    (void)desk.on_message(mission::Message{health}, {vehicle}, {}, at_seconds(time_s));
  };
  for (double s = 11.0; s < 30.0; s += 1.0) {
    tell(1, std::chrono::milliseconds{300}, s);
    tell(2, std::chrono::seconds{60}, s);
    tell(3, std::nullopt, s);
    EXPECT_TRUE(s >= 17.0 || desk.unheeding(at_seconds(s)).empty()) << s;
  }
  EXPECT_THAT(desk.unheeding(at_seconds(30.0)), testing::ElementsAre(VehicleId{2}, VehicleId{3}));
  EXPECT_THAT(desk.text(at_seconds(30.0)), HasSubstr("2, 3 do not heed it"));
  EXPECT_FALSE(desk.why_not_take(at_seconds(30.0))) << "it may take it again";
  (void)desk.take(kNewer, "", "", at_seconds(31.0));
  EXPECT_TRUE(desk.unheeding(at_seconds(32.0)).empty()) << "they are given time";
  for (const std::uint16_t id : {std::uint16_t{2}, std::uint16_t{3}})
    tell(id, std::chrono::seconds{1}, 33.0);
  EXPECT_TRUE(desk.unheeding(at_seconds(60.0)).empty());
}

TEST(CommandDesk, OfTwoThatTakeItAtOnceOneHasIt) {
  CommandDesk a{{1, "ridge-1", true}, {}, at_seconds(0.0)};
  CommandDesk b{{2, "ridge-2", true}, {}, at_seconds(0.0)};
  const auto of_a = a.take(kOwn, "", "", at_seconds(1.0));
  const auto of_b = b.take(kNewer, "", "", at_seconds(1.0));
  EXPECT_EQ(a.on_message(mission::Message{of_b}, kGroundStation, kNewer, at_seconds(1.1)),
            Heard::superseded);
  EXPECT_EQ(b.on_message(mission::Message{of_a}, kGroundStation, kOwn, at_seconds(1.1)),
            Heard::others);
  EXPECT_FALSE(a.is_commanding());
  EXPECT_TRUE(b.is_commanding());
}

}  // namespace
}  // namespace skein::groundstation
