// SPDX-License-Identifier: Apache-2.0
#include "rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "text.hpp"

namespace skein::tidy {
namespace {

constexpr const char* kSpdx = "// SPDX-License-Identifier: Apache-2.0\n";

/// The findings in one file that a target names and that begins as it should.
std::vector<Finding> findings_in(const std::string& path, const std::string& text) {
  return check({{"CMakeLists.txt", "# SPDX-License-Identifier: Apache-2.0\nx(" + path + ")\n"},
                {path, kSpdx + text}});
}

/// A bad line, where it stands, and a line that resembles it and is allowed.
struct Sample {
  const char* rule;
  const char* path;
  const char* bad;
  const char* good;
};

class LineRules : public testing::TestWithParam<Sample> {};

TEST_P(LineRules, FireOnTheBadLineAndNotOnTheGoodOne) {
  const Sample& s = GetParam();
  const auto found = findings_in(s.path, std::string{"\n"} + s.bad + "\n");
  ASSERT_EQ(found.size(), 1U) << s.bad;
  EXPECT_EQ(found[0].rule, s.rule);
  EXPECT_EQ(found[0].path, s.path);
  EXPECT_EQ(found[0].line, 3U);
  EXPECT_FALSE(found[0].message.empty());
  const auto none = findings_in(s.path, s.good);
  EXPECT_TRUE(none.empty()) << s.good << "\n" << none[0].rule << ": " << none[0].message;
}

constexpr const char* kCore = "core/planning/dubins.cpp";
constexpr const char* kOnboard = "onboard/agent_loop.cpp";

INSTANTIATE_TEST_SUITE_P(
    Each, LineRules,
    testing::Values(
        Sample{"core-clock", kCore, "auto t = std::chrono::steady_clock::now();",
               "// steady_clock is not for us\nstd::chrono::nanoseconds d{};"},
        Sample{"core-clock", kCore, "#include <ctime>", "#include <chrono>"},
        Sample{"core-clock", kCore, "std::this_time(); sleep_for(d);", "double time(int);"},
        Sample{"core-clock", "hal/dronecan/node.cpp", "auto t = std::chrono::steady_clock::now();",
               "Instant now;"},
        Sample{"core-socket", "hal/mavlink/parser.cpp", "#include <sys/socket.h>",
               "#include <nettle/sha2.h>"},
        Sample{"core-thread", kCore, "#include <thread>", "#include <string>"},
        Sample{"core-thread", kCore, "std::jthread worker;", "int thread = 0;"},
        Sample{"core-lock", kCore, "std::mutex m;", "bool mutex_free = true;"},
        Sample{"core-lock", kCore, "#include <condition_variable>", "#include <variant>"},
        Sample{"core-lock", kCore, "std::scoped_lock lock{m};", "void lock();"},
        Sample{"core-socket", kCore, "int s = socket(AF_INET, SOCK_DGRAM, 0);", "int socket = 0;"},
        Sample{"core-socket", kCore, "#include <sys/socket.h>", "#include <system_error>"},
        Sample{"core-output", kCore, "#include <iostream>", "#include <sstream>"},
        Sample{"core-output", kCore, "printf(\"x\");", "std::snprintf(b, n, \"%f\", x);"},
        Sample{"core-random", kCore, "int r = rand();", "int operand();"},
        Sample{"core-random", kCore, "std::random_device seed;", "Random random{seed};"},
        Sample{"core-unordered", kCore, "std::unordered_map<int, int> m;", "std::map<int, int> m;"},
        Sample{"core-throw", kCore, "throw 1;", "return Error{\"a throw of dice\"};"},
        Sample{"core-library", kCore, "#include <yaml-cpp/yaml.h>", "#include <Eigen/Core>"},
        Sample{"dds-outside", kOnboard, "#include <fastdds/dds/topic/Topic.hpp>",
               "#include \"skein/network/participant.hpp\"\n// eprosima::fastdds is elsewhere"},
        Sample{"dds-outside", kCore, "eprosima::fastrtps::Time_t t;", "int eprosima = 0;"},
        Sample{"qos-outside", "runtime/network/participant.cpp",
               "q.reliability().kind = RELIABLE_RELIABILITY_QOS;", "q = topic.qos;"},
        Sample{"topic-name", kOnboard, "subscribe(\"skein/telemetry\");",
               "#include \"skein/network/node.hpp\"\nsubscribe(Topic::telemetry);"},
        Sample{"unfinished", "docs/a.md", "TODO: the rest", "what is left to do"},
        Sample{"unfinished", kOnboard, "// FIXME", "// fixme not"},
        Sample{"machine-path", "docs/a.md", "see /home/ann/skein/notes", "see docs/home/notes"},
        Sample{"machine-path", kOnboard, "open(\"/var/tmp/x\");", "open(\"/var/lib/x\");"},
        Sample{"scope", kOnboard, "void release_payload();", "bool released = payload.size();"},
        Sample{"scope", "idl/mission.idl", "boolean fuzeArmed;", "boolean refused;"},
        Sample{"scope", "scenarios/a.yaml", "weapon: 1", "load: 1"},
        Sample{"scope", kOnboard, "parse(\"drop_load\");", "// says that we never drop_load"}),
    [](const auto& sample) { return std::to_string(sample.index); });

TEST(Rules, CoreRulesLeaveTestsAndOtherFoldersAlone) {
  EXPECT_TRUE(findings_in("core/planning/dubins_test.cpp", "#include <random>").empty());
  EXPECT_TRUE(findings_in(kOnboard, "#include <mutex>").empty());
  EXPECT_TRUE(findings_in("runtime/network/participant.cpp", "#include <fastdds/dds/Topic.hpp>").empty());
}

TEST(Rules, TopicsAreNamedInTheirListAndQosIsSetByTheNode) {
  EXPECT_TRUE(findings_in("runtime/codec/topics.cpp", "name = \"skein/command\";").empty());
  EXPECT_TRUE(findings_in("runtime/network/node.cpp", "auto k = KEEP_LAST_HISTORY_QOS;").empty());
}

TEST(Rules, SourceMustBeginWithItsLicence) {
  const auto found = check({{"CMakeLists.txt", "x(a.cpp)"}, {"a.cpp", "int a;\n"}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].rule, "spdx");
  EXPECT_EQ(found[1].rule, "spdx");
}

TEST(Rules, FileMustBeNamedAfterWhatItHolds) {
  const auto found = findings_in("runtime/network/socket_utils.cpp", "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rule, "vague-name");
  EXPECT_TRUE(findings_in("runtime/network/commons.cpp", "").empty());
}

TEST(Rules, SourceMustNotBeTooLong) {
  std::string text;
  for (int i = 0; i < 799; ++i) text += "int a;\n";
  EXPECT_TRUE(findings_in("a.cpp", text).empty());
  const auto found = findings_in("a.cpp", text + "int a;\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rule, "too-long");
}

TEST(Rules, SourceMustBelongToATarget) {
  const auto rules_with = [](const std::string& cmake, const std::string& path) {
    const auto found = check(
        {{"hal/CMakeLists.txt", "# SPDX-License-Identifier: Apache-2.0\n" + cmake}, {path, kSpdx}});
    return found.empty() ? std::string{} : found[0].rule;
  };
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can/bus.cpp)", "hal/can/bus.cpp"), "");
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can/bus.cpp)", "hal/bus.cpp"), "")
      << "a folder before the name may come from a variable";
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can_bus.cpp)", "hal/bus.cpp"), "no-target");
  EXPECT_EQ(rules_with("# can/bus.cpp", "hal/can/bus.cpp"), "no-target");
  EXPECT_EQ(rules_with("skein_module(hal SOURCES bus.cpp)", "runtime/network/bus.cpp"), "no-target");
}

TEST(Text, CommentsAndLiteralsAreBlankedInPlace) {
  EXPECT_EQ(without_comments("a // b\nc", Literals::keep), "a     \nc");
  EXPECT_EQ(without_comments("a /* b\nb */ c", Literals::keep), "a     \n     c");
  EXPECT_EQ(without_comments("f(\"// \\\" x\") y", Literals::keep), "f(\"// \\\" x\") y");
  EXPECT_EQ(without_comments("f(\"// \\\" x\") y", Literals::blank), "f(         ) y");
  EXPECT_EQ(without_comments("1'000 + x // 'c'", Literals::blank), "1'000 + x       ");
  EXPECT_EQ(without_comments("R\"(a\"b)\" c", Literals::blank), "R        c");
}

TEST(Text, WordsOfIdentifiers) {
  EXPECT_EQ(words_of("releasePayload_2"), "release payload 2");
  EXPECT_EQ(words_of("kLinesMax"), "k lines max");
  EXPECT_EQ(words_of("members_"), "members ");
}

}  // namespace
}  // namespace skein::tidy
